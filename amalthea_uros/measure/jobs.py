"""Jobs and executions of runnables from the events of a trace, by the state chart of BTF.

A job counts if the trace has all of it: its start, each change of its state, and its end. Jobs at the edges of the trace and at gaps
do not. The times follow from when a job was activated, started and ended, and how long it was in which state, as in the simulation.
"""

from __future__ import annotations

from bisect import bisect_left, insort
from collections.abc import Iterator

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.measure.begins import ACTIVATION, END_OF_WAIT, FROM_ACTIVATION, ModelBegins
from amalthea_uros.measure.series import Counts, MeasuredKind, Series, statistics_of
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.observed.job_times import BETWEEN, OWN, JobColumn, own_times, times_between
from amalthea_uros.trace.table import EventKind, EventTable
from amalthea_uros.trace.vocabulary import PROCESS

#: What the states of a job count as; in READY no time is counted.
_COLUMNS = {
    "running": JobColumn.RUNNING,
    "waiting": JobColumn.WAITING,
    "polling": JobColumn.POLLING,
    "parking": JobColumn.PARKING,
}
_STATES = {int(kind): (before, after) for kind, (before, after) in PROCESS.items()}
_UNACTIVATED = -1
_EVERYWHERE: Flags | slice = slice(None)


class _RunningJob:
    """A job that has not ended.

    Attributes
    ----------
    state : since `since`
    times : in the states of `_COLUMNS`, up to `since`
    runnables : those in execution: number, instance, start, `times` at the start
    is_process : whether it has events of its own; of other jobs only runnables are known
    is_before : whether it began before a wait for what it executes, and has not executed anything
    """

    __slots__ = ("activation", "is_before", "is_process", "runnables", "since", "start", "state", "times")

    def __init__(self, state: str, since: int, is_process: bool = True) -> None:
        self.state, self.since, self.is_process = state, since, is_process
        self.activation = self.start = _UNACTIVATED
        self.times = dict.fromkeys(_COLUMNS, 0)
        self.runnables: list[tuple[int, int, int, dict[str, int]]] = []
        self.is_before = False

    def enter(self, state: str, time: int) -> None:
        """Change the state."""
        if self.state in self.times:
            self.times[self.state] += time - self.since
        self.state, self.since = state, time

    def wait_before(self, time: int, kind: int) -> None:
        """Begin when the wait is over that is before what the job executes, if this is an event of that wait."""
        self.is_before = self.is_before and not (self.times["running"] or self.runnables)
        if self.is_before and kind in (EventKind.START, EventKind.RELEASE):
            self.activation = time
        if self.is_before and kind in (EventKind.START, EventKind.RESUME):
            self.start = time
            self.times = dict.fromkeys(_COLUMNS, 0)


@dataclass(slots=True)
class _EndedJobs:
    """The jobs of a process, or the executions of a runnable, that are complete.

    Attributes
    ----------
    rows : start, end, activation, times in states, whether nothing is missing between it and the one before
    lost_activations : number of activations that became no job
    without_job : the numbers of these, in ascending order, unless a later activation has it again
    """

    rows: list[tuple[int, ...]] = field(default_factory=list)
    segment: int = -1
    last: int | None = None
    incomplete: int = 0
    lost: int = 0
    lost_activations: int = 0
    without_job: list[int] = field(default_factory=list)

    def add(
        self, job: int, segment: int, activation: int, start: int, end: int, times: dict[str, int], is_numbered: bool
    ) -> None:
        """Add one that has ended."""
        place = bisect_left(self.without_job, job)
        if self.without_job[place : place + 1] == [job]:
            del self.without_job[place]
        number = job - place
        is_next = segment == self.segment and (not is_numbered or self.last is None or number == self.last + 1)
        self.rows.append((job, activation, start, end, *times.values(), is_next))
        self.segment, self.last = segment, number

    def lose(self, activation: int) -> None:
        """Add an activation that became no job."""
        self.lost_activations += 1
        insort(self.without_job, activation)


