"""Events of BTF that follow from those that a simulation records: states of semaphores, suspensions of runnables."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from amalthea_uros._internal.records import dataclass
from amalthea_uros.trace.table import NO_NOTE, EventKind, EventTable
from amalthea_uros.trace.vocabulary import ENTERING, LEAVING


class Inserted(NamedTuple):
    """An event between those of a table.

    Attributes
    ----------
    before : the row of the table before which it belongs
    like : the row that occurs at the same time
    """

    before: int
    like: int
    kind: EventKind
    source: int
    source_instance: int
    target: int
    target_instance: int


def insert(table: EventTable, events: Sequence[Inserted]) -> EventTable:
    """A table with more events; those before the same row stay in their order."""
    if not events:
        return table
    before, like, *columns = np.array(events).T
    values = (table.time[like], *columns, np.full(len(events), NO_NOTE))
    pairs = zip(table.to_dict().values(), values, strict=True)
    return EventTable(table.entities, *(np.insert(column, before, value) for column, value in pairs))


# States of semaphores: a simulation records how much of them is in use; the events of BTF follow from it.

#: In a recorded table, the kind of a row about a change of a semaphore, which is both source and target. The instances are how much of
#: it was in use before and is now; the note is 2 if somebody waited for it before, plus 1 if somebody does now. A change comes before
#: somebody gets the semaphore or has to wait, and after somebody has released it.
CHANGE = -1

_FREE, _USED, _FULL, _OVERFULL = range(4)
#: The events from one state to the next (BTF 2.3.0, section 2.3.7). A spinlock has no state OVERFULL (section 2.3.8): two events
#: say that the next process gets it.
_EVENTS: Mapping[tuple[int, int], tuple[EventKind, ...]] = {
    (_FREE, _USED): (EventKind.USED,),
    (_FREE, _FULL): (EventKind.LOCK,),
    (_USED, _FREE): (EventKind.FREE,),
    (_USED, _USED): (EventKind.USED,),
    (_USED, _FULL): (EventKind.LOCK_USED,),
    (_USED, _OVERFULL): (EventKind.LOCK_USED, EventKind.OVERFULL),
    (_FULL, _FREE): (EventKind.UNLOCK,),
    (_FULL, _USED): (EventKind.UNLOCK_FULL,),
    (_FULL, _FULL): (EventKind.UNLOCK, EventKind.LOCK),
    (_FULL, _OVERFULL): (EventKind.OVERFULL,),
    (_OVERFULL, _USED): (EventKind.FULL, EventKind.UNLOCK_FULL),
    (_OVERFULL, _FULL): (EventKind.FULL,),
    (_OVERFULL, _OVERFULL): (EventKind.OVERFULL,),
}


@dataclass(frozen=True, slots=True)
class SemaphoreStates:
    """Gives tables of a trace the events that BTF wants of semaphores.

    Attributes
    ----------
    users : for the index of each semaphore: how many may have it at the same time
    spinlocks : the indices of those of which BTF knows fewer events: nobody is said to be queued or waiting
    """

    users: Mapping[int, int]
    spinlocks: Collection[int] = ()

    def complete(self, table: EventTable) -> EventTable:
        """A recorded table with these events instead of the changes."""
        missing = [*self._queued(table), *self._states(table)]
        completed = insert(table, sorted(missing, key=lambda event: event.before))
        is_left_out = (completed.kind == EventKind.WAITING) & np.isin(completed.target, list(self.spinlocks))
        return completed.where((completed.kind != CHANGE) & ~is_left_out)

    def _states(self, table: EventTable) -> Iterator[Inserted]:
        has_queue = ~np.isin(table.target, list(self.spinlocks))
        is_wait = np.append(table.kind[1:] == EventKind.WAITING, False)
        rows = np.flatnonzero((table.kind == CHANGE) & (has_queue | ~is_wait))
        columns = (table.target, table.source_instance, table.target_instance, table.note, has_queue)
        for row, semaphore, before, after, waiting, is_queue in zip(
            rows.tolist(), *(column[rows].tolist() for column in columns), strict=True
        ):
            users = self.users[semaphore]
            states = _state(before, users, is_queue and waiting >= 2), _state(after, users, is_queue and waiting % 2 > 0)
            for kind in _EVENTS[states]:
                yield Inserted(row, row, kind, semaphore, 0, semaphore, 0)

    def _queued(self, table: EventTable) -> Iterator[Inserted]:
        rows = np.flatnonzero((table.kind == EventKind.REQUEST_SEMAPHORE) & ~np.isin(table.target, list(self.spinlocks)))
        columns = (rows, *(column[rows] for column in (table.source, table.source_instance, table.target)))
        for row, process, job, semaphore in zip(*(column.tolist() for column in columns), strict=True):
            yield Inserted(row + 1, row, EventKind.QUEUED, process, job, semaphore, 0)


def _state(used: int, users: int, is_wanted: bool) -> int:
    """The state of a semaphore; nobody is said to be waiting as long as it is not full, as for a writer among readers."""
    if used < users:
        return _USED if used else _FREE
    return _OVERFULL if is_wanted else _FULL


# Suspensions of runnables: a simulation records when runnables start and terminate; that they pause with their process follows.

_SUSPENDING = LEAVING - {EventKind.TERMINATE}
_RELEVANT = np.array(sorted({*ENTERING, *_SUSPENDING, EventKind.RUNNABLE_START, EventKind.RUNNABLE_TERMINATE}))


class RunnableSuspensions:
    """Gives consecutive tables of a trace the events of runnables that pause and go on together with their process.

    The order at equal times is that of BTF 2.3.0, section 2.3.3: runnables are suspended before the process leaves the core, the inner
    one first, and resumed after it is on a core again, the outer one first.
    """

    def __init__(self) -> None:
        #: Of each job, by process and instance: the runnables in execution and their instances, the outer one first.
        self._executing: dict[tuple[int, int], list[tuple[int, int]]] = {}

    def insert(self, table: EventTable) -> EventTable:
        """A table with the events that belong between its own."""
        return insert(table, list(self._missing(table)))

    def _missing(self, table: EventTable) -> Iterator[Inserted]:
        numbers = np.flatnonzero(np.isin(table.kind, _RELEVANT))
        columns = (table.kind, table.source, table.source_instance, table.target, table.target_instance)
        for row, kind, source, source_instance, target, instance in zip(
            numbers.tolist(), *(column[numbers].tolist() for column in columns), strict=True
        ):
            if kind == EventKind.RUNNABLE_START:
                self._executing.setdefault((source, source_instance), []).append((target, instance))
            elif kind == EventKind.RUNNABLE_TERMINATE:
                self._end(source, source_instance, (target, instance))
            elif kind in _SUSPENDING:
                for runnable in reversed(self._executing.get((target, instance), [])):
                    yield Inserted(row, row, EventKind.RUNNABLE_SUSPEND, target, instance, *runnable)
            else:
                for runnable in self._executing.get((target, instance), []):
                    yield Inserted(row + 1, row, EventKind.RUNNABLE_RESUME, target, instance, *runnable)

    def _end(self, process: int, job: int, runnable: tuple[int, int]) -> None:
        executing = self._executing.get((process, job), [])
        if runnable in executing:
            executing.remove(runnable)
            if not executing:
                del self._executing[process, job]
