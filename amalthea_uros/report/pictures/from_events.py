"""Gantt charts and state timelines from events, also from a part of a trace that begins or ends amid jobs."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from itertools import takewhile
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.chain_paths import ChainStep, DrawnPath
from amalthea_uros.report.pictures.jobs import ON_CORE, CoreRows, Job, ProcessRow, RunnableSpan, State, StateSpan
from amalthea_uros.trace.table import Entity, EntityKind, EventKind, EventTable
from amalthea_uros.trace.vocabulary import PROCESS
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from numpy.typing import NDArray

#: The states of jobs by their words in the chart; after its end there is no job.
_STATES = {state.value: state for state in State} | {"terminated": None}
#: The state before and after each transition.
_TRANSITIONS: Mapping[int, tuple[State | None, State | None]] = {
    kind: (_STATES[next(iter(before))], _STATES[after]) for kind, (before, after) in PROCESS.items() if after not in before
}
#: Those that tell where a job runs.
_ALLOCATIONS = (EventKind.START, EventKind.RESUME, EventKind.RUN, EventKind.POLL_PARKING)
#: The core of processes of which no event tells one.
UNKNOWN_CORE = "unknown core"

#: The index of a process or runnable, and the number of its instance.
_Key: TypeAlias = tuple[int, int]


def jobs_of(
    table: EventTable,
    start: Time | None = None,
    end: Time | None = None,
    deadlines: Mapping[str, Time] | None = None,
    cores: Mapping[str, str] | None = None,
) -> tuple[CoreRows, ...]:
    """The jobs of a window, by the core on which each process is seen first.

    What was before the first event of a job follows from the state chart; a job that has not ended stays in its state.

    Parameters
    ----------
    start, end : of the window; None: the first, the last event
    deadlines : process -> its deadline, relative to the activation
    cores : process -> the core on which it runs, for those of which no event tells it
    """
    if not len(table):
        return ()
    first, last = int(table.time[0]), int(table.time[-1])
    reader = _JobReader(table.entities, first if start is None else min(start, first), cores or {})
    reader.read(table, first if start is None else start, last if end is None else end)
    return reader.rows(last if end is None else end, deadlines or {})


def chain_path(table: EventTable, chain: str, instance: int) -> DrawnPath:
    """The way of an occurrence of a chain's stimulus: where its effect passes each step first.

    Raises
    ------
    InvalidArgumentError : there are no events of it.
    """
    chains = [index for index, entity in enumerate(table.entities) if entity.kind is EntityKind.CHAIN and entity.name == chain]
    is_step = (table.kind == EventKind.CHAIN_STEP) & np.isin(table.target, chains) & (table.target_instance == instance)
    steps: list[ChainStep] = []
    for row in np.flatnonzero(is_step).tolist():
        if table.note[row] == len(steps):
            steps.append(ChainStep(table.entities[table.source[row]].name, int(table.time[row])))
    if not steps:
        raise InvalidArgumentError(f"the trace has no first step of occurrence {instance} of the chain {chain!r}")
    return DrawnPath(chain, tuple(steps))


@dataclass(slots=True)
class _OpenJob:
    """A job while its events are read; `since` is when its state began."""

    since: Time
    state: State | None = None
    core: str = ""
    activation: Time | None = None
    end: Time | None = None
    spans: list[StateSpan] = field(default_factory=list)
    runnables: list[RunnableSpan] = field(default_factory=list)

    def change(self, kind: int, time: Time, core: str) -> None:
        before, after = _TRANSITIONS[kind]
        self._leave(self.state or before, time, core)
        self.since, self.state, self.core = time, after, core
        if kind == EventKind.ACTIVATE:
            self.activation = time
        elif kind == EventKind.TERMINATE:
            self.end = time

    def closed(self, instance: int, now: Time, deadline: Time | None) -> Job:
        """As it is now; the deadline is relative."""
        self._leave(self.state, now, "")
        due = None if self.activation is None or deadline is None else self.activation + deadline
        calls = sorted(self.runnables, key=lambda runnable: (runnable.start, -runnable.end))
        pieces = tuple(piece for runnable in calls for piece in _executed(runnable, self.spans))
        return Job(instance, tuple(self.spans), self.activation, self.end, due, pieces)

    def _leave(self, state: State | None, time: Time, core: str) -> None:
        if state is not None:
            self.spans.append(StateSpan(state, self.since, time, (self.core or core) if state in ON_CORE else ""))


def _executed(runnable: RunnableSpan, spans: Sequence[StateSpan]) -> Iterator[RunnableSpan]:
    """The parts of a runnable in which its job holds a core."""
    first = bisect_left(spans, runnable.start, key=lambda span: span.end)
    for span in takewhile(lambda span: span.start <= runnable.end, spans[first:]):
        start, end = max(runnable.start, span.start), min(runnable.end, span.end)
        if span.state in ON_CORE and start < end:
            yield RunnableSpan(runnable.name, start, end)


@dataclass(slots=True)
class _JobReader:
    """What is known after some events.

    Attributes
    ----------
    begin : since when jobs have been in the states that their first events tell
    homes : process -> the core on which it is seen first
    calls : runnable that runs -> its start, and its job
    stated : process -> core, by their names
    """

    entities: Sequence[Entity]
    begin: Time
    stated: Mapping[str, str]
    jobs: dict[_Key, _OpenJob] = field(default_factory=dict)
    homes: dict[int, int] = field(default_factory=dict)
    lost: dict[int, list[Time]] = field(default_factory=dict)
    calls: dict[_Key, tuple[Time, _Key]] = field(default_factory=dict)

    def read(self, table: EventTable, start: Time, end: Time) -> None:
        """Take the events that matter in a window, also those of its jobs before it."""
        selected = _selected(table, start, end)
        columns = (table.time, table.kind, table.source, table.source_instance, table.target, table.target_instance)
        for time, kind, source, source_instance, target, target_instance in zip(
            *(column[selected].tolist() for column in columns), strict=True
        ):
            if kind in _TRANSITIONS:
                self._transition(time, kind, source, (target, target_instance))
            elif kind == EventKind.ACTIVATION_LOST:
                self.lost.setdefault(target, []).append(time)
            elif kind == EventKind.RUNNABLE_START:
                self.calls[target, target_instance] = time, (source, source_instance)
            else:
                began, job = self.calls.pop((target, target_instance), (self.begin, (source, source_instance)))
                self._called(job, target, began, time)

    def _transition(self, time: Time, kind: int, source: int, key: _Key) -> None:
        is_core = self.entities[source].kind is EntityKind.CORE
        if is_core and kind in _ALLOCATIONS:
            self.homes.setdefault(key[0], source)
        self._job(key).change(kind, time, self.entities[source].name if is_core else "")

    def _job(self, key: _Key) -> _OpenJob:
        return self.jobs.setdefault(key, _OpenJob(self.begin))

    def _called(self, job: _Key, runnable: int, start: Time, end: Time) -> None:
        self._job(job).runnables.append(RunnableSpan(self.entities[runnable].name, start, end))

    def rows(self, now: Time, deadlines: Mapping[str, Time]) -> tuple[CoreRows, ...]:
        """Cores and processes in the order of the entities, those without a core last."""
        for (runnable, _), (start, caller) in self.calls.items():
            self._called(caller, runnable, start, now)
        jobs: dict[int, list[Job]] = {process: [] for process in self.lost}
        for (process, instance), opened in sorted(self.jobs.items(), key=lambda item: item[0]):
            deadline = deadlines.get(self.entities[process].name)
            jobs.setdefault(process, []).append(opened.closed(instance, now, deadline))
        cores: dict[int, list[ProcessRow]] = {}
        for process, ended in sorted(jobs.items()):
            row = ProcessRow(self.entities[process].name, tuple(ended), tuple(self.lost.get(process, ())))
            cores.setdefault(self._home(process), []).append(row)
        return tuple(CoreRows(self._core_name(core), tuple(rows)) for core, rows in sorted(cores.items()))

    def _home(self, process: int) -> int:
        if process in self.homes:
            return self.homes[process]
        stated = Entity(EntityKind.CORE, self.stated.get(self.entities[process].name, ""))
        return self.entities.index(stated) if stated in self.entities else len(self.entities)

    def _core_name(self, core: int) -> str:
        return self.entities[core].name if core < len(self.entities) else UNKNOWN_CORE


def _selected(table: EventTable, start: Time, end: Time) -> NDArray[np.intp]:
    """The events of jobs up to the end of a window, without jobs that end before it."""
    is_call = np.isin(table.kind, (EventKind.RUNNABLE_START, EventKind.RUNNABLE_TERMINATE))
    is_lost = table.kind == EventKind.ACTIVATION_LOST
    is_seen = (is_call | is_lost | np.isin(table.kind, list(_TRANSITIONS))) & (table.time <= end)
    process = np.where(is_call, table.source, table.target).astype(np.int64)
    instance = np.where(is_call, table.source_instance, table.target_instance)
    job = process * (int(instance.max()) + 1) + instance
    ended = job[(table.kind == EventKind.TERMINATE) & (table.time < start)]
    return np.flatnonzero(is_seen & ~np.isin(job, ended) & ~(is_lost & (table.time < start)))
