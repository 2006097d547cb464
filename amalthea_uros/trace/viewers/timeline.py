"""The picture of a trace, independent of the format: slices and marks on tracks, one for each core, task and ISR.

The track of a core shows which process executes there. That of a process shows the state of its oldest job that has not ended, and in
the states on a core the runnables that the job is in. The slices of a track are nested, which the viewers rely on.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Sequence
from enum import IntEnum
from typing import NamedTuple

from amalthea_uros.trace.sinks import Encoder
from amalthea_uros.trace.table import Entity, EntityKind, EventKind, EventTable
from amalthea_uros.trace.vocabulary import ENTERING, LEAVING, ON_CORE, PROCESS


class TrackChange(IntEnum):
    """What happens on a track; the numbers are those of Perfetto's event types."""

    BEGIN = 1
    END = 2
    STEP = 3


#: The number of a flow contains that of the chain above these bits, and that of the occurrence in them.
_OCCURRENCE_BITS = 40


class TrackMark(NamedTuple):
    """Something that happens on a track.

    Attributes
    ----------
    time : picoseconds
    track : index of the core or process
    change : the begin of a slice, the end of the innermost open one, or a step of a chain
    state : of a slice that shows a state of a process, else ""
    entity : of other slices: the index of the process or runnable that it shows; of a step: that of the chain
    flow : of a step: a number that it shares with the steps of the same occurrence of the chain's stimulus, else 0
    step : of a step: its number in the chain
    """

    time: int
    track: int
    change: TrackChange
    state: str = ""
    entity: int = 0
    flow: int = 0
    step: int = 0


#: The states after the transitions of processes; what a terminated one does is not shown.
_STATES = {int(kind): after for kind, (_, after) in PROCESS.items() if after != "terminated"}
#: The names of all states that are shown.
SHOWN_STATES = tuple(dict.fromkeys(_STATES.values()))


class _ShownJob:
    """A job that has not ended: its state, and the runnables that it is in, the outer one first."""

    __slots__ = ("runnables", "state")

    def __init__(self) -> None:
        self.state = ""
        self.runnables: list[int] = []


