"""Stimuli as event models."""

from __future__ import annotations

from amalthea_uros.analyze.arrivals import Arrivals, Curve, Once, Pattern, Periodic
from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.distributions import highest, lowest


def arrivals_of(stimulus: perf.Stimulus) -> Arrivals | None:
    """The event model of a stimulus that comes from outside; None if nothing bounds it, or another process fires it."""
    match stimulus:
        case perf.Periodic(period=period, jitter=jitter, min_distance=distance) if period > 0:
            if jitter is None:
                return Periodic(period, 0, distance or 0)
            earliest, latest = lowest(jitter), highest(jitter)
            return None if earliest is None or latest is None else Periodic(period, latest - earliest, distance or 0)
        case perf.RelativePeriodic(distance=distance):
            least = lowest(distance)
            is_fixed = least == highest(distance)
            return Periodic(least, sporadic=not is_fixed) if least else None
        case perf.Synthetic(period=period, times=times) if period > 0 and times:
            # Times beyond the period fall into later ones, where they meet those of the next rounds.
            return Pattern(period, tuple(sorted(time % period for time in times)))
        case perf.Burst(period=period, length=length, distance=distance, count=count) if period > 0:
            times = tuple(index * distance for index in range(count) if index * distance < max(length, 1))
            return Pattern(period, times) if times and times[-1] < period else None
        case perf.Single():
            return Once()
        case perf.ArrivalCurve(points=points):
            limits = tuple((p.occurrences, p.lower) for p in points if p.lower and p.occurrences > 1)
            return Curve(limits) if limits else None
    return None
