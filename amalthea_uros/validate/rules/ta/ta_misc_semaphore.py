"""Inconsistent semaphore values."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Semaphore
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Semaphore, context: Context) -> Iterator[str]:
    initial, most = element.effective("initial_value"), element.effective("max_value")
    if initial < 0:
        yield f"the initial value of {element.name!r} is {initial}, but must be 0 or more"
    if most <= 0:
        yield f"the maximum value of {element.name!r} is {most}, but must be greater than 0"
    if most < initial:
        yield f"the initial value {initial} of {element.name!r} is above the maximum value {most}"


RULE = ModelRule(
    id="TA-Misc-Semaphore",
    title="inconsistent semaphore values",
    severity=Severity.ERROR,
    target=Semaphore,
    check=_check,
    rationale="Either every request waits forever, or the semaphore protects nothing. APP4MC's validation also reports it.",
    remedy="Set the maximum value to 1 or more, and the initial value from 0 to the maximum.",
    fails="""
<osModel>
  <semaphores name="S" initialValue="2" maxValue="1"/>
</osModel>
""",
    edits={'initialValue="2"': 'initialValue="0"'},
)
