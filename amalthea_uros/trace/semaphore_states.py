"""States of semaphores: a simulation records how much of them is in use; the events of BTF follow from it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from amalthea_uros.trace.insertion import Inserted, insert
from amalthea_uros.trace.table import EventKind, EventTable

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
