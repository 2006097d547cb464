"""Stimuli as event models."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.analyze.response_times.kernel import LIMIT
from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.distributions import highest, lowest
from amalthea_uros.perf.system import System
from amalthea_uros.timing.event_models.base import Arrivals, Curve, Once, Pattern, Periodic
from amalthea_uros.units import SECOND, Frequency

#: Of longer lists of occurrences nothing is made.
MOST_OCCURRENCES = 10_000


def arrivals_of(stimulus: perf.Stimulus, system: System) -> Arrivals | None:
    """The event model of a stimulus that comes from outside; None if nothing bounds it, or another process fires it.

    Times beyond what can be counted (13 days) bound nothing either.
    """
    found = _arrivals_of(stimulus, system)
    match found:
        case Periodic():
            times = [found.period, found.jitter, found.distance]
        case Pattern():
            times = [found.period]
        case Curve():
            times = [time for _, time in found.distances]
        case _:
            times = []
    return None if any(time > LIMIT for time in times) else found


def _arrivals_of(stimulus: perf.Stimulus, system: System) -> Arrivals | None:
    match stimulus:
        case perf.Periodic(period=period, jitter=jitter, min_distance=distance) if period > 0:
            if jitter is None:
                return Periodic(period, 0, distance or 0)
            earliest, latest = lowest(jitter), highest(jitter)
            return None if earliest is None or latest is None else Periodic(period, max(0, latest - earliest), distance or 0)
        case perf.RelativePeriodic(distance=distance):
            least = lowest(distance)
            longest = highest(distance)
            if not least:
                return None
            return Periodic(least) if least == longest else Periodic(least, sporadic=True, longest=longest)
        case perf.Synthetic(period=period, times=times) if period > 0 and times:
            # Times beyond the period fall into later ones, where they meet those of the next rounds.
            return Pattern(period, tuple(sorted(time % period for time in times)))
        case perf.Burst(period=period, length=length, distance=distance, count=count) if period > 0:
            happening = min(count, -(-max(length, 1) // distance)) if distance > 0 else count
            if not 0 < happening <= MOST_OCCURRENCES or (happening - 1) * distance >= period:
                return None
            return Pattern(period, tuple(index * distance for index in range(happening)))
        case perf.Single():
            return Once()
        case perf.ArrivalCurve(points=points):
            limits = tuple((p.occurrences, p.lower) for p in points if p.lower and 1 < p.occurrences <= MOST_OCCURRENCES)
            return Curve(limits) if limits else None
        case perf.VariableRate(step=step, rate=rate, scenario=None) if step > 0:
            highest_rate = highest(rate)
            return Periodic(max(1, int(step / Fraction(highest_rate))), sporadic=True) if highest_rate else None
        case perf.VariableRate(scenario=perf.Scenario(clock=name, recurrence=recurrence)) if recurrence > 0:
            frequency = _greatest(next((clock for clock in system.stimuli.clocks if clock.name == name), None))
            # An occurrence whenever the integral of the frequency has grown by the recurrence.
            least = int(Fraction(recurrence) * SECOND / frequency) if frequency else 0
            return Periodic(least, sporadic=True) if least else None
    return None


def _greatest(clock: perf.Clock | None) -> Frequency | None:
    match clock:
        case perf.ClockFunction(lowest=lowest, swing=swing):
            return lowest + swing
        case perf.ClockSteps(steps=steps):
            return max((step.frequency for step in steps), default=None)
    return None
