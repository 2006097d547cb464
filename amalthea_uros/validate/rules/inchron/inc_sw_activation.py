"""Runnable with activations."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Runnable, context: Context) -> Iterator[str]:
    if element.activations:
        yield f"the activations of the runnable {element.name or ''!r} are ignored by am2inc"


RULE = ModelRule(
    id="INC-SW-ACTIVATION",
    title="runnable with activations",
    severity=Severity.WARNING,
    target=Runnable,
    check=_check,
    rationale="am2inc silently ignores activations of runnables, which do not activate anything in AMALTHEA either.",
    remedy="Call the runnable from a task that has a stimulus.",
    fails="""
<swModel>
  <activations xsi:type="am:PeriodicActivation" name="A"/>
  <runnables name="R" activations="A?type=PeriodicActivation"/>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R"/>
</swModel>
""",
)
