"""Loop without a bound."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import WhileLoop
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: WhileLoop, context: Context) -> Iterator[str]:
    yield "nothing says how often the loop is repeated at most"


RULE = ModelRule(
    id="TIM-LOOP",
    title="loop without a bound",
    severity=Severity.WARNING,
    target=WhileLoop,
    check=_check,
    rationale="Nothing says how often it is repeated at most, so that there is no worst case.",
    remedy="Unroll it, or state the repetitions as calls with a statistic.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:WhileLoop"/>
    </activityGraph>
  </runnables>
</swModel>
""",
    passes="""
<swModel>
  <runnables name="R">
    <activityGraph/>
  </runnables>
</swModel>
""",
)
