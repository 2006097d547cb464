"""Section mapping."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import PhysicalSectionMapping
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: PhysicalSectionMapping, context: Context) -> Iterator[str]:
    yield f"the section mapping {element.name!r} is dropped"


RULE = ModelRule(
    id="INC-MAP-SECTION",
    title="section mapping",
    severity=Severity.WARNING,
    target=PhysicalSectionMapping,
    check=_check,
    rationale="am2inc drops it, with a warning.",
    remedy="Map the labels themselves.",
    fails="""
<mappingModel>
  <physicalSectionMapping name="M"/>
</mappingModel>
""",
    passes="""
<mappingModel/>
""",
)