@dataclass(slots=True)
class JobFollower:
    """Follows the jobs of a trace, table by table.

    Attributes
    ----------
    gaps : number of gaps in the trace
    illegal : number of events that the state of their job does not allow; the job is dropped
    begins : what the model says of when jobs begin
    """

    gaps: int = 0
    illegal: int = 0
    begins: ModelBegins = field(default_factory=ModelBegins)
    _open: dict[tuple[int, int], _RunningJob] = field(default_factory=dict)
    _processes: dict[int, _EndedJobs] = field(default_factory=dict)
    _runnables: dict[tuple[int, int], _EndedJobs] = field(default_factory=dict)
    #: What activates iterations at the begin of a wait.
    _waits: frozenset[int] = frozenset()
    #: The greatest number of a job of each process so far.
    _newest: dict[int, int] = field(default_factory=dict)

    def add(self, table: EventTable) -> None:
        """Take events in."""
        if self.begins.iterations:
            known = frozenset(self.begins.iterations.values())
            self._waits = frozenset(number for number, each in enumerate(table.entities) if each.name in known)
        columns = (table.time, table.kind, table.source, table.source_instance, table.target, table.target_instance)
        for time, kind, source, source_instance, target, instance in zip(*(each.tolist() for each in columns), strict=True):
            if kind in _STATES:
                self._change(time, kind, target, instance)
                if source in self._waits and kind == EventKind.ACTIVATE and (target, instance) in self._open:
                    self._open[target, instance].is_before = True
            elif EventKind.RUNNABLE_START <= kind <= EventKind.RUNNABLE_TERMINATE:
                self._execute(time, kind, source, source_instance, target, instance)
            elif kind == EventKind.GAP:
                self.gaps += 1
                self.finish()

    def finish(self) -> None:
        """Drop the jobs that have not ended, as at a gap or at the end of the trace."""
        for key in list(self._open):
            self._drop(key)

    # Jobs.

    def _change(self, time: int, kind: int, process: int, instance: int) -> None:
        key, (before, after) = (process, instance), _STATES[kind]
        if kind == EventKind.ACTIVATION_LOST:
            self._number(key)
            self._of(process).lose(instance)
            return
        job = self._open.get(key)
        if job is None or not job.is_process:
            if not self._begin(time, kind, key):
                return
        elif job.state not in before:
            self.illegal += 1
            self._drop(key)
            self._begin(time, kind, key)
        elif kind == EventKind.TERMINATE:
            self._end(time, key, job)
        else:
            if kind == EventKind.START:
                job.start = time
            job.enter(after, time)
            if job.is_before:
                job.wait_before(time, kind)

    def _begin(self, time: int, kind: int, key: tuple[int, int]) -> bool:
        """Whether an event begins a job that can be followed; of others the start is not in the trace."""
        if kind not in (EventKind.ACTIVATE, EventKind.START):
            if kind == EventKind.TERMINATE:
                self._of(key[0]).incomplete += 1
            return False
        self._number(key)
        job = self._open[key] = _RunningJob(_STATES[kind][1], time)
        if kind == EventKind.ACTIVATE:
            job.activation = time
        else:
            job.start = time
        return True

    def _number(self, key: tuple[int, int]) -> None:
        """Count the numbers of jobs that are missing before this one."""
        process, instance = key
        newest = self._newest.get(process)
        if newest is not None and instance > newest + 1:
            self._of(process).lost += instance - newest - 1
            self._interrupt(process)
        self._newest[process] = instance if newest is None else max(newest, instance)

    def _interrupt(self, process: int) -> None:
        """Note that executions of the runnables of a process are missing: the next ones do not follow the last ones."""
        for (of, _), ended in self._runnables.items():
            if of == process:
                ended.segment = -1

    def _end(self, time: int, key: tuple[int, int], job: _RunningJob) -> None:
        del self._open[key]
        job.enter("terminated", time)
        for runnable, *_ in job.runnables:
            self._of_runnable(key[0], runnable).incomplete += 1
        self._of(key[0]).add(key[1], self.gaps, job.activation, job.start, time, job.times, is_numbered=True)

    def _drop(self, key: tuple[int, int]) -> None:
        job = self._open.pop(key)
        if job.is_process:
            self._of(key[0]).incomplete += 1
        self._interrupt(key[0])
        for runnable, *_ in job.runnables:
            self._of_runnable(key[0], runnable).incomplete += 1

    # Runnables.

    def _execute(self, time: int, kind: int, process: int, job_number: int, runnable: int, instance: int) -> None:
        key = process, job_number
        job = self._open.get(key)
        if job is None:
            if kind != EventKind.RUNNABLE_START:
                if kind == EventKind.RUNNABLE_TERMINATE:
                    self._of_runnable(process, runnable).incomplete += 1
                return
            if process in self._newest:  # it has events of its own, and those of this job are missing
                self._interrupt(process)
            job = self._open[key] = _RunningJob("running", time, is_process=False)
        if kind == EventKind.RUNNABLE_START:
            job.enter(job.state, time)
            job.runnables.append((runnable, instance, time, dict(job.times)))
        elif kind == EventKind.RUNNABLE_TERMINATE:
            self._end_runnable(time, key, job, runnable, instance)
        elif not job.is_process:
            # Nothing is known of the process, so that it pauses with its runnable.
            job.enter("ready" if kind == EventKind.RUNNABLE_SUSPEND else "running", time)

    def _end_runnable(self, time: int, key: tuple[int, int], job: _RunningJob, runnable: int, instance: int) -> None:
        index = next((i for i, each in reversed(list(enumerate(job.runnables))) if each[:2] == (runnable, instance)), None)
        if index is None:
            self._of_runnable(key[0], runnable).incomplete += 1
            return
        # Inner ones of which the end is missing.
        for inner, *_ in job.runnables[index + 1 :]:
            self._of_runnable(key[0], inner).incomplete += 1
        _, _, start, before = job.runnables[index]
        del job.runnables[index:]
        job.enter(job.state, time)
        times = {state: passed - before[state] for state, passed in job.times.items()}
        ended = self._of_runnable(key[0], runnable)
        ended.add(instance, self.gaps, job.activation, start, time, times, is_numbered=False)
        if not job.is_process and not job.runnables:
            del self._open[key]

    def _of(self, process: int) -> _EndedJobs:
        return self._processes.setdefault(process, _EndedJobs())

    def _of_runnable(self, process: int, runnable: int) -> _EndedJobs:
        return self._runnables.setdefault((process, runnable), _EndedJobs())

    # Results.

    def series(self, names: list[str]) -> Iterator[Series]:
        """What was measured, by the names of the entities."""
        for process, ended in self._processes.items():
            begin = END_OF_WAIT if names[process] in self.begins.iterations else ACTIVATION
            yield from _series(MeasuredKind.PROCESS, names[process], ended, begin)
        for runnable, parts in self._by_runnable().items():
            # What a callback of an executor in a loop responds to came before its iteration.
            used = [metric for metric in JobMetric if metric not in FROM_ACTIVATION]
            is_callback = names[runnable] in self.begins.callbacks
            measured = _series(MeasuredKind.RUNNABLE, names[runnable], parts, "" if is_callback else ACTIVATION)
            yield from (each for each in measured if not is_callback or each.quantity in used)

    def _by_runnable(self) -> dict[int, _EndedJobs]:
        """The executions of each runnable in all processes, in the order of their ends."""
        found: dict[int, _EndedJobs] = {}
        for (_, runnable), ended in self._runnables.items():
            whole = found.setdefault(runnable, _EndedJobs())
            whole.rows += ended.rows
            whole.incomplete += ended.incomplete
        for whole in found.values():
            whole.rows.sort(key=lambda row: row[3])
        return found


