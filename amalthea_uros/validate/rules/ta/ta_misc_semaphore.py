"""Semaphore whose numbers do not fit."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Semaphore
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: Semaphore, context: Context) -> Iterator[str]:
    initial, most = element.effective("initial_value"), element.effective("max_value")
    if initial < 0:
        yield f"{element.name!r} has {initial} users at the start"
    if most <= 0:
        yield f"{element.name!r} has room for {most} users"
    if most < initial:
        yield f"{element.name!r} has {initial} users at the start, and room for {most}"


RULE = ModelRule(
    id="TA-Misc-Semaphore",
    title="semaphore whose numbers do not fit",
    severity=Severity.ERROR,
    target=Semaphore,
    check=_check,
    rationale="Who requests it waits forever, or it keeps nobody away. APP4MC reports it when it validates the model.",
    remedy="State room for one user or more, and at the start between 0 and as many users.",
    fails="""
<osModel>
  <semaphores name="S" initialValue="2" maxValue="1"/>
</osModel>
""",
    passes="""
<osModel>
  <semaphores name="S" initialValue="0" maxValue="1"/>
</osModel>
""",
)
