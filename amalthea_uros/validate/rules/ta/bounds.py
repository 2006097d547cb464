"""The order of two values: a mean and a bound, or a minimum and a maximum."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from amalthea_uros.diagnostics import Severity
from amalthea_uros.metamodel.classes import (
    ContinuousValueGaussDistribution,
    DataAgeTime,
    DelayConstraint,
    DiscreteValueGaussDistribution,
    EventChainLatencyConstraint,
    RepetitionConstraint,
    Time,
    TimeGaussDistribution,
)
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.units import time_text
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.examples import runnable_with
from amalthea_uros.validate.rule import Check, ModelRule

_Gauss = DiscreteValueGaussDistribution | ContinuousValueGaussDistribution | TimeGaussDistribution


def _check_mean(gauss: _Gauss, context: Context) -> Iterator[str]:
    """Compare the mean of a distribution with its bounds; missing and non-finite values are skipped."""
    mean, lower, upper = (_value(gauss.effective(name)) for name in ("mean", "lower_bound", "upper_bound"))
    if mean is not None and lower is not None and mean < lower:
        yield f"the mean {_text(gauss.mean)} is below the lower bound {_text(gauss.lower_bound)}"
    if mean is not None and upper is not None and mean > upper:
        yield f"the mean {_text(gauss.mean)} is above the upper bound {_text(gauss.upper_bound)}"


def _value(value: Time | float | None) -> float | None:
    number = picoseconds(value) if isinstance(value, Time) else value
    return number if number is not None and isfinite(number) else None


def _text(value: Time | float | None) -> str:
    return time_text(picoseconds(value) or 0) if isinstance(value, Time) else str(value or 0)


def _reversed(what: str, lower: str, upper: str) -> Check:
    """Check whether the minimum time of a constraint is above its maximum; times without a unit are not compared."""

    def check(element: Element, context: Context) -> Iterator[str]:
        minimum, maximum = picoseconds(getattr(element, lower)), picoseconds(getattr(element, upper))
        if minimum is not None and maximum is not None and minimum > maximum:
            yield f"the minimum {what} {time_text(minimum)} is above the maximum {what} {time_text(maximum)}"

    return check


_BESIDE_PEAK = (
    "A distribution that is truncated beside its peak rarely matches measured values. APP4MC's validation also reports it."
)
_SWAP = "Swap the two values, or correct one of them."


RULES = (
    ModelRule(
        id="TA-Basic-ContinuousValueGaussDistribution-mean",
        title="mean outside the bounds of a continuous Gauss distribution",
        severity=Severity.ERROR,
        target=ContinuousValueGaussDistribution,
        check=_check_mean,
        rationale=_BESIDE_PEAK,
        remedy="Choose a mean between the bounds.",
        fails="""
<stimuliModel>
  <stimuli xsi:type="am:VariableRateStimulus" name="S">
    <step value="1" unit="s"/>
    <occurrencesPerStep xsi:type="am:ContinuousValueGaussDistribution" mean="0.5" sd="1" lowerBound="1" upperBound="9"/>
  </stimuli>
</stimuliModel>
""",
        edits={'mean="0.5"': 'mean="5"'},
    ),
    ModelRule(
        id="TA-Basic-DiscreteValueGaussDistribution-mean",
        title="mean outside the bounds of a discrete Gauss distribution",
        severity=Severity.ERROR,
        target=DiscreteValueGaussDistribution,
        check=_check_mean,
        rationale=_BESIDE_PEAK,
        remedy="Choose a mean between the bounds.",
        fails=runnable_with("""
<items xsi:type="am:Ticks">
  <default xsi:type="am:DiscreteValueGaussDistribution" mean="9.5" sd="1" lowerBound="1" upperBound="9"/>
</items>
"""),
        edits={'mean="9.5"': 'mean="5"'},
    ),
    ModelRule(
        id="TA-Basic-TimeGaussDistribution-mean",
        title="mean outside the bounds of a Gauss distribution of times",
        severity=Severity.ERROR,
        target=TimeGaussDistribution,
        check=_check_mean,
        rationale=_BESIDE_PEAK,
        remedy="Choose a mean between the bounds.",
        fails="""
<stimuliModel>
  <stimuli xsi:type="am:PeriodicStimulus" name="S">
    <recurrence value="10" unit="ms"/>
    <jitter xsi:type="am:TimeGaussDistribution">
      <lowerBound value="0" unit="ms"/>
      <upperBound value="900" unit="us"/>
      <mean value="1" unit="ms"/>
      <sd value="100" unit="us"/>
    </jitter>
  </stimuli>
</stimuliModel>
""",
        edits={'value="900" unit="us"': 'value="2" unit="ms"'},
    ),
    ModelRule(
        id="TA-Constraints-DataAgeTime",
        title="minimum data age above the maximum",
        severity=Severity.ERROR,
        target=DataAgeTime,
        check=_reversed("age", "minimum_time", "maximum_time"),
        rationale="No age can satisfy the constraint, so it is always violated. APP4MC's validation also reports it.",
        remedy=_SWAP,
        fails="""
<constraintsModel>
  <dataAgeConstraints name="D">
    <dataAge xsi:type="am:DataAgeTime">
      <minimumTime value="3" unit="ms"/>
      <maximumTime value="2" unit="ms"/>
    </dataAge>
  </dataAgeConstraints>
</constraintsModel>
""",
        edits={'value="3"': 'value="1"'},
    ),
    ModelRule(
        id="TA-Constraints-DelayConstraint",
        title="minimum delay above the maximum",
        severity=Severity.ERROR,
        target=DelayConstraint,
        check=_reversed("delay", "lower", "upper"),
        rationale="No delay can satisfy the constraint, so it is always violated. APP4MC's validation also reports it.",
        remedy=_SWAP,
        fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:DelayConstraint" name="D">
    <upper value="2" unit="ms"/>
    <lower value="3" unit="ms"/>
  </timingConstraints>
</constraintsModel>
""",
        edits={'value="3"': 'value="1"'},
    ),
    ModelRule(
        id="TA-Constraints-ECLConstraint",
        title="minimum event chain latency above the maximum",
        severity=Severity.ERROR,
        target=EventChainLatencyConstraint,
        check=_reversed("latency", "minimum", "maximum"),
        rationale="No latency can satisfy the constraint, so it is always violated. APP4MC's validation also reports it.",
        remedy=_SWAP,
        fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:EventChainLatencyConstraint" name="L" type="Reaction">
    <minimum value="3" unit="ms"/>
    <maximum value="2" unit="ms"/>
  </timingConstraints>
</constraintsModel>
""",
        edits={'value="3"': 'value="1"'},
    ),
    ModelRule(
        id="TA-Constraints-RepetitionConstraint",
        title="minimum repetition distance above the maximum",
        severity=Severity.ERROR,
        target=RepetitionConstraint,
        check=_reversed("distance", "lower", "upper"),
        rationale="No distance can satisfy the constraint, so it is always violated. APP4MC's validation also reports it.",
        remedy=_SWAP,
        fails="""
<constraintsModel>
  <timingConstraints xsi:type="am:RepetitionConstraint" name="R" span="1">
    <lower value="3" unit="ms"/>
    <upper value="2" unit="ms"/>
  </timingConstraints>
</constraintsModel>
""",
        edits={'value="3"': 'value="1"'},
    ),
)
