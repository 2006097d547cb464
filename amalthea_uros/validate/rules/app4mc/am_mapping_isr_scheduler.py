"""Interrupt service routine without a controller."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISR, ISRAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ISR, context: Context) -> Iterator[str]:
    if not context.uses(ISRAllocation, "isr")[element]:
        yield f"no ISR allocation refers to {element.name!r}"


RULE = ModelRule(
    id="AM-Mapping-ISR-Scheduler",
    title="interrupt service routine without a controller",
    severity=Severity.WARNING,
    target=ISR,
    check=_check,
    rationale="It is not served by anything. APP4MC reports it when it validates the model.",
    remedy="Allocate it to an interrupt controller.",
    fails="""
<swModel>
  <isrs name="I"/>
</swModel>
""",
    passes="""
<swModel>
  <isrs name="I"/>
</swModel>
<mappingModel>
  <isrAllocation isr="I?type=ISR"/>
</mappingModel>
""",
)
