"""Execution times of runnables and tasks, as ticks, or as time at the clock of the core that executes them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from itertools import takewhile

from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.key import RUNNABLES, UNSET, Collection, Configuration, Key, duration, process_place
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import listed
from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Call,
    Demand,
    Execute,
    ExecutionNeed,
    LabelAccess,
    transformed,
    walk,
)
from amalthea_uros.perf.distributions import Boundaries, Constant, Distribution, Sampling, highest, lowest
from amalthea_uros.perf.system import System
from amalthea_uros.timing.jobs.executed import executed
from amalthea_uros.timing.scheduling.allocation import allocated_cores
from amalthea_uros.units import Frequency, down, ticks_of_time, time_of_ticks, time_text, up

_TICKS = re.compile(r"(\d{1,18})\s*ticks?", re.ASCII)


@dataclass(frozen=True, slots=True)
class ExecutionTime:
    """An execution time between two values.

    Attributes
    ----------
    lower, upper : ticks, or picoseconds
    """

    lower: int
    upper: int
    in_ticks: bool


def _parse(text: str) -> ExecutionTime:
    """One value such as "12us" or "300 ticks", or a range such as "2us..4us"."""
    lower, separator, upper = text.partition("..")
    ends = [_end(lower.strip()), _end((upper if separator else lower).strip())]
    if ends[0][1] != ends[1][1]:
        raise ValueError(f"{text!r} mixes a time and ticks")
    if ends[0][0] > ends[1][0]:
        raise ValueError(f"{text!r} ends before it starts")
    return ExecutionTime(ends[0][0], ends[1][0], ends[0][1])


def _end(text: str) -> tuple[int, bool]:
    if match := _TICKS.fullmatch(text):
        return int(match[1]), True
    if text.isdecimal():
        raise ValueError(f"{text!r} has no unit; write a time such as '12 us', or '{text} ticks'")
    return duration(text), False


def _distribution(time: ExecutionTime, frequency: Callable[[], Frequency]) -> Distribution[int]:
    """The ticks of an execution time: lower bounds are rounded down, upper bounds and single values up."""
    lower, upper = time.lower, time.upper
    if not time.in_ticks:
        rate = frequency()
        lower, upper = down(ticks_of_time(time.lower, rate)), up(ticks_of_time(time.upper, rate))
    if time.lower == time.upper:
        return Constant(upper)
    # A range without a distribution means in an app.yaml, too, that each value is equally probable.
    return Boundaries(lower=lower, upper=upper, sampling=Sampling.UNIFORM)


def _demands(activities: Iterable[Activity]) -> list[Execute | ExecutionNeed]:
    return [activity for activity in activities if isinstance(activity, Execute | ExecutionNeed)]


def _called(process: str, system: System) -> set[str]:
    """The runnables that a process executes."""
    activities = executed(system.processes[process].activities, system)
    return {activity.runnable for activity in activities if isinstance(activity, Call)}


def _callers(runnable: str, system: System) -> list[str]:
    """The processes that execute a runnable."""
    return [process for process in system.processes if runnable in _called(process, system)]


def _show_runnable(configuration: Configuration, name: str) -> str:
    demands = _demands(walk(configuration.system.runnables[name].activities))
    return _text(demands, _known_frequency(name, _callers(name, configuration.system), configuration))


def _show_process(configuration: Configuration, name: str) -> str:
    demands = _demands(executed(configuration.system.processes[name].activities, configuration.system))
    return _text(demands, _known_frequency(name, [name], configuration))


def _text(demands: list[Execute | ExecutionNeed], frequency: Frequency | None) -> str:
    match demands:
        case [Execute(demand=Demand(ticks=ticks))] if ticks is not None:
            lower, upper = lowest(ticks), highest(ticks)
            if frequency is not None:
                ends = ["" if end is None else time_text(time_of_ticks(end, frequency)) for end in (lower, upper)]
                return ends[0] if lower == upper else "..".join(ends)
            return f"{upper} ticks" if lower == upper else f"{lower}..{'' if upper is None else upper} ticks"
    return "several values" if demands else UNSET


def _known_frequency(name: str, processes: Iterable[str], configuration: Configuration) -> Frequency | None:
    try:
        return _frequency(name, processes, configuration)
    except InvalidArgumentError:
        return None


def _set_runnable(configuration: Configuration, name: str, time: ExecutionTime) -> Configuration:
    system = configuration.system
    distribution = _distribution(time, lambda: _frequency(name, _callers(name, system), configuration))
    return _with_demand(configuration, RUNNABLES, name, distribution)


def _set_process(configuration: Configuration, name: str, time: ExecutionTime) -> Configuration:
    """Change the demand of a process itself, or else of the only runnable that it executes and nobody else does.

    Overheads of the operating system stay as they are. A process that does nothing gets a demand.
    """
    system = configuration.system
    process = system.processes[name]
    distribution = _distribution(time, lambda: _frequency(name, [name], configuration))
    called = _called(name, system)
    runnables = [
        name
        for name, runnable in system.runnables.items()
        if name in called and not runnable.is_overhead and _demands(walk(runnable.activities))
    ]
    match _demands(walk(process.activities)), runnables:
        case [], [runnable] if _callers(runnable, system) == [name]:
            return _with_demand(configuration, RUNNABLES, runnable, distribution)
        case own, [] if own or not called:
            return _with_demand(configuration, process_place(process), name, distribution)
    choices = listed([f"{each}.execution_time" for each in runnables or sorted(called)])
    raise InvalidArgumentError(f"{name!r} has no single execution time of its own; change those of its runnables: {choices}")


def _with_demand(configuration: Configuration, place: Collection, name: str, ticks: Distribution[int]) -> Configuration:
    """The configuration in which the only demand of a process or runnable is another one, or a new one between reading and writing."""
    activities = place.find(configuration.system, name).activities
    if not (count := len(_demands(walk(activities)))):
        reads = len(list(takewhile(_is_read, activities)))
        activities = (*activities[:reads], Execute(demand=Demand()), *activities[reads:])
    elif count > 1:
        raise InvalidArgumentError(f"{name!r} contains {count} execution times, so it is not clear which one to change")

    def changed(activity: Activity) -> Activity:
        if isinstance(activity, Execute | ExecutionNeed):
            return Execute(demand=Demand(ticks), locate=activity.locate)
        return activity

    fields = {"activities": transformed(activities, changed)}
    return configuration._replace(system=place.with_fields(configuration.system, name, **fields))


def _is_read(activity: Activity) -> bool:
    return isinstance(activity, LabelAccess) and activity.kind is AccessKind.READ


def _frequency(name: str, processes: Iterable[str], configuration: Configuration) -> Frequency:
    """The frequency of all cores that execute a process or runnable."""
    system, settings = configuration
    cores_of = allocated_cores(system)
    cores = {core for process in processes for core in cores_of.get(process, ()) if core in system.cores}
    frequencies = {settings.frequencies.get(core) or system.frequency_of(system.cores[core].clock) for core in cores}
    frequency = frequencies.pop() if len(frequencies) == 1 else None
    if frequency is None:
        reason = "on cores with different frequencies" if frequencies else "on a core of unknown frequency"
        raise InvalidArgumentError(f"{name!r} is executed {reason}; write its execution time in ticks, e.g. '300 ticks'")
    return frequency


RUNNABLE_KEY = Key(_parse, _show_runnable, _set_runnable)
PROCESS_KEY = Key(_parse, _show_process, _set_process)
