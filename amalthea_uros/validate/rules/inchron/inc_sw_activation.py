"""Runnable with activations."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Runnable
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Runnable, context: Context) -> Iterator[str]:
    if element.activations:
        yield f"the activations of {element.name!r} are ignored"


RULE = ModelRule(
    id="INC-SW-ACTIVATION",
    title="runnable with activations",
    severity=Severity.WARNING,
    target=Runnable,
    check=_check,
    rationale="am2inc ignores them without a word; they do not activate anything anyway.",
    remedy="Let a task with a stimulus call the runnable.",
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
