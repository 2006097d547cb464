"""Systems of synthetic tasks, without any file: for textbook examples and experiments with many random task sets."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal
from fractions import Fraction
from inspect import signature
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.design.task_parameters import TaskParameters, task
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Demand,
    Execute,
    LabelAccess,
    SemaphoreAccess,
    SemaphoreOperation,
)
from amalthea_uros.perf.distributions import Boundaries, Constant, Uniform
from amalthea_uros.perf.events import EventChain, Events, ProcessChange, ProcessEvent, Segment
from amalthea_uros.perf.events import Sequence as InSequence
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure, StructureKind
from amalthea_uros.perf.mapping import Mapping as SystemMapping
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import OperatingSystem, Os, Policy, Scheduler, Semaphore, SemaphoreKind
from amalthea_uros.perf.software import Label, Software, Task
from amalthea_uros.perf.stimuli import Periodic, RelativePeriodic, Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.stated_times import TimeLike
from amalthea_uros.units import SECOND, Time

if TYPE_CHECKING:
    import pandas as pd

#: What makes a task of a set: `task(...)`; a period, a worst-case execution time, and perhaps a deadline; or the parameters of `task`.
TaskLike: TypeAlias = "TaskParameters | tuple[TimeLike, TimeLike] | tuple[TimeLike, TimeLike, TimeLike] | Mapping[str, Any]"

#: In the theory, jobs wait until their predecessors have ended, however many they are.
_NO_LIMIT = 2**31 - 1

#: A tick of the cores is a picosecond, so that execution times are exact.
_CLOCK = Clock(name="Clock", frequency=Fraction(SECOND))


def taskset(
    tasks: Iterable[TaskLike] | pd.DataFrame,
    *,
    chains: Mapping[str, Sequence[str]] | None = None,
    policy: Literal["fixed priority", "EDF"] = "fixed priority",
    priorities: Literal["rate monotonic", "deadline monotonic"] | None = None,
    unit: str | None = None,
) -> System:
    """A system of synthetic tasks and cause-effect chains.

    >>> liu_layland = taskset([(100, 40), (150, 40), (350, 100)], unit="ms", priorities="rate monotonic")

    Parameters
    ----------
    tasks : made by `task`; pairs of period and worst-case execution time, or triples with a deadline; or mappings or the rows of a
        data frame with the parameters of `task`, where None and NaN are not stated. Tasks without names are T1, T2, ...
    chains : names of tasks, in the order in which they pass data to each other; each chain begins with the start of a job of its
        first task, and ends with the end of a job of its last one
    policy : of all cores; under EDF, tasks without a deadline are scheduled by their periods
    priorities : how tasks get their priorities; without it, each task has the stated one, and nothing is assumed of the others
    unit : of the numbers in pairs, mappings and data frames; fractions of a picosecond are rounded to the safe side

    Raises
    ------
    InvalidArgumentError : a value is wrong, or a chain names a task that does not exist.
    """
    made = [_made(number, item, unit) for number, item in enumerate(_items(tasks), 1)]
    _check_names(made)
    if priorities is not None:
        made = _with_priorities(made, priorities)
    if policy not in _POLICIES:
        raise InvalidArgumentError(f"unknown policy {policy!r}; expected one of {', '.join(_POLICIES)}")
    if chains is not None and not isinstance(chains, Mapping):
        raise TypeError(f"expected the names of chains with their tasks, e.g. {{'a-b': ['A', 'B']}}, not {chains!r}")
    flows = _flows(made, chains or {})
    cores = tuple(dict.fromkeys(each.core for each in made))
    schedulers = tuple(
        Scheduler(name=_scheduler_name(core), policy=_POLICIES[policy], cores=(core,), executing_core=core) for core in cores
    )
    return System(
        hardware=_hardware(cores),
        os=Os(
            systems=(OperatingSystem(name="OS", schedulers=schedulers),),
            semaphores=_resources(made),
        ),
        stimuli=Stimuli(stimuli=tuple(map(_stimulus, made))),
        software=Software(
            tasks=tuple(_task(each, flows) for each in made),
            labels=tuple(Label(name=_label_name(flow), size=32) for flow in flows),
        ),
        mapping=SystemMapping(tasks=tuple(_allocation(each, policy) for each in made)),
        events=_events(chains or {}),
    )


_POLICIES = {"fixed priority": Policy.FIXED_PRIORITY_PREEMPTIVE, "EDF": Policy.EARLIEST_DEADLINE_FIRST}
#: By what tasks are ordered, the most urgent first.
_URGENCY: Mapping[str, Callable[[TaskParameters], Time]] = {
    "rate monotonic": lambda each: each.distance,
    "deadline monotonic": lambda each: each.deadline or each.distance,
}


#: The parameters of a task in a mapping.
_PARAMETERS = tuple(name for name in signature(task).parameters if name != "unit")
_EXPECTED = "expected tasks made by task(), pairs (period, wcet), triples (period, wcet, deadline), or mappings of parameters"


def _items(tasks: Iterable[TaskLike] | pd.DataFrame) -> Iterable[object]:
    """The tasks; those of a data frame are its rows."""
    rows = getattr(tasks, "to_dict", None)
    if rows is not None:
        found: list[dict[Any, Any]] = rows("records")
        return found
    if isinstance(tasks, str | Mapping | TaskParameters) or not isinstance(tasks, Iterable):
        raise TypeError(f"{_EXPECTED}, in a list; not {type(tasks).__name__}")
    return tasks


def _made(number: int, item: object, unit: str | None) -> TaskParameters:
    if isinstance(item, TaskParameters):
        return item
    if isinstance(item, Mapping):
        return _of_mapping(number, item, unit)
    values = tuple(item) if isinstance(item, Iterable) and not isinstance(item, str) else ()
    if len(values) not in (2, 3):
        raise TypeError(f"{_EXPECTED}; not {item!r}")
    return task(f"T{number}", **dict(zip(("period", "wcet", "deadline"), values, strict=False)), unit=unit)


def _of_mapping(number: int, values: Mapping[Any, Any], unit: str | None) -> TaskParameters:
    """The task of named parameters; what has no value is not stated."""
    stated = {"name": f"T{number}"} | {key: value for key, value in values.items() if not _is_missing(value)}
    name = stated["name"]
    for key in stated:
        if key not in _PARAMETERS:
            advice = did_you_mean(str(key), _PARAMETERS) or f"known: {', '.join(_PARAMETERS)}"
            raise InvalidArgumentError(f"{name}: unknown parameter {key!r}; {advice}")
    if "wcet" not in stated:
        raise InvalidArgumentError(f"{name}: the wcet is missing")
    if isinstance(stated.get("priority"), float) and stated["priority"].is_integer():
        stated["priority"] = int(stated["priority"])  # a column of a data frame in which some values are missing
    return task(stated.pop("name"), **stated, unit=unit)


def _is_missing(value: object) -> bool:
    """Whether a cell of a table is empty: None, NaN, or the NA of pandas, which cannot be compared."""
    return value is None or type(value).__name__ == "NAType" or (isinstance(value, float | Decimal) and value != value)


def _check_names(tasks: Sequence[TaskParameters]) -> None:
    seen: set[str] = set()
    for each in tasks:
        if each.name in seen:
            raise InvalidArgumentError(f"duplicate task {each.name!r}; give each task a name of its own")
        seen.add(each.name)


def _with_priorities(tasks: Sequence[TaskParameters], order: str) -> list[TaskParameters]:
    """The tasks with different priorities by an order; of equally urgent ones the first has the higher priority."""
    if order not in _URGENCY:
        raise InvalidArgumentError(f"unknown priorities {order!r}; expected one of {', '.join(_URGENCY)}")
    stated = next((each.name for each in tasks if each.priority is not None), None)
    if stated is not None:
        raise InvalidArgumentError(f"{stated!r} states a priority already; remove it, or priorities={order!r}")
    urgent = sorted(range(len(tasks)), key=lambda index: _URGENCY[order](tasks[index]))
    ranks = {index: len(tasks) - rank for rank, index in enumerate(urgent)}
    return [replace(each, priority=ranks[index]) for index, each in enumerate(tasks)]


def _hardware(cores: Sequence[str]) -> Hardware:
    made = tuple(Core(name=core, clock=_CLOCK.name) for core in cores)
    return Hardware(clocks=(_CLOCK,), structures=(Structure(name="ECU", kind=StructureKind.ECU, cores=made),))


def _resources(tasks: Sequence[TaskParameters]) -> tuple[Semaphore, ...]:
    """The resources of the critical sections; a ceiling protects those of one core only."""
    cores: dict[str, str] = {}
    for each in tasks:
        for name in each.critical_sections:
            if cores.setdefault(name, each.core) != each.core:
                message = f"the resource {name!r} is used on {cores[name]} and {each.core}; a ceiling protects one core only"
                raise InvalidArgumentError(f"{each.name}: {message}")
    return tuple(Semaphore(name=name, kind=SemaphoreKind.RESOURCE, ceiling=True) for name in cores)


def _scheduler_name(core: str) -> str:
    return f"Scheduler_{core}"


def _stimulus(each: TaskParameters) -> Periodic | RelativePeriodic:
    name = f"Activation_{each.name}"
    if each.period is None:
        return RelativePeriodic(name=name, distance=Constant(each.distance), has_maximum=False)
    if each.offset is None and not each.jitter:
        # The phase is unknown: all distances are the period, but the time of the first activation says nothing.
        return RelativePeriodic(name=name, distance=Constant(each.period))
    jitter = Uniform(lower=0, upper=each.jitter) if each.jitter else None
    return Periodic(name=name, period=each.period, offset=each.offset or 0, jitter=jitter)


def _allocation(each: TaskParameters, policy: str) -> TaskAllocation:
    deadline = each.distance if each.deadline is None and policy == "EDF" else each.deadline
    return TaskAllocation(task=each.name, scheduler=_scheduler_name(each.core), priority=each.priority, deadline=deadline)


def _flows(tasks: Sequence[TaskParameters], chains: Mapping[str, Sequence[str]]) -> dict[tuple[str, str], None]:
    """From which tasks to which ones data flow."""
    names = {each.name for each in tasks}
    for chain, path in chains.items():
        if isinstance(path, str) or not path:
            raise InvalidArgumentError(f"chain {chain!r}: expected a list of tasks, e.g. ['A', 'B'], not {path!r}")
        for name in path:
            if name not in names:
                advice = did_you_mean(name, names) or f"known: {', '.join(sorted(names))}"
                raise InvalidArgumentError(f"chain {chain!r}: undefined task {name!r}; {advice}")
        if len(set(path)) < len(path):
            raise InvalidArgumentError(f"chain {chain!r}: a task occurs twice, but a chain cannot contain cycles")
    return dict.fromkeys(link for path in chains.values() for link in pairwise(path))


def _label_name(flow: tuple[str, str]) -> str:
    return "_to_".join(flow)


def _task(each: TaskParameters, flows: Iterable[tuple[str, str]]) -> Task:
    def accesses(kind: AccessKind, end: int) -> Iterator[LabelAccess]:
        for flow in flows:
            if flow[end] == each.name:
                yield LabelAccess(label=_label_name(flow), kind=kind, communication=each.communication)

    return Task(
        name=each.name,
        stimuli=(f"Activation_{each.name}",),
        activities=(*accesses(AccessKind.READ, 1), *_execution(each), *accesses(AccessKind.WRITE, 0)),
        preemption=each.preemption,
        activation_limit=_NO_LIMIT,
    )


def _execution(each: TaskParameters) -> Iterator[Activity]:
    """The critical sections, and then the rest: a job that could not be preempted up to its end would respond earlier."""
    is_constant = each.bcet == each.wcet
    held = sum(each.critical_sections.values())
    for name, time in each.critical_sections.items():
        yield SemaphoreAccess(semaphore=name, operation=SemaphoreOperation.REQUEST)
        yield _executed(time if is_constant else 0, time)
        yield SemaphoreAccess(semaphore=name, operation=SemaphoreOperation.RELEASE)
    yield _executed(max(0, each.bcet - held), each.wcet - held)


def _executed(least: Time, most: Time) -> Execute:
    return Execute(demand=Demand(Constant(most) if least == most else Boundaries(lower=least, upper=most)))


def _events(chains: Mapping[str, Sequence[str]]) -> Events:
    events: dict[str, ProcessEvent] = {}

    def event(name: str, change: ProcessChange) -> str:
        made = ProcessEvent(name=f"{name}_{change}", process=name, change=change)
        return events.setdefault(made.name, made).name

    def chain(name: str, path: Sequence[str]) -> EventChain:
        first = event(path[0], ProcessChange.START)
        ends = [event(each, ProcessChange.TERMINATE) for each in (path[1:] or path)]
        segments = tuple(Segment(stimulus=one, response=then) for one, then in pairwise((first, *ends)))
        return EventChain(
            name=name, stimulus=first, response=ends[-1], items=InSequence(segments) if len(segments) > 1 else None
        )

    made = tuple(chain(name, path) for name, path in chains.items())
    return Events(events=tuple(events.values()), chains=made)
