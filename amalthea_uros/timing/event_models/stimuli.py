"""Stimuli as event models."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.distributions import highest, lowest
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.event_models.models import (
    EventModel,
    EventPattern,
    MinimumDistances,
    PeriodicEvents,
    SingleEvent,
    SporadicEvents,
)
from amalthea_uros.units import SECOND, Frequency, Time

#: Stimuli with more occurrences are not analysed.
MAX_OCCURRENCES = 10_000


def event_model_of(stimulus: perf.Stimulus, system: System) -> EventModel | None:
    """The event model of an external stimulus; None if its rate is unbounded, or if it is triggered by processes.

    Times of more than 13 days exceed the supported range and are treated as unbounded.
    """
    found = _event_model_of(stimulus, system)
    match found:
        case PeriodicEvents():
            times = [found.period, found.jitter, found.min_interarrival]
        case EventPattern():
            times = [found.period]
        case MinimumDistances():
            times = [time for _, time in found.distances]
        case _:
            times = []
    return None if any(time > LIMIT for time in times) else found


def is_unbounded(stimulus: perf.Stimulus, system: System) -> bool:
    """Whether nothing bounds the rate of a stimulus that is no consequence of processes."""
    is_caused = isinstance(stimulus, perf.InterProcess | perf.EventTriggered)
    return not is_caused and event_model_of(stimulus, system) is None


def _event_model_of(stimulus: perf.Stimulus, system: System) -> EventModel | None:
    match stimulus:
        case perf.Periodic(period=period, jitter=jitter, min_distance=distance) if period > 0:
            if jitter is None:
                return PeriodicEvents(period, 0, max(0, distance or 0))
            earliest, latest = lowest(jitter), highest(jitter)
            if earliest is None or latest is None or earliest > latest:
                return None
            return PeriodicEvents(period, latest - earliest, max(0, distance or 0))
        case perf.RelativePeriodic(distance=distance, has_maximum=has_maximum):
            shortest, longest = lowest(distance), highest(distance)
            if shortest is None or shortest <= 0 or (longest is not None and longest < shortest):
                return None
            if not has_maximum:
                return SporadicEvents(shortest)
            return PeriodicEvents(shortest) if shortest == longest else SporadicEvents(shortest, longest=longest)
        case perf.Synthetic(period=period, times=times) if period > 0 and times:
            # Times beyond the period coincide with those of later periods.
            return EventPattern(period, tuple(sorted(time % period for time in times)), _longest_at_start(period, times))
        case perf.Burst(period=period, length=length, distance=distance, count=count) if period > 0:
            # Whether an occurrence at exactly the end of the burst is clipped is not stated; counting it is safe.
            occurrences = min(count, max(length, 0) // distance + 1) if distance > 0 else count
            if not 0 < occurrences <= MAX_OCCURRENCES or (occurrences - 1) * distance >= period:
                return None
            return EventPattern(period, tuple(index * distance for index in range(occurrences)))
        case perf.Single():
            return SingleEvent()
        case perf.ArrivalCurve(points=points):
            limits = tuple((p.occurrences, p.lower) for p in points if p.lower and 1 < p.occurrences <= MAX_OCCURRENCES)
            return MinimumDistances(limits) if limits else None
        case perf.VariableRate(step=step, rate=rate, scenario=None) if step > 0:
            highest_rate = highest(rate)
            return SporadicEvents(max(1, int(step / Fraction(highest_rate)))) if highest_rate else None
        case perf.VariableRate(scenario=perf.Scenario(clock=name, recurrence=recurrence)) if recurrence > 0:
            frequency = _max_frequency(next((clock for clock in system.stimuli.clocks if clock.name == name), None))
            # An event occurs whenever the integral of the frequency has increased by the recurrence.
            shortest = int(Fraction(recurrence) * SECOND / frequency) if frequency else 0
            return SporadicEvents(shortest) if shortest else None
    return None


def _longest_at_start(period: Time, times: tuple[Time, ...]) -> Time:
    """The maximum distance of events until times beyond the period have occurred for the first time; 0 if there are none.

    From then on, one period has them all.
    """
    if max(times) < period:
        return 0
    # The first event of each time; after the last of them, everything repeats.
    until = max(times)
    if until // period * len(times) > MAX_OCCURRENCES:
        return until
    found = sorted({time + shift for time in times for shift in range(0, until - time + 1, period)})
    return max((then - first for first, then in pairwise(found)), default=0)


def _max_frequency(clock: perf.Clock | None) -> Frequency | None:
    match clock:
        case perf.ClockFunction(lowest=lowest, swing=swing):
            return lowest + swing
        case perf.ClockSteps(steps=steps):
            return max((step.frequency for step in steps), default=None)
    return None
