"""Beta distribution of ticks."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import DiscreteValueBetaDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.validate.rules.inchron._ticks import is_read


def _check(element: DiscreteValueBetaDistribution, context: Context) -> Iterator[str]:
    if is_read(element):
        yield "the beta distribution is changed to its upper bound by am2inc"


RULE = ModelRule(
    id="INC-SW-TICKS-BETA",
    title="beta distribution of ticks",
    severity=Severity.WARNING,
    target=DiscreteValueBetaDistribution,
    check=_check,
    rationale="am2inc silently converts a beta distribution to its constant upper bound.",
    remedy="Use another distribution, e.g. a uniform or Gaussian one.",
    fails="""
<swModel>
  <runnables name="R">
    <activityGraph>
      <items xsi:type="am:Ticks">
        <default xsi:type="am:DiscreteValueBetaDistribution" alpha="1" beta="2" lowerBound="1" upperBound="9"/>
      </items>
    </activityGraph>
  </runnables>
</swModel>
""",
    edits={
        'xsi:type="am:DiscreteValueBetaDistribution"': 'xsi:type="am:DiscreteValueConstant"',
        'alpha="1" beta="2" lowerBound="1" upperBound="9"': 'value="1"',
    },
)
