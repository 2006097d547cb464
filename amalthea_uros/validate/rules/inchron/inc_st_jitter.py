"""Jitter that is not converted."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import PeriodicStimulus, TimeConstant, TimeGaussDistribution, TimeUniformDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import ModelRule


def _check(element: PeriodicStimulus, context: Context) -> Iterator[str]:
    jitter = element.jitter
    if isinstance(jitter, TimeGaussDistribution):
        if jitter.lower_bound is None or jitter.upper_bound is None or (jitter.mean is not None and jitter.mean.value):
            yield f"the Gauss jitter of {element.name!r} lacks a bound, or has a mean other than 0"
    elif jitter is not None and not isinstance(jitter, TimeConstant | TimeUniformDistribution):
        yield f"the jitter of {element.name!r} is dropped"


RULE = ModelRule(
    id="INC-ST-JITTER",
    title="jitter that is not converted",
    severity=Severity.WARNING,
    target=PeriodicStimulus,
    check=_check,
    rationale="Other distributions are dropped; the mean of Gauss is ignored, and its missing bounds become 0.",
    remedy="Use a constant, a uniform distribution, or Gauss with bounds and the mean 0.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <jitter xsi:type="am:TimeStatistics"/>
  </stimuli>
</stimuliModel>
""",
    passes="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <jitter xsi:type="am:TimeConstant">
      <value value="1" unit="ms"/>
    </jitter>
  </stimuli>
</stimuliModel>
""",
)
