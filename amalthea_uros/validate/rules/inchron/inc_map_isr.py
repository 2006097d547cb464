"""Incomplete ISR allocation."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ISRAllocation
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._missing import missing


def _check(element: ISRAllocation, context: Context) -> Iterator[str]:
    absent = missing({"ISR": element.isr, "interrupt controller": element.controller})
    if absent:
        yield f"the ISR allocation has no {absent}"


RULE = ModelRule(
    id="INC-MAP-ISR",
    title="incomplete ISR allocation",
    severity=Severity.WARNING,
    target=ISRAllocation,
    check=_check,
    rationale="am2inc silently skips the allocation.",
    remedy="Set the ISR and the interrupt controller.",
    fails="""
<swModel>
  <isrs name="I"/>
</swModel>
<mappingModel>
  <isrAllocation isr="I?type=ISR"/>
</mappingModel>
""",
    edits={
        "<swModel>": """<osModel>
  <operatingSystems name="OS">
    <interruptControllers name="C"/>
  </operatingSystems>
</osModel>
<swModel>""",
        'isr="I?type=ISR"': 'isr="I?type=ISR" controller="C?type=InterruptController"',
    },
)
