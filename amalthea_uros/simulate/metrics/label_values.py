"""Which values are read from labels, and how old they are.

An explicit access reads or writes at once. Under implicit communication a job reads what there was at its start, or what it has written
itself, and what it writes is there when it ends. Under LET it reads what there was at its release, and what it writes is there from the
next release on, or from its end if that is later.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import limits_of
from amalthea_uros.perf.activities import Communication
from amalthea_uros.perf.constraints import DataAgeConstraint
from amalthea_uros.perf.events import LabelChange, LabelEvent, ProcessChange
from amalthea_uros.simulate.metrics.distributions import MetricDistributions
from amalthea_uros.simulate.metrics.extremes import Extremes, LimitedQuantity
from amalthea_uros.simulate.observations import LabelObservation
from amalthea_uros.simulate.program.watches import EventSource


@dataclass(slots=True, eq=False)
class LabelValue:
    """A value of a label.

    Attributes
    ----------
    time : when it was written
    writer : the source of the access that wrote it
    activations : of the process that wrote it, up to that time
    """

    time: int
    writer: EventSource
    activations: int
    is_read: bool = False
    is_overwritten: bool = False


@dataclass(frozen=True, slots=True)
class Reading:
    """A read of a value; None if there was none yet."""

    time: int
    source: EventSource
    value: LabelValue | None
    activations: int


@dataclass(slots=True)
class _JobValues:
    """The values that the jobs of a process have taken, and what they have written but not published.

    Attributes
    ----------
    taken_at_release, taken_at_start : the labels of which the values are taken then
    released : at each activation that has not started yet: the values at that time
    at_release, at_start : those of the running job
    """

    taken_at_release: set[str] = field(default_factory=set)
    taken_at_start: set[str] = field(default_factory=set)
    activations: int = 0
    ended: int = 0
    released: deque[dict[str, LabelValue]] = field(default_factory=deque)
    at_release: dict[str, LabelValue] = field(default_factory=dict)
    at_start: dict[str, LabelValue] = field(default_factory=dict)
    implicit: dict[str, LabelValue] = field(default_factory=dict)
    logical: dict[str, LabelValue] = field(default_factory=dict)


@dataclass(slots=True)
class LabelValues:
    """The values of some labels.

    Attributes
    ----------
    sources : in the order of their numbers
    communication : of all accesses, instead of what the model states; None: as modelled, implicit by default
    reads, writes, overwritten : numbers by label; a value is overwritten if nobody has read it
    """

    labels: Sequence[str]
    sources: Sequence[EventSource]
    communication: Communication | None
    reads: dict[str, int] = field(init=False)
    writes: dict[str, int] = field(init=False)
    overwritten: dict[str, int] = field(init=False)
    _visible: dict[str, LabelValue] = field(default_factory=dict)
    _jobs: dict[str, _JobValues] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.reads, self.writes, self.overwritten = (dict.fromkeys(self.labels, 0) for _ in range(3))
        self._jobs = {source.process: _JobValues() for source in self.sources if source.process is not None}
        for source in self.sources:
            if source.process is not None and source.change is LabelChange.READ:
                job, communication = self._jobs[source.process], self._communication(source)
                taken = {Communication.IMPLICIT: job.taken_at_start, Communication.LET: job.taken_at_release}
                taken.get(communication, set()).add(source.name)

    def readings(self, times: Numbers, numbers: Numbers) -> Iterator[Reading]:
        """Take accesses, activations, starts and ends of jobs in, in the order in which they occurred; the reads among them."""
        rows = [(time, self.sources[number]) for time, number in zip(times.tolist(), numbers.tolist(), strict=True)]
        published = 0
        for index, (time, source) in enumerate(rows):
            if source.process is None:
                continue
            job = self._jobs[source.process]
            if source.kind is LabelEvent:
                if source.change is LabelChange.WRITE:
                    self._write(time, source, job)
                else:
                    yield self._read(time, source, job)
            elif source.change is ProcessChange.ACTIVATE:
                # Everything that simultaneous activations publish is there before anybody reads.
                published = self._publish(rows, max(index, published))
                self._activate(job)
            elif source.change is ProcessChange.START:
                job.at_release = job.released.popleft()
                job.at_start = self._take(job.taken_at_start)
            else:
                self._end(job)

    def _publish(self, rows: Sequence[tuple[int, EventSource]], index: int) -> int:
        """Publish what is due at the activations that follow each other at the same time from an index on; the index after them."""
        first = index
        while index < len(rows) and rows[index][0] == rows[first][0] and rows[index][1].change is ProcessChange.ACTIVATE:
            self._reveal(self._jobs[rows[index][1].process or ""].logical)
            index += 1
        return index

    def _activate(self, job: _JobValues) -> None:
        job.activations += 1
        job.released.append(self._take(job.taken_at_release))

    def _take(self, labels: Collection[str]) -> dict[str, LabelValue]:
        return {label: self._visible[label] for label in labels if label in self._visible}

    def _end(self, job: _JobValues) -> None:
        job.ended += 1
        self._reveal(job.implicit)
        if job.activations > job.ended:
            self._reveal(job.logical)

    def _communication(self, source: EventSource) -> Communication:
        return self.communication or source.communication or Communication.IMPLICIT

    def _write(self, time: int, source: EventSource, job: _JobValues) -> None:
        self.writes[source.name] += 1
        value = {source.name: LabelValue(time, source, job.activations)}
        match self._communication(source):
            case Communication.EXPLICIT:
                self._reveal(value)
            case Communication.IMPLICIT:
                self._replace(job.implicit, value)
            case Communication.LET:
                self._replace(job.logical, value)

    def _read(self, time: int, source: EventSource, job: _JobValues) -> Reading:
        self.reads[source.name] += 1
        values: Mapping[str, LabelValue] = self._visible
        match self._communication(source):
            case Communication.IMPLICIT:
                values = job.implicit if source.name in job.implicit else job.at_start
            case Communication.LET:
                values = job.at_release
        value = values.get(source.name)
        if value is not None and not value.is_read:
            value.is_read = True
            self.overwritten[source.name] -= value.is_overwritten
        writer = value.writer.process if value is not None else None
        return Reading(time, source, value, self._jobs[writer].activations if writer is not None else 0)

    def _reveal(self, values: dict[str, LabelValue]) -> None:
        """Let everybody see some values, which nobody else keeps any more."""
        self._replace(self._visible, values)
        values.clear()

    def _replace(self, values: dict[str, LabelValue], new: Mapping[str, LabelValue]) -> None:
        for label, value in new.items():
            old = values.get(label)
            if old is not None:
                old.is_overwritten = True
                self.overwritten[label] += not old.is_read
            values[label] = value


# The ages of the values that are read from labels.


@dataclass(slots=True)
class DataAges:
    """The ages of what a runnable has written to a label, at each read of another process.

    The age in cycles is the number of activations of the writing process since it wrote.

    Attributes
    ----------
    base : time units in a picosecond
    """

    constraint: DataAgeConstraint
    base: int
    times: dict[str, Extremes] = field(default_factory=dict)
    cycles: dict[str, Extremes] = field(default_factory=dict)

    def add(self, readings: Sequence[Reading]) -> None:
        """Take reads of the label in."""
        found: dict[str, list[tuple[int, int, int]]] = {}
        for reading in readings:
            value, process = reading.value, reading.source.process
            if value is not None and process is not None and self._is_limited(reading):
                age = reading.time - value.time, reading.activations - value.activations, reading.time
                found.setdefault(process, []).append(age)
        for process, ages in found.items():
            time, cycles, at = np.array(ages, np.int64).T
            self.times.setdefault(process, Extremes(self.base)).add(time, at)
            self.cycles.setdefault(process, Extremes(self.base)).add(cycles * self.base, at)

    def _is_limited(self, reading: Reading) -> bool:
        writer = reading.value.writer if reading.value is not None else None
        return writer is not None and writer.runnable == self.constraint.runnable and writer.process != reading.source.process

    def quantities(self, _end: int) -> Iterator[LimitedQuantity]:
        """What was observed."""
        missing = ObservedValues(reason=f"no other process read what {self.constraint.runnable!r} writes")
        for limit in limits_of(self.constraint):
            ages = self.times if limit.is_time else self.cycles
            for process in sorted(ages):
                here = replace(limit, object=f"{limit.object} in {process}")
                yield LimitedQuantity(here, ages[process].limited(""))
            if not ages:
                yield LimitedQuantity(limit, missing)


@dataclass(slots=True)
class LabelAges:
    """The ages of the values of a label at each read.

    Attributes
    ----------
    base : time units in a picosecond
    unwritten : number of reads of a label to which nobody had written
    """

    label: str
    base: int
    unwritten: int = 0
    _ages: MetricDistributions = field(init=False)

    def __post_init__(self) -> None:
        self._ages = MetricDistributions(size=1, base=self.base, with_histograms=(0,))

    def add(self, readings: Sequence[Reading]) -> None:
        """Take reads of the label in."""
        ages = [(each.time - each.value.time, each.time) for each in readings if each.value is not None]
        self.unwritten += len(readings) - len(ages)
        found = np.array(ages, np.int64).reshape(-1, 2)
        self._ages.add(found[:, :1].T, np.arange(len(found)) + self._ages.count, found[:, 1])

    def observation(self, values: LabelValues) -> LabelObservation:
        """What was observed."""
        return LabelObservation(
            name=self.label,
            reads=values.reads[self.label],
            writes=values.writes[self.label],
            unwritten_reads=self.unwritten,
            overwritten=values.overwritten[self.label],
            age=self._ages.observation(0),
        )
