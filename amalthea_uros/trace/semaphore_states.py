"""States of semaphores: a simulation records what processes request, get and release; the states of BTF follow from it."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np

from amalthea_uros.trace.insertion import Inserted, insert
from amalthea_uros.trace.table import EventKind, EventTable

#: The event of a semaphore that is assigned once more, by: was it free, is it full now (BTF 2.3.0, section 2.3.7).
_ASSIGNED = {
    (True, True): EventKind.LOCK,
    (True, False): EventKind.USED,
    (False, True): EventKind.LOCK_USED,
    (False, False): EventKind.USED,
}
#: The event of a semaphore that is assigned once less, by: was it full, is it free now.
_RELEASED = {
    (True, True): EventKind.UNLOCK,
    (True, False): EventKind.UNLOCK_FULL,
    (False, True): EventKind.FREE,
    (False, False): EventKind.USED,
}
_RECORDED_STATES = np.array([EventKind.LOCK, EventKind.UNLOCK])
_ACCESSES = np.array([EventKind.REQUEST_SEMAPHORE, EventKind.ASSIGNED, EventKind.WAITING, EventKind.RELEASED])


@dataclass(slots=True)
class _Semaphore:
    """How often a semaphore is assigned, and who waits for it.

    Attributes
    ----------
    assigned : processes that have it; one that is released while somebody waits goes to the next one
    handed_over : so many of those who wait are about to get it
    """

    users: int
    assigned: int = 0
    handed_over: int = 0
    waiting: set[tuple[int, int]] = field(default_factory=set)

    def assign(self, job: tuple[int, int]) -> EventKind | None:
        """The event before it is assigned; None if the release before was it."""
        if job in self.waiting:
            self.waiting.remove(job)
            self.handed_over -= 1
            return None
        self.assigned += 1
        return _ASSIGNED[self.assigned == 1, self.assigned >= self.users]

    def wait(self, job: tuple[int, int]) -> EventKind | None:
        """The event before somebody waits."""
        self.waiting.add(job)
        return EventKind.OVERFULL

    def release(self) -> EventKind:
        """The event after it is released."""
        waiting = len(self.waiting) - self.handed_over
        if waiting > 0:
            self.handed_over += 1
            return EventKind.FULL if waiting == 1 else EventKind.OVERFULL
        self.assigned -= 1
        return _RELEASED[self.assigned + 1 >= self.users, self.assigned <= 0]


class SemaphoreStates:
    """Gives consecutive tables of a trace the events that BTF wants of semaphores; at the begin they are all free.

    Parameters
    ----------
    users : for the index of each semaphore that is no spinlock: how many may have it at the same time
    spinlocks : the indices of others, of which BTF knows fewer events: nobody is said to be waiting
    """

    def __init__(self, users: Mapping[int, int], spinlocks: Collection[int] = ()) -> None:
        self._semaphores = {semaphore: _Semaphore(number) for semaphore, number in users.items()}
        self._spinlocks = np.array(list(spinlocks), np.int32)

    def insert(self, table: EventTable) -> EventTable:
        """A table with the events that belong between its own, without the states that they replace."""
        is_replaced = np.isin(table.kind, _RECORDED_STATES) & np.isin(table.target, list(self._semaphores))
        is_left_out = (table.kind == EventKind.WAITING) & np.isin(table.target, self._spinlocks)
        rest = table.where(~(is_replaced | is_left_out))
        return insert(rest, list(self._missing(rest)))

    def _missing(self, table: EventTable) -> Iterator[Inserted]:
        rows = np.flatnonzero(np.isin(table.kind, _ACCESSES) & np.isin(table.target, list(self._semaphores)))
        columns = (rows, *(column[rows] for column in (table.kind, table.source, table.source_instance, table.target)))
        for row, kind, process, job, target in zip(*(column.tolist() for column in columns), strict=True):
            semaphore = self._semaphores[target]
            if kind == EventKind.REQUEST_SEMAPHORE:
                yield Inserted(row + 1, row, EventKind.QUEUED, process, job, target, 0)
            elif kind == EventKind.RELEASED:
                yield Inserted(row + 1, row, semaphore.release(), target, 0, target, 0)
            else:
                decide = semaphore.wait if kind == EventKind.WAITING else semaphore.assign
                event = decide((process, job))
                if event is not None:
                    yield Inserted(row, row, event, target, 0, target, 0)
