"""Response time limit of zero or less."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TimeMetric, TimeRequirementLimit
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: TimeRequirementLimit, context: Context) -> Iterator[str]:
    limit = element.limit_value
    if element.metric is TimeMetric.RESPONSE_TIME and limit is not None and (limit.value or 0) <= 0:
        yield f"the response time limit is {limit.value or 0}, but must be greater than 0"


RULE = ModelRule(
    id="TA-Constraints-RTLimitMustBePositive",
    title="response time limit of zero or less",
    severity=Severity.ERROR,
    target=TimeRequirementLimit,
    check=_check,
    rationale="Every response takes time, so a limit of 0 or less is meaningless. APP4MC's validation also reports it.",
    remedy="Set a limit greater than 0.",
    fails="""
<constraintsModel>
  <requirements xsi:type="am:ProcessRequirement" name="deadline" process="T?type=Task">
    <limit xsi:type="am:TimeRequirementLimit" limitType="UpperLimit" metric="ResponseTime">
      <limitValue value="0" unit="ms"/>
    </limit>
  </requirements>
</constraintsModel>
<swModel>
  <tasks name="T"/>
</swModel>
""",
    edits={'value="0"': 'value="10"'},
)
