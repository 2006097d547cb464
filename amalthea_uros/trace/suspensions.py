"""Suspensions of runnables: a simulation records when runnables start and terminate; that they pause with their process follows."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from amalthea_uros.trace.insertion import Inserted, insert
from amalthea_uros.trace.table import EventKind, EventTable
from amalthea_uros.trace.vocabulary import ENTERING, LEAVING

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
