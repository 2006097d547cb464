"""Limit of a response time that is not above zero."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import TimeMetric, TimeRequirementLimit
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: TimeRequirementLimit, context: Context) -> Iterator[str]:
    limit = element.limit_value
    if element.metric is TimeMetric.RESPONSE_TIME and limit is not None and (limit.value or 0) <= 0:
        yield f"the response time is limited by {limit.value or 0}"


RULE = ModelRule(
    id="TA-Constraints-RTLimitMustBePositive",
    title="limit of a response time that is not above zero",
    severity=Severity.ERROR,
    target=TimeRequirementLimit,
    check=_check,
    rationale="Nothing responds in no time. APP4MC reports it when it validates the model.",
    remedy="State a limit above 0.",
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
    passes="""
<constraintsModel>
  <requirements xsi:type="am:ProcessRequirement" name="deadline" process="T?type=Task">
    <limit xsi:type="am:TimeRequirementLimit" limitType="UpperLimit" metric="ResponseTime">
      <limitValue value="10" unit="ms"/>
    </limit>
  </requirements>
</constraintsModel>
<swModel>
  <tasks name="T"/>
</swModel>
""",
)