class Timeline:
    """Makes the marks for consecutive tables of a trace."""

    def __init__(self) -> None:
        self._jobs: dict[int, dict[int, _ShownJob]] = {}
        self._depths: dict[int, int] = {}
        self._executing: dict[int, int] = {}
        self._last = 0
        self._marks: list[TrackMark] = []

    def marks(self, table: EventTable) -> list[TrackMark]:
        """What some events change; the marks of a track are in order."""
        columns = [column.tolist() for column in table.to_dict().values()]
        for time, kind, source, source_instance, target, instance, note in zip(*columns, strict=True):
            self._last = time
            if kind in _STATES or kind == EventKind.TERMINATE:
                if kind in LEAVING:
                    self._leave_core(time, source, target)
                self._change_state(time, kind, target, instance)
                if kind in ENTERING:
                    self._enter_core(time, source, target)
            elif kind == EventKind.RUNNABLE_START:
                self._start_runnable(time, source, source_instance, target)
            elif kind == EventKind.RUNNABLE_TERMINATE:
                self._end_runnable(time, source, source_instance, target)
            elif kind == EventKind.GAP:
                self._end_all(time)
            elif kind == EventKind.CHAIN_STEP:
                self._marks.append(TrackMark(time, source, TrackChange.STEP, "", target, _flow(target, instance), note))
        return self._taken()

    def finish(self) -> list[TrackMark]:
        """The ends of the slices that are still open after the last event."""
        self._end_all(self._last)
        return self._taken()

    def _end_all(self, time: int) -> None:
        """End all slices; how the jobs go on is not known."""
        for track in self._executing:
            self._marks.append(TrackMark(time, track, TrackChange.END))
        for process in list(self._depths):
            self._hide(time, process)
        self._executing.clear()
        self._jobs.clear()

    def _taken(self) -> list[TrackMark]:
        """The marks that have been made, which are no longer kept."""
        marks, self._marks = self._marks, []
        return marks

    def _enter_core(self, time: int, core: int, process: int) -> None:
        if core in self._executing:
            self._marks.append(TrackMark(time, core, TrackChange.END))
        self._executing[core] = process
        self._marks.append(TrackMark(time, core, TrackChange.BEGIN, entity=process))

    def _leave_core(self, time: int, core: int, process: int) -> None:
        if self._executing.get(core) == process:
            del self._executing[core]
            self._marks.append(TrackMark(time, core, TrackChange.END))

    def _change_state(self, time: int, kind: int, process: int, instance: int) -> None:
        jobs = self._jobs.setdefault(process, {})
        job = jobs.setdefault(instance, _ShownJob())
        is_shown = next(iter(jobs)) == instance
        if is_shown:
            self._hide(time, process)
        if kind == EventKind.TERMINATE:
            del jobs[instance]
        else:
            job.state = _STATES[kind]
        if is_shown and jobs:
            self._show(time, process, next(iter(jobs.values())))

    def _start_runnable(self, time: int, process: int, instance: int, runnable: int) -> None:
        job = self._jobs.get(process, {}).get(instance)
        if job is not None:
            job.runnables.append(runnable)
            if self._is_visible(process, job):
                self._depths[process] += 1
                self._marks.append(TrackMark(time, process, TrackChange.BEGIN, entity=runnable))

    def _end_runnable(self, time: int, process: int, instance: int, runnable: int) -> None:
        job = self._jobs.get(process, {}).get(instance)
        if job is not None and job.runnables and job.runnables[-1] == runnable:
            job.runnables.pop()
            if self._is_visible(process, job):
                self._depths[process] -= 1
                self._marks.append(TrackMark(time, process, TrackChange.END))

    def _is_visible(self, process: int, job: _ShownJob) -> bool:
        """Whether the runnables of a job are on the track of its process."""
        return job.state in ON_CORE and next(iter(self._jobs[process].values())) is job

    def _show(self, time: int, process: int, job: _ShownJob) -> None:
        runnables = job.runnables if job.state in ON_CORE else []
        self._depths[process] = 1 + len(runnables)
        self._marks.append(TrackMark(time, process, TrackChange.BEGIN, job.state))
        for runnable in runnables:
            self._marks.append(TrackMark(time, process, TrackChange.BEGIN, entity=runnable))

    def _hide(self, time: int, process: int) -> None:
        for _ in range(self._depths.pop(process, 0)):
            self._marks.append(TrackMark(time, process, TrackChange.END))


def _flow(chain: int, occurrence: int) -> int:
    return (chain + 1 << _OCCURRENCE_BITS) + occurrence % (1 << _OCCURRENCE_BITS)


#: The groups of tracks, by numbers that formats use for them.
CORES, PROCESSES = 1, 2
GROUPS = {CORES: "Cores", PROCESSES: "Tasks and ISRs"}
#: Tracks and names of entities have numbers from here on; before them are the groups, and what formats need.
FIRST_TRACK = 16


class TimelineEncoder(Encoder):
    """Makes the bytes of a format that shows slices and marks on tracks."""

    def __init__(self, entities: Sequence[Entity]) -> None:
        super().__init__(entities)
        self._timeline = Timeline()

    def encode(self, table: EventTable) -> bytes:
        """What some events change."""
        return self._encoded(self._timeline.marks(table))

    def end(self) -> bytes:
        """The slices that are still open, and the end of the file."""
        return self._encoded(self._timeline.finish())

    @abstractmethod
    def _encoded(self, marks: Iterable[TrackMark]) -> bytes:
        """The bytes of some marks."""

    def _group(self, track: int) -> int:
        return CORES if self._entities[track].kind is EntityKind.CORE else PROCESSES
