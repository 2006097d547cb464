"""Suspensions of runnables: a simulation records when runnables start and terminate; that they pause with their process follows."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from amalthea_uros.trace.table import NO_NOTE, EventKind, EventTable
from amalthea_uros.trace.vocabulary import ENTERING, LEAVING

_SUSPENDING = LEAVING - {EventKind.TERMINATE}
_RELEVANT = np.array(sorted({*ENTERING, *_SUSPENDING, EventKind.RUNNABLE_START, EventKind.RUNNABLE_TERMINATE}))


def with_suspensions(tables: Iterable[EventTable]) -> Iterator[EventTable]:
    """The tables of a trace with the events of runnables that are suspended and resumed together with their process.

    The order at equal times is that of BTF 2.3.0, section 2.3.3: runnables are suspended before the process leaves the core, the inner
    one first, and resumed after it is on a core again, the outer one first.
    """
    suspensions = RunnableSuspensions()
    return (suspensions.insert(table) for table in tables)


class RunnableSuspensions:
    """Inserts events into consecutive tables of a trace."""

    def __init__(self) -> None:
        #: Of each job, by process and instance: the runnables in execution and their instances, the outer one first.
        self._executing: dict[tuple[int, int], list[tuple[int, int]]] = {}

    def insert(self, table: EventTable) -> EventTable:
        """A table with the events that belong between its own."""
        rows = self._missing(table)
        if not rows:
            return table
        position, at, kind, process, job, runnable, instance = np.array(rows).T
        values = (table.time[at], kind, process, job, runnable, instance, np.full(len(rows), NO_NOTE))
        columns = zip(table.to_dict().values(), values, strict=True)
        return EventTable(table.entities, *(np.insert(column, position, value) for column, value in columns))

    def _missing(self, table: EventTable) -> list[tuple[int, ...]]:
        """The missing events: before which row they belong, the row of the same time, and the values of the columns."""
        rows: list[tuple[int, ...]] = []
        numbers = np.flatnonzero(np.isin(table.kind, _RELEVANT))
        columns = (table.kind, table.source, table.source_instance, table.target, table.target_instance)
        for number, kind, source, source_instance, target, instance in zip(
            numbers.tolist(), *(column[numbers].tolist() for column in columns), strict=True
        ):
            if kind == EventKind.RUNNABLE_START:
                self._executing.setdefault((source, source_instance), []).append((target, instance))
            elif kind == EventKind.RUNNABLE_TERMINATE:
                self._end(source, source_instance, (target, instance))
            elif executing := self._executing.get((target, instance)):
                if kind in _SUSPENDING:
                    job = number, number, EventKind.RUNNABLE_SUSPEND, target, instance
                    rows += [(*job, *runnable) for runnable in reversed(executing)]
                else:
                    job = number + 1, number, EventKind.RUNNABLE_RESUME, target, instance
                    rows += [(*job, *runnable) for runnable in executing]
        return rows

    def _end(self, process: int, job: int, runnable: tuple[int, int]) -> None:
        executing = self._executing.get((process, job), [])
        if runnable in executing:
            executing.remove(runnable)
            if not executing:
                del self._executing[process, job]
