"""Checks whether a trace obeys the state charts and the order rules of BTF 2.3.0.

At the begin of a trace, and after a loss of events, everything may be in any state. After a wrong event, the check goes on as if
it were right.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.trace.files import TraceProblems
from amalthea_uros.trace.readers import open_trace
from amalthea_uros.trace.table import Entity, EntityKind, EventKind, EventTable
from amalthea_uros.trace.vocabulary import (
    ENTERING,
    LEAVING,
    ON_CORE,
    PROCESS,
    PROCESSES,
    SOURCES,
    WORDS,
    chart,
)

#: Executions of runnables (section 2.3.3).
RUNNABLE = chart(
    {
        EventKind.RUNNABLE_START: ("terminated", "running"),
        EventKind.RUNNABLE_SUSPEND: ("running", "suspended"),
        EventKind.RUNNABLE_RESUME: ("suspended", "running"),
        EventKind.RUNNABLE_TERMINATE: ("running", "terminated"),
    }
)

#: Semaphores (section 2.3.7); those of spinlocks are a part of it (section 2.3.8).
SEMAPHORE = chart(
    {
        EventKind.USED: ("free used", "used"),
        EventKind.LOCK: ("free", "full"),
        EventKind.LOCK_USED: ("used", "full"),
        EventKind.OVERFULL: ("full overfull", "overfull"),
        EventKind.FULL: ("overfull", "full"),
        EventKind.UNLOCK_FULL: ("full", "used"),
        EventKind.FREE: ("used", "free"),
        EventKind.UNLOCK: ("full", "free"),
    }
)

#: What a job does with a semaphore: the order of the events that processes cause (section 2.3.7).
ACCESS = chart(
    {
        EventKind.REQUEST_SEMAPHORE: ("idle", "requested"),
        EventKind.INCREMENT: ("requested", "requested"),
        EventKind.QUEUED: ("requested", "queued"),
        EventKind.WAITING: ("requested queued", "waiting"),
        EventKind.ASSIGNED: ("requested queued waiting", "assigned"),
        EventKind.RELEASED: ("assigned", "idle"),
        EventKind.DECREMENT: ("idle", "idle"),
    }
)

#: What creates an instance, of which the numbers have no gaps.
_COUNTED = frozenset({EventKind.ACTIVATE, EventKind.ACTIVATION_LOST, EventKind.RUNNABLE_START, EventKind.TRIGGER})
#: What a process does also while it is polling: a runnable pauses when the process is parked.
_WHILE_POLLING = frozenset({EventKind.RUNNABLE_SUSPEND, EventKind.RUNNABLE_RESUME})
#: Decisions about a request are not made by the process whose request it is.
_BY_OTHERS = frozenset({EventKind.ASSIGNED, EventKind.WAITING, EventKind.QUEUED, EventKind.INCREMENT, EventKind.DECREMENT})
#: What a process does by executing.
_BY_EXECUTION = (
    frozenset(kind for kind, sources in SOURCES.items() if set(PROCESSES) <= set(sources))
    - PROCESS.keys()
    - SEMAPHORE.keys()
    - _BY_OTHERS
    - {EventKind.CHAIN_STEP}
)


def check_trace(path: Path) -> tuple[Finding, ...]:
    """The problems of a trace file: of the format, and of the order of events.

    Raises
    ------
    InvalidArgumentError : the format is not known.
    ReadError : the file cannot be read.
    """
    reader, charts = open_trace(path), StateCharts(path)
    for table in reader:
        charts.check(table)
    return reader.findings + charts.findings


@dataclass(slots=True)
class _ChartedJob:
    """A job of a task or ISR.

    Attributes
    ----------
    is_complete : whether its activation is in the trace
    state : None if it is not known yet
    runnables : in which it is, by runnable and instance, the outer one first, and whether they are suspended
    """

    is_complete: bool
    state: str | None = None
    core: int | None = None
    runnables: dict[tuple[int, int], str] = field(default_factory=dict)


class _Event(NamedTuple):
    time: int
    kind: EventKind
    source: int
    source_instance: int
    target: int
    target_instance: int


class StateCharts:
    """Follows the state of everything through consecutive tables of a trace.

    Parameters
    ----------
    path : of the trace, for the locations of findings
    """

    def __init__(self, path: Path | None = None) -> None:
        self._problems = TraceProblems(path)
        self._entities: Sequence[Entity] = ()
        self._last_time = 0
        self._last_instances: dict[int, int] = {}
        self._triggers: dict[int, int] = {}
        self._jobs: dict[tuple[int, int], _ChartedJob] = {}
        #: Of each process: from which job on activations are in the trace, and the job that has ended last.
        self._first_jobs: dict[int, int] = {}
        self._last_ended: dict[int, int] = {}
        self._cores: dict[int, int] = {}
        self._semaphores: dict[int, str] = {}
        self._accesses: dict[tuple[int, int, int], str] = {}

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The problems so far."""
        return self._problems.findings

    def check(self, table: EventTable) -> None:
        """Check some events."""
        self._entities = table.entities
        columns = [column.tolist() for name, column in table.to_dict().items() if name != "note"]
        for time, kind, *ends in zip(*columns, strict=True):
            self._check(_Event(time, EventKind(kind), *ends))

    def _check(self, event: _Event) -> None:
        if event.time < self._last_time:
            self._problems.add("time", Severity.ERROR, "the time is less than that of an event before")
        self._last_time = event.time
        if event.kind is EventKind.GAP:
            self._forget()
            return
        self._check_instance(event)
        self._check_source(event)
        if event.kind in PROCESS:
            self._check_process(event)
        elif event.kind in RUNNABLE:
            self._check_runnable(event)
        elif event.kind in SEMAPHORE:
            self._check_semaphore(event)
        elif event.kind in ACCESS:
            self._check_access(event)

    def _forget(self) -> None:
        """Take all states as unknown."""
        for known in (
            self._last_instances,
            self._triggers,
            self._jobs,
            self._first_jobs,
            self._last_ended,
            self._cores,
            self._semaphores,
            self._accesses,
        ):
            known.clear()

    def _check_instance(self, event: _Event) -> None:
        if event.kind in _COUNTED:
            last = self._last_instances.get(event.target)
            if last is not None and event.target_instance != last + 1:
                message = f"the instance numbers of {self._name(event.target)} are not consecutive at {WORDS[event.kind]}"
                self._problems.add("instance number", Severity.ERROR, message)
            self._last_instances[event.target] = event.target_instance

    def _check_source(self, event: _Event) -> None:
        """A stimulus has been triggered before it causes something; a process causes it while it executes."""
        if event.kind is EventKind.TRIGGER:
            self._triggers[event.target] = event.target_instance
        if event.source == event.target:
            return
        kind = self._entities[event.source].kind
        if kind is EntityKind.STIMULUS and self._triggers.get(event.source) != event.source_instance:
            message = f"{WORDS[event.kind]} by {self._name(event.source)} without a trigger of this instance before it"
            self._problems.add("trigger", Severity.ERROR, message)
        elif kind in PROCESSES and event.kind in _BY_EXECUTION:
            state = self._job(event.source, event.source_instance).state
            if state is not None and state not in (ON_CORE if event.kind in _WHILE_POLLING else ("running",)):
                message = f"{WORDS[event.kind]} by {self._name(event.source)} in state {state}, but only a running process acts"
                self._problems.add("action", Severity.ERROR, message)

    def _job(self, process: int, instance: int) -> _ChartedJob:
        """The record of a job; one of which nothing has been seen yet may be older than the trace."""
        job = self._jobs.get((process, instance))
        if job is None:
            first = self._first_jobs.get(process)
            is_complete = (first is not None and instance >= first) or self._last_ended.get(process) == instance
            job = self._jobs[process, instance] = _ChartedJob(is_complete, "terminated" if is_complete else None)
        return job

    def _check_process(self, event: _Event) -> None:
        if event.kind is EventKind.ACTIVATE:
            self._first_jobs.setdefault(event.target, event.target_instance)
        job = self._job(event.target, event.target_instance)
        before, after = PROCESS[event.kind]
        if job.state is not None and job.state not in before:
            self._report("process state", event, event.target, job.state)
        if event.kind in LEAVING:
            self._check_left(event, job)
        if event.kind in ENTERING:
            self._check_core(event, job)
        job.state = after
        if after == "terminated":
            del self._jobs[event.target, event.target_instance]
            if event.kind is EventKind.TERMINATE:
                self._last_ended[event.target] = event.target_instance
            else:
                self._first_jobs.setdefault(event.target, event.target_instance)

    def _check_left(self, event: _Event, job: _ChartedJob) -> None:
        executing = [
            runnable for runnable, state in job.runnables.items() if state == "running" or event.kind is EventKind.TERMINATE
        ]
        for runnable, _ in executing:
            message = f"{WORDS[event.kind]} of {self._name(event.target)} while it executes the runnable {self._name(runnable)}"
            self._problems.add("runnable state", Severity.ERROR, message)
        if job.core not in (None, event.source):
            message = f"{WORDS[event.kind]} of {self._name(event.target)} on another core than that on which it executes"
            self._problems.add("core", Severity.ERROR, message)
        self._cores.pop(event.source, None)
        job.core = None

    def _check_core(self, event: _Event, job: _ChartedJob) -> None:
        other = self._cores.get(event.source)
        if other is not None:
            message = f"{self._name(event.source)} executes {self._name(event.target)} and {self._name(other)} at the same time"
            self._problems.add("core", Severity.ERROR, message)
        job.core = event.source
        self._cores[event.source] = event.target

    def _check_runnable(self, event: _Event) -> None:
        job = self._job(event.source, event.source_instance)
        runnable = event.target, event.target_instance
        before, after = RUNNABLE[event.kind]
        state = job.runnables.get(runnable, "terminated" if job.is_complete or event.kind is EventKind.RUNNABLE_START else None)
        if state is not None and state not in before:
            self._report("runnable state", event, event.target, state)
        elif runnable in job.runnables and runnable != _next(job.runnables, event.kind):
            message = f"{WORDS[event.kind]} of {self._name(event.target)} out of order: runnables are nested"
            self._problems.add("runnable state", Severity.ERROR, message)
        if after == "terminated":
            job.runnables.pop(runnable, None)
        elif runnable in job.runnables or event.kind is EventKind.RUNNABLE_START:
            job.runnables[runnable] = after

    def _check_semaphore(self, event: _Event) -> None:
        before, after = SEMAPHORE[event.kind]
        state = self._semaphores.get(event.target)
        if state is not None and state not in before:
            self._report("semaphore state", event, event.target, state)
        self._semaphores[event.target] = after

    def _check_access(self, event: _Event) -> None:
        key = event.target, event.source, event.source_instance
        before, after = ACCESS[event.kind]
        unknown = "idle" if self._job(event.source, event.source_instance).is_complete else None
        state = self._accesses.pop(key, unknown)
        if state is not None and state not in before:
            self._report("semaphore state", event, event.target, state)
        elif event.kind is EventKind.ASSIGNED and self._semaphores.get(event.target) == "free":
            self._report("semaphore state", event, event.target, "free")
        if after != "idle":
            self._accesses[key] = after

    def _report(self, rule: str, event: _Event, entity: int, state: str) -> None:
        message = f"illegal transition of {self._name(entity)}: {WORDS[event.kind]} in state {state}"
        self._problems.add(rule, Severity.ERROR, message)

    def _name(self, entity: int) -> str:
        return repr(self._entities[entity].name)


def _next(runnables: dict[tuple[int, int], str], kind: EventKind) -> tuple[int, int] | None:
    """The one of nested runnables of which it is the turn: the inner one first, but the outer one first to be resumed."""
    if kind is EventKind.RUNNABLE_RESUME:
        return next((runnable for runnable, state in runnables.items() if state == "suspended"), None)
    return next((runnable for runnable, state in reversed(runnables.items()) if state == "running"), None)
