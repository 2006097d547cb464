"""Ticks without a value."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import Ticks
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.scheduling import units
from amalthea_uros.validate.wording import listed


def _check(element: Ticks, context: Context) -> Iterator[str]:
    if element.default is not None:
        return
    stated = {entry.key for entry in element.extended if entry.value is not None}
    if not stated:
        yield "the ticks have no value"
    elif missing := [unit for unit in units(element, context) if unit.definition not in stated]:
        yield f"the ticks have no value for {listed(missing)}"


RULE = ModelRule(
    id="TIM-TICKS",
    title="ticks without a value",
    severity=Severity.WARNING,
    target=Ticks,
    check=_check,
    rationale="Ticks without a value take no time, or leave the execution time of everything that executes them unknown.",
    remedy="Set a default, or a value for each processing unit definition that executes the ticks.",
    fails=runnable_with('<items xsi:type="am:Ticks"/>'),
    edits={
        'xsi:type="am:Ticks"/>': """xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="1"/>
      </items>""",
    },
)
