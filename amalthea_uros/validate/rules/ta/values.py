"""Values out of order or out of range."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.magnitudes import picoseconds
from amalthea_uros.units import time_text
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import Check, model_rule

_Gauss = am.DiscreteValueGaussDistribution | am.ContinuousValueGaussDistribution | am.TimeGaussDistribution


@model_rule("TA-Basic-ContinuousValueGaussDistribution-mean", am.ContinuousValueGaussDistribution)
@model_rule("TA-Basic-DiscreteValueGaussDistribution-mean", am.DiscreteValueGaussDistribution)
@model_rule("TA-Basic-TimeGaussDistribution-mean", am.TimeGaussDistribution)
def _check_mean(gauss: _Gauss, context: Context) -> Iterator[str]:
    """Compare the mean of a distribution with its bounds; missing and non-finite values are skipped."""
    mean, lower, upper = (_value(gauss.effective(name)) for name in ("mean", "lower_bound", "upper_bound"))
    if mean is not None and lower is not None and mean < lower:
        yield f"the mean {_text(gauss.mean)} is below the lower bound {_text(gauss.lower_bound)}"
    if mean is not None and upper is not None and mean > upper:
        yield f"the mean {_text(gauss.mean)} is above the upper bound {_text(gauss.upper_bound)}"


def _value(value: am.Time | float | None) -> float | None:
    number = picoseconds(value) if isinstance(value, am.Time) else value
    return number if number is not None and isfinite(number) else None


def _text(value: am.Time | float | None) -> str:
    return time_text(picoseconds(value) or 0) if isinstance(value, am.Time) else str(value or 0)


def _reversed(what: str, lower: str, upper: str) -> Check:
    """Check whether the minimum time of a constraint is above its maximum; times without a unit are not compared."""

    def check(element: Element, context: Context) -> Iterator[str]:
        minimum, maximum = picoseconds(getattr(element, lower)), picoseconds(getattr(element, upper))
        if minimum is not None and maximum is not None and minimum > maximum:
            yield f"the minimum {what} {time_text(minimum)} is above the maximum {what} {time_text(maximum)}"

    return check


model_rule("TA-Constraints-DataAgeTime", am.DataAgeTime)(_reversed("age", "minimum_time", "maximum_time"))
model_rule("TA-Constraints-DelayConstraint", am.DelayConstraint)(_reversed("delay", "lower", "upper"))
model_rule("TA-Constraints-ECLConstraint", am.EventChainLatencyConstraint)(_reversed("latency", "minimum", "maximum"))
model_rule("TA-Constraints-RepetitionConstraint", am.RepetitionConstraint)(_reversed("distance", "lower", "upper"))


@model_rule("TA-Constraints-RTLimitMustBePositive", am.TimeRequirementLimit)
def _check_rtlimitmustbepositive(element: am.TimeRequirementLimit, context: Context) -> Iterator[str]:
    limit = element.limit_value
    if element.metric is am.TimeMetric.RESPONSE_TIME and limit is not None and (limit.value or 0) <= 0:
        yield f"the response time limit is {limit.value or 0}, but must be greater than 0"


@model_rule("TA-Misc-Semaphore", am.Semaphore)
def _check_semaphore(element: am.Semaphore, context: Context) -> Iterator[str]:
    initial, most = element.effective("initial_value"), element.effective("max_value")
    if initial < 0:
        yield f"the initial value of {element.name!r} is {initial}, but must be 0 or more"
    if most <= 0:
        yield f"the maximum value of {element.name!r} is {most}, but must be greater than 0"
    if most < initial:
        yield f"the initial value {initial} of {element.name!r} is above the maximum value {most}"


@model_rule("TA-Stimuli-VariableRateStimulusScenario", am.VariableRateStimulus)
def _check_variableratestimulusscenario(element: am.VariableRateStimulus, context: Context) -> Iterator[str]:
    if element.scenario is None:
        yield f"{element.name!r} has no scenario"
