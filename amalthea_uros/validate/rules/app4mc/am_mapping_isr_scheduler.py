"""Interrupt service routine without an interrupt controller."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, ISRAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ISR, context: Context) -> Iterator[str]:
    if not context.uses(ISRAllocation, "isr")[element]:
        yield f"ISR {element.name!r} has no ISR allocation"


RULE = ModelRule(
    id="AM-Mapping-ISR-Scheduler",
    title="interrupt service routine without an interrupt controller",
    severity=Severity.WARNING,
    target=ISR,
    check=_check,
    rationale="Without an allocation, no interrupt controller serves the ISR. APP4MC's validation also reports it.",
    remedy="Allocate the ISR to an interrupt controller.",
    fails="""
<swModel>
  <isrs name="I"/>
</swModel>
""",
    edits={
        "</swModel>": """</swModel>
<mappingModel>
  <isrAllocation isr="I?type=ISR"/>
</mappingModel>""",
    },
)