def _series(kind: MeasuredKind, name: str, ended: _EndedJobs, begin: str) -> Iterator[Series]:
    counts = Counts(incomplete=ended.incomplete, lost=ended.lost, lost_activations=ended.lost_activations)
    if not ended.rows:
        yield Series(kind=kind, name=name, quantity=JobMetric.GROSS_EXECUTION_TIME, statistics=None, counts=counts)
        return
    jobs, follows = _table(ended)
    is_activated, is_known = jobs[JobColumn.ACTIVATION] != _UNACTIVATED, follows[1:]
    are_activated = is_activated[1:] & is_activated[:-1] & is_known
    activated, known, both_activated = _places(is_activated), _places(is_known), _places(are_activated)
    whole = zip(OWN, own_times(jobs), strict=True)
    between = zip(BETWEEN, times_between(jobs[:, :-1], jobs[:, 1:]), strict=True)
    found = [(metric, row, jobs[JobColumn.END], _EVERYWHERE, activated) for metric, row in whole]
    found += [(metric, row, jobs[JobColumn.END, 1:], known, both_activated) for metric, row in between]
    method = "from the events of jobs" if kind is MeasuredKind.PROCESS else "from the events of runnables and their jobs"
    for metric, row, ends, places, places_from_activation in found:
        used = places_from_activation if metric in FROM_ACTIVATION else places
        values = row[used]
        if len(values):
            yield Series(
                kind=kind,
                name=name,
                quantity=metric,
                statistics=statistics_of(values),
                values=values,
                times=ends[used],
                counts=counts,
                method=method,
                begin=begin,
            )


def _places(is_used: Flags) -> Flags | slice:
    """What selects some values: of all of them, no copy is needed."""
    return _EVERYWHERE if is_used.all() else is_used


def _table(ended: _EndedJobs) -> tuple[Numbers, Flags]:
    """A column for each job, a row for each of `JobColumn`; and whether each follows the one before."""
    rows = np.array(ended.rows, np.int64).T
    jobs = np.zeros((len(JobColumn), rows.shape[1]), np.int64)
    jobs[[JobColumn.INSTANCE, JobColumn.ACTIVATION, JobColumn.START, JobColumn.END, *_COLUMNS.values()]] = rows[:-1]
    return jobs, rows[-1].astype(bool)
