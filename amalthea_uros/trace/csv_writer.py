"""Traces as CSV; `csv_format` describes the columns."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from amalthea_uros.trace.csv_format import EVENT_NAMES, HEADER
from amalthea_uros.trace.sinks import WriteOptions
from amalthea_uros.trace.table import NO_NOTE, Entity, EventTable
from amalthea_uros.trace.vocabulary import OS_EVENTS

_NAMES = {int(kind): name for name, kind in EVENT_NAMES.items()}


class TraceEncoder:
    """Makes the lines of a CSV file; it has no options."""

    def __init__(self, entities: Sequence[Entity], _options: WriteOptions) -> None:
        self._entities = entities
        self._fields: list[str] = []

    def begin(self) -> bytes:
        """The names of the columns."""
        return f"{','.join(HEADER)}\n".encode()

    def encode(self, table: EventTable) -> bytes:
        """The lines of some events."""
        fields = self._fields
        fields += [f"{entity.kind},{_quoted(entity.name)}" for entity in self._entities[len(fields) :]]
        rows = zip(
            table.time.tolist(),
            [_NAMES[kind] for kind in table.kind.tolist()],
            [fields[source] for source in table.source.tolist()],
            table.source_instance.tolist(),
            [fields[target] for target in table.target.tolist()],
            table.target_instance.tolist(),
            self._notes(table),
            strict=True,
        )
        return "".join(
            [
                f"{time},{kind},{source},{job},{target},{number},{note}\n"
                for time, kind, source, job, target, number, note in rows
            ]
        ).encode()

    def end(self) -> bytes:
        """Nothing: the file ends with the last event."""
        return b""

    def _notes(self, table: EventTable) -> list[str]:
        notes = [""] * len(table)
        for row in np.flatnonzero(table.note != NO_NOTE).tolist():
            note = int(table.note[row])
            notes[row] = _quoted(self._entities[note].name) if table.kind[row] in OS_EVENTS else str(note)
        return notes


def _quoted(name: str) -> str:
    """A name as a field; always in quotes if it could be something else without."""
    return '"' + name.replace('"', '""') + '"' if any(character in name for character in ',"\r\n') else name
