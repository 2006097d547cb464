"""Incomplete ISR allocation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISRAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ISRAllocation, context: Context) -> Iterator[str]:
    if element.isr is None or element.controller is None:
        yield "the ISR allocation lacks its ISR or its controller"


RULE = ModelRule(
    id="INC-MAP-ISR",
    title="incomplete ISR allocation",
    severity=Severity.WARNING,
    target=ISRAllocation,
    check=_check,
    rationale="am2inc skips it without a word.",
    remedy="Name the ISR and its controller.",
    fails="""
<swModel>
  <isrs name="I"/>
</swModel>
<mappingModel>
  <isrAllocation isr="I?type=ISR"/>
</mappingModel>
""",
    passes="""
<osModel>
  <operatingSystems name="OS">
    <interruptControllers name="C"/>
  </operatingSystems>
</osModel>
<swModel>
  <isrs name="I"/>
</swModel>
<mappingModel>
  <isrAllocation isr="I?type=ISR" controller="C?type=InterruptController"/>
</mappingModel>
""",
)
