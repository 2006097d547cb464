"""Known releases of processes, and their deadlines: response-time limits, or the period (C. L. Liu and J. W. Layland 1973)."""

from __future__ import annotations

from amalthea_uros.perf.constraints import Bound, TimeLimit, TimeMetric
from amalthea_uros.perf.distributions import highest
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Burst, Periodic, RelativePeriodic, Synthetic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.event_models import EventModel, PeriodicEvents
from amalthea_uros.units import Time


def known_releases(process: Process, system: System) -> Periodic | None:
    """The stimulus of a process with known releases; None if they are unknown."""
    match [system.stimuli_by_name.get(name) for name in process.stimuli]:
        case [Periodic(jitter=None, condition=None, period=period, offset=offset) as stimulus] if (
            0 < period <= LIMIT and 0 <= offset <= LIMIT
        ):
            return stimulus
    return None


def latest_first_release(process: Process, system: System) -> Time:
    """The latest time of the first release of a process with a single stimulus; 0 for stimuli that do not state it."""
    match [system.stimuli_by_name.get(name) for name in process.stimuli]:
        case [Periodic(offset=offset, jitter=jitter)]:
            return offset + ((highest(jitter) or 0) if jitter is not None else 0)
        case [RelativePeriodic(offset=offset) | Burst(offset=offset)]:
            return offset
        case [Synthetic(offset=offset, times=times)] if times:
            return offset + min(times)
    return 0


def activation_period(process: Process, system: System) -> Time | None:
    """The period of the only stimulus of a process, with or without jitter; None if it has none."""
    match [system.stimuli_by_name.get(name) for name in process.stimuli]:
        case [Periodic(period=period)] if period > 0:
            return period
    return None


def response_time_limits(system: System) -> dict[str, Time]:
    """The strictest response-time limit of each process by its requirements."""
    found: dict[str, Time] = {}
    for requirement in system.constraints.requirements:
        match requirement.limit:
            case TimeLimit(metric=TimeMetric.RESPONSE_TIME, bound=Bound.UPPER, value=value) if requirement.process:
                found[requirement.process] = min(value, found.get(requirement.process, value))
    return found


ASSUMPTION = "the deadline of a process without a stated one is its period, or the minimum time between sporadic activations"


def implicit_deadline(events: EventModel) -> Time | None:
    """The period, or the minimum interarrival time of sporadic activations; None for other activations, e.g. triggered ones."""
    return events.period if isinstance(events, PeriodicEvents) else None
