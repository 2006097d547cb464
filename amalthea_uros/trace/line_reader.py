"""What readers of text formats have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from pathlib import Path

from amalthea_uros.diagnostics import Finding
from amalthea_uros.trace.entity_index import EntityIndex
from amalthea_uros.trace.problems import Problems
from amalthea_uros.trace.row_tables import NumberedTable, Pattern, Row
from amalthea_uros.trace.table import NO_NOTE, Entity, EntityKind, EventKind, EventTable


class LineReader(ABC):
    """Gives the events of a text file; `amalthea_uros.trace.readers.TraceReader` tells how it is used."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._problems = Problems(path)
        self._index = EntityIndex()
        self._patterns: list[Pattern] = []
        self._last = 0
        self._gap: int | None = None

    @property
    def entities(self) -> Sequence[Entity]:
        """The entities so far."""
        return self._index.entities

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The problems so far."""
        return self._problems.findings

    def __iter__(self) -> Iterator[EventTable]:
        return (table for table, _ in self.numbered())

    @abstractmethod
    def numbered(self) -> Iterator[NumberedTable]:
        """The events, with the number of the line of each."""

    def _gap_row(self, time: int, line: int) -> Row:
        """The place of a line that cannot be used: nobody knows which event is missing."""
        if self._gap is None:
            recorder = self._index.index(EntityKind.SCHEDULER, "recorder")
            self._gap = len(self._patterns)
            self._patterns.append((EventKind.GAP, recorder, recorder))
        return time, self._gap, 0, 0, NO_NOTE, line
