"""The least time between two occurrences of a stimulus, also of one that states none, so that its rate has no bound."""

from __future__ import annotations

from amalthea_uros._internal.records import replace
from amalthea_uros.design.changes.key import STIMULI, UNSET, Configuration, Key, positive_duration
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.distributions import Boundaries, Constant, Distribution, highest, lowest
from amalthea_uros.perf.stimuli import ArrivalCurve, Custom, Periodic, RelativePeriodic, Stimulus, VariableRate
from amalthea_uros.timing.event_models.stimuli import event_model_of
from amalthea_uros.units import Time, time_text


def _show(configuration: Configuration, name: str) -> str:
    match configuration.system.stimuli_by_name[name]:
        case Periodic(min_distance=least) if least is not None:
            return time_text(least)
        case RelativePeriodic(distance=distance):
            least = lowest(distance)
            return time_text(least) if least and least > 0 else UNSET
    return UNSET


def _set(configuration: Configuration, name: str, least: Time) -> Configuration:
    system = configuration.system
    stimulus = system.stimuli_by_name[name]
    if not isinstance(stimulus, Periodic | RelativePeriodic) and event_model_of(stimulus, system) is not None:
        raise InvalidArgumentError(
            f"the stimulus {name!r} is {type(stimulus).__name__}, and its least distance follows from that"
        )
    changed = _with_least(stimulus, least)
    return configuration._replace(system=STIMULI.with_each(system, lambda each: changed if each.name == name else each))


def _with_least(stimulus: Stimulus, least: Time) -> Stimulus:
    match stimulus:
        case Periodic():
            return replace(stimulus, min_distance=least)
        case RelativePeriodic(distance=distance, has_maximum=has_maximum):
            changed = _at_least(distance, least)
            return replace(stimulus, distance=changed, has_maximum=has_maximum and highest(changed) == highest(distance))
        case Custom() | ArrivalCurve() | VariableRate():
            # Nothing else is known of it: any two occurrences can be as near, or farther apart.
            return RelativePeriodic(
                name=stimulus.name,
                distance=Constant(least),
                has_maximum=False,
                condition=stimulus.condition,
                assignments=stimulus.assignments,
                origin=stimulus.origin,
            )
    raise InvalidArgumentError(f"the stimulus {stimulus.name!r} is {type(stimulus).__name__}, which has no least distance")


def _at_least(distance: Distribution[int], least: Time) -> Distribution[int]:
    """A distance of the same maximum, if that is not less."""
    longest = highest(distance)
    return Constant(least) if longest is None or longest <= least else Boundaries(lower=least, upper=longest)


MIN_DISTANCE = Key(positive_duration, _show, _set)
