"""Average outside its bounds."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import MinAvgMaxStatistic
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: MinAvgMaxStatistic, context: Context) -> Iterator[str]:
    least, average, most = (element.effective(name) for name in ("min", "avg", "max"))
    if not least <= average <= most:
        yield f"the average {average} is not between the minimum {least} and the maximum {most}"


RULE = ModelRule(
    id="AM-EMF-INTRINSIC/MinAvgMaxStatistic",
    title="average outside its bounds",
    severity=Severity.ERROR,
    target=MinAvgMaxStatistic,
    check=_check,
    rationale="No set of values has this average. APP4MC's validation also reports it.",
    remedy="Correct the minimum, the average or the maximum.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:RunnableCall" runnable="S?type=Runnable">
        <statistic>
          <statistic xsi:type="am:MinAvgMaxStatistic" min="2" avg="1.0" max="3"/>
        </statistic>
      </items>
    </activityGraph>
  </runnables>
  <runnables name="S"/>
</swModel>
""",
    edits={'min="2" avg="1.0"': 'min="1" avg="2.0"'},
)
