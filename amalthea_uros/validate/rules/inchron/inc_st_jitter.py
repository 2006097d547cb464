"""Unsupported jitter."""

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
            yield f"the Gaussian jitter of the stimulus {element.name or ''!r} has a missing bound or a mean other than 0"
    elif jitter is not None and not isinstance(jitter, TimeConstant | TimeUniformDistribution):
        yield f"the jitter of the stimulus {element.name or ''!r} is dropped by am2inc"


RULE = ModelRule(
    id="INC-ST-JITTER",
    title="unsupported jitter",
    severity=Severity.WARNING,
    target=PeriodicStimulus,
    check=_check,
    rationale="am2inc drops jitter that is not constant, uniform or Gaussian, and prints a warning. For Gaussian jitter it "
    "silently ignores the mean and uses 0 for missing bounds.",
    remedy="Use a constant, a uniform distribution, or a Gaussian distribution with both bounds and a mean of 0.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <jitter xsi:type="am:TimeStatistics"/>
  </stimuli>
</stimuliModel>
""",
    edits={
        'xsi:type="am:TimeStatistics"/>': """xsi:type="am:TimeConstant">
      <value value="1" unit="ms"/>
    </jitter>""",
    },
)
