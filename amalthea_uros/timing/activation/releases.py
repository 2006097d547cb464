"""Known releases of processes, their deadlines, and the phases and arrivals of what comes from outside.

Deadlines are response-time limits, or the period (C. L. Liu and J. W. Layland 1973).

Nobody knows in which job of a task what comes from outside, such as a message, is taken first. A counter with a source represents such
an event. If its phase is not known, each of its phases is possible, and each is a system of its own in which the phase is known.

Messages that do not arrive regularly: a job takes a message that arrived before its activation. Messages with period T and jitter J
are taken by jobs with period P: in the long run by every floor(T / P)-th job or fewer, and up to ceil(J / P) jobs later than regular
ones. So the number of jobs in a sequence that take one is bounded as events of an event model with jitter are (K. Richter,
"Compositional Scheduling Analysis Using Standard Event Models", TU Braunschweig 2005). Which jobs these are is unknown.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from itertools import product
from math import prod
from typing import TypeVar

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.activities import Activity, Call, Trigger, transformed, walk
from amalthea_uros.perf.constraints import Bound, TimeLimit, TimeMetric
from amalthea_uros.perf.distributions import highest, lowest
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Arrivals, Burst, Counter, Periodic, RelativePeriodic, Synthetic
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents
from amalthea_uros.timing.jobs.counters import first_effect
from amalthea_uros.units import Time, time_text

P = TypeVar("P", bound=Process)

RELEASES = "periodic tasks are released at their offsets; the default offset is 0"


def known_releases(process: Process, system: System) -> Periodic | None:
    """The stimulus of a process with known releases; None if they are unknown."""
    match [system.stimuli_by_name.get(name) for name in process.stimuli]:
        case [Periodic(jitter=None, condition=None, period=period, offset=offset) as stimulus] if (
            0 < period <= LIMIT and 0 <= offset <= LIMIT
        ):
            return stimulus
    return None


@dataclass(frozen=True, slots=True, kw_only=True)
class JitteredReleases:
    """Releases with a period, each of which can be later by a jitter.

    Attributes
    ----------
    earliest : time of the first release, as early as it can be
    """

    period: Time
    earliest: Time
    jitter: Time = 0


def releases_with_jitter(process: Process, system: System) -> JitteredReleases | None:
    """The releases of a process, known but for a jitter that keeps their order; None if less is known."""
    exact = known_releases(process, system)
    if exact is not None:
        return JitteredReleases(period=exact.period, earliest=exact.offset)
    match [system.stimuli_by_name.get(name) for name in process.stimuli]:
        case [Periodic(condition=None, min_distance=None, period=period, offset=offset, jitter=jitter)] if (
            jitter is not None and 0 < period <= LIMIT and 0 <= offset <= LIMIT
        ):
            least, most = lowest(jitter), highest(jitter)
            # A jitter can be negative, but nothing is released before the start.
            if least is not None and most is not None and max(0, offset + least) <= offset + most < offset + least + period:
                return JitteredReleases(period=period, earliest=offset + least, jitter=most - least)
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


@dataclass(frozen=True, slots=True)
class ExternalInput:
    """What comes from outside, taken by every n-th job of a process.

    Attributes
    ----------
    source : name of the message or timer
    every : the n
    """

    process: str
    source: str
    every: int

    @classmethod
    def of(cls, process: str, counter: Counter) -> ExternalInput:
        """What a counter in the jobs of a process represents."""
        return cls(process, counter.source, counter.prescaler)


def sources(system: System) -> list[str]:
    """The names of everything from outside that counters represent."""
    return list(dict.fromkeys(counter.source for _, counter in counters(system) if counter.source))


def unknown_phases(system: System) -> tuple[ExternalInput, ...]:
    """What comes from outside with an unknown phase."""
    return tuple(
        dict.fromkeys(
            ExternalInput.of(process, counter)
            for process, counter in counters(system)
            if counter.source and not counter.is_phase_known
        )
    )


def unstated_phases(system: System, times: Mapping[str, Time]) -> tuple[ExternalInput, ...]:
    """What comes from outside with an unknown phase, also with respect to times at which some sources are due for the first time.

    A simulation uses such a time for irregular arrivals, too, although it does not say which jobs take them.
    """
    return tuple(each for each in unknown_phases(with_first_arrivals(system, times)) if each.source not in times)


def phase_count(occurrences: Sequence[ExternalInput]) -> int:
    """The number of combinations of all phases."""
    return prod(occurrence.every for occurrence in occurrences)


def phase_combinations(occurrences: Sequence[ExternalInput]) -> Iterator[Mapping[ExternalInput, int]]:
    """For each combination of phases the first job that takes each occurrence."""
    for firsts in product(*(range(1, occurrence.every + 1) for occurrence in occurrences)):
        yield dict(zip(occurrences, firsts, strict=True))


def with_phases(system: System, combination: Mapping[ExternalInput, int]) -> System:
    """The system in which some unknown phases are known."""

    def known(process: Process, counter: Counter) -> Counter:
        first = combination.get(ExternalInput.of(process.name, counter))
        if first is None or counter.is_phase_known:
            return counter
        return replace(counter, offset=first, is_phase_known=True)

    return with_counters(system, known)


def with_stated_phases(system: System, times: Mapping[str, Time]) -> System:
    """The system in which some sources are first taken at stated times.

    The job that takes it is released at that time. If another process counts the same source, its next job is the first one.

    Raises
    ------
    InvalidArgumentError : no job that takes it is released at that time.
    """
    for source, time in times.items():
        takers = [process for process, counter in counters(system) if counter.source == source]
        if takers and not any(_is_release(time, system.processes[taker], system) for taker in takers):
            raise InvalidArgumentError(_no_release(time, source, system.processes[takers[0]], system))
    return with_first_arrivals(system, times)


def with_first_arrivals(system: System, times: Mapping[str, Time]) -> System:
    """The system in which some sources are due for the first time at any times: the first job released then or later takes it.

    Irregular arrivals are left as they are.

    Raises
    ------
    InvalidArgumentError : the release times of a process that takes it are unknown.
    """

    def stated(process: Process, counter: Counter) -> Counter:
        if counter.source not in times or counter.arrivals is not None:
            return counter
        return replace(counter, offset=_first_job(times[counter.source], process, system), is_phase_known=True)

    return with_counters(system, stated) if times else system


def _is_release(time: Time, process: Process, system: System) -> bool:
    releases = known_releases(process, system)
    return releases is not None and time >= releases.offset and (time - releases.offset) % releases.period == 0


def _no_release(time: Time, source: str, process: Process, system: System) -> str:
    releases = known_releases(process, system)
    if releases is None:
        return f"the phase of {source!r} cannot be stated: the release times of {process.name!r} are unknown"
    grid = f"{time_text(releases.offset)} + n * {time_text(releases.period)}"
    return f"the phase {time_text(time)} of {source!r} is not an activation of {process.name!r}, which are at {grid}"


def _first_job(time: Time, process: Process, system: System) -> int:
    """The number of the first job that is released at a time or later, counted from 1."""
    releases = known_releases(process, system)
    if releases is None:
        raise InvalidArgumentError(f"the phase cannot be stated: the release times of {process.name!r} are unknown")
    return max(0, -(-(time - releases.offset) // releases.period)) + 1


def phase_assumptions(system: System, are_all_evaluated: bool) -> Iterator[str]:
    """What is assumed about phases, in sentences."""
    for process, counter in counters(system):
        if not counter.source:
            continue
        due = f"{counter.source} is due regularly, in one of {counter.prescaler} jobs of {process}"
        if not counter.is_phase_known:
            how = "all phases are evaluated" if are_all_evaluated else "any job can be that one"
            yield f"{due}, and its phase is unknown: {how}"
            continue
        time = first_time(process, counter, system)
        at = "" if time is None else f", at {time_text(time)}"
        yield f"{due}, first in job {first_effect(counter)}{at}, as stated"


def first_time(process: str, counter: Counter, system: System) -> Time | None:
    """When the first job of a process is released that takes what a counter with a known phase represents; None if it is unknown."""
    releases = known_releases(system.processes[process], system)
    return None if releases is None else releases.offset + (first_effect(counter) - 1) * releases.period


def counters(system: System) -> Iterator[tuple[str, Counter]]:
    """The counters in the jobs of processes, with the name of the process."""
    for name, process in system.processes.items():
        for counter in own_counters(process):
            yield name, counter


def own_counters(process: Process) -> Iterator[Counter]:
    """The counters in the jobs of a process."""
    for activity in walk(process.activities):
        if isinstance(activity, Call | Trigger) and activity.counter is not None and activity.counter.prescaler >= 1:
            yield activity.counter


def with_counters(system: System, change: Callable[[Process, Counter], Counter]) -> System:
    """The system with the counters in the jobs of its processes changed; a process in which none changes is the same object."""

    def changed(process: P) -> P:
        activities = transformed(process.activities, partial(with_counter, process))
        return process if activities == process.activities else replace(process, activities=activities)

    def with_counter(process: Process, activity: Activity) -> Activity:
        match activity:
            case Call(counter=Counter() as counter) | Trigger(counter=Counter() as counter) if counter.prescaler >= 1:
                return replace(activity, counter=change(process, counter))
        return activity

    software = system.software
    return replace(
        system,
        software=replace(
            software,
            tasks=tuple(map(changed, software.tasks)),
            isrs=tuple(map(changed, software.isrs)),
        ),
    )


def arriving(system: System) -> list[str]:
    """The names of the messages that arrive irregularly."""
    return list(dict.fromkeys(counter.source for _, counter in counters(system) if counter.arrivals is not None))


def nominal_period(process: Process, counter: Counter, system: System) -> Time | None:
    """The nominal time from one message that a counter represents to the next; None if it is unknown."""
    arrivals = counter.arrivals or Arrivals()
    if arrivals.period is not None:
        return arrivals.period
    period = activation_period(process, system)
    return None if period is None else counter.prescaler * period


def with_bounded_arrivals(system: System) -> System:
    """The system in which irregular arrivals are counters that can be late; itself if there are none."""
    if not any(counter.arrivals for _, counter in counters(system)):
        return system
    return with_counters(system, lambda process, counter: _bounded(process, counter, system))


def _bounded(process: Process, counter: Counter, system: System) -> Counter:
    if counter.arrivals is None:
        return counter
    releases, interval = known_releases(process, system), nominal_period(process, counter, system)
    if releases is None or interval is None:
        return Counter(is_phase_known=False, jitter=counter.prescaler)
    late = -(-counter.arrivals.jitter // releases.period)
    return Counter(prescaler=max(1, interval // releases.period), is_phase_known=False, jitter=late)


def arrival_assumptions(system: System) -> Iterator[str]:
    """What is assumed about irregular arrivals, in sentences."""
    for name, counter in counters(system):
        if counter.arrivals is not None:
            interval = nominal_period(system.processes[name], counter, system)
            every = "" if interval is None else f" every {time_text(interval)}"
            jitter = time_text(counter.arrivals.jitter)
            yield f"{counter.source} is due{every} with a jitter of {jitter}: it is unknown in which jobs of {name}"
