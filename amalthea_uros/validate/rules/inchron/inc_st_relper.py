"""Unsupported relative periodic stimulus."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import RelativePeriodicStimulus, TimeGaussDistribution, TimeUniformDistribution
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Downgraded, ModelRule


def _check(element: RelativePeriodicStimulus, context: Context) -> Iterator[str | Downgraded]:
    if element.next_occurrence is None:
        yield Downgraded(f"the stimulus {element.name or ''!r} has no next occurrence")
    elif not isinstance(element.next_occurrence, TimeGaussDistribution | TimeUniformDistribution):
        yield f"the next occurrence of the stimulus {element.name or ''!r} is not a uniform or Gaussian distribution"


RULE = ModelRule(
    id="INC-ST-RELPER",
    title="unsupported relative periodic stimulus",
    severity=Severity.ERROR,
    target=RelativePeriodicStimulus,
    check=_check,
    rationale="am2inc aborts the conversion if the next occurrence has another distribution. If there is none, it silently uses a "
    "period of 0 (warning).",
    remedy="Specify the next occurrence as a uniform or Gaussian distribution.",
    fails="""
<stimuliModel>
  <stimuli xsi:type="am:RelativePeriodicStimulus" name="S">
    <nextOccurrence xsi:type="am:TimeConstant">
      <value value="1" unit="ms"/>
    </nextOccurrence>
  </stimuli>
</stimuliModel>
""",
    edits={
        """<nextOccurrence xsi:type="am:TimeConstant">
      <value value="1" unit="ms"/>""": """<nextOccurrence xsi:type="am:TimeUniformDistribution">
      <lowerBound value="1" unit="ms"/>
      <upperBound value="2" unit="ms"/>""",
    },
)
