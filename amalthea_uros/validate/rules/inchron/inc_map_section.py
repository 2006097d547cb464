"""Section mapping."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import PhysicalSectionMapping
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Rule


def check(element: PhysicalSectionMapping, context: Context) -> Iterator[str]:
    """What is wrong with an object."""
    yield f"the section mapping {element.name!r} is dropped"


RULE = Rule(
    id="INC-MAP-SECTION",
    title="section mapping",
    severity=Severity.WARNING,
    target=PhysicalSectionMapping,
    check=check,
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
