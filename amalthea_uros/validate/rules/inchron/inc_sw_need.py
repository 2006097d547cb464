"""Execution need."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import ExecutionNeed
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: ExecutionNeed, context: Context) -> Iterator[str]:
    yield "the execution need is dropped by am2inc"


RULE = ModelRule(
    id="INC-SW-NEED",
    title="execution need",
    severity=Severity.WARNING,
    target=ExecutionNeed,
    check=_check,
    rationale="am2inc drops execution needs and prints a warning, so the runnable takes no time.",
    remedy="Specify the execution time as Ticks.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:ExecutionNeed"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        'xsi:type="am:ExecutionNeed"/>': """xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueConstant" value="1"/>
      </items>""",
    },
)
