"""Events that are kept in memory."""

from __future__ import annotations

from collections.abc import Sequence
from types import TracebackType
from typing import Self

from amalthea_uros.trace.table import Entity, EventTable, concatenate


class Recorder:
    """A sink that keeps all events; it is its own opener."""

    def __init__(self) -> None:
        self._tables: list[EventTable] = []

    def __call__(self, entities: Sequence[Entity]) -> Self:
        """Open it."""
        self._tables = [EventTable.empty(entities)]
        return self

    @property
    def table(self) -> EventTable:
        """The events so far."""
        return concatenate(self._tables)

    def write(self, table: EventTable) -> None:
        """Keep some events."""
        self._tables.append(table)

    def close(self) -> None:
        """Nothing is left to do."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        """Keep the events for the caller."""
