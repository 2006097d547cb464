"""Unbounded loop."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import WhileLoop
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import ModelRule


def _check(element: WhileLoop, context: Context) -> Iterator[str]:
    yield "the maximum number of iterations is unknown"


RULE = ModelRule(
    id="TIM-LOOP",
    title="unbounded loop",
    severity=Severity.WARNING,
    target=WhileLoop,
    check=_check,
    rationale="Without a maximum number of iterations there is no worst-case execution time.",
    remedy="Unroll the loop, or replace it by a call with a statistic of the number of iterations.",
    fails=runnable_with('<items xsi:type="am:WhileLoop"/>'),
    edits={
        """<activityGraph>
      <items xsi:type="am:WhileLoop"/>
    </activityGraph>""": "<activityGraph/>",
    },
)
