"""Physical section mapping."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import PhysicalSectionMapping
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: PhysicalSectionMapping, context: Context) -> Iterator[str]:
    yield f"the physical section mapping {element.name or ''!r} is dropped by am2inc"


RULE = ModelRule(
    id="INC-MAP-SECTION",
    title="physical section mapping",
    severity=Severity.WARNING,
    target=PhysicalSectionMapping,
    check=_check,
    rationale="am2inc drops physical section mappings and prints a warning.",
    remedy="Map the labels to memories directly.",
    fails="""
<mappingModel>
  <physicalSectionMapping name="M"/>
</mappingModel>
""",
    passes="""
<mappingModel/>
""",
)
