"""Traces as CSV files, which hold all that a table of events does: UTF-8, commas, quotes where needed (RFC 4180).

| column | content |
|---|---|
| time_ps | picoseconds |
| event | name of the kind of event, e.g. runnable_start |
| source_kind, source, source_instance | type (letters of BTF, CHAIN), name, and number of the job or occurrence |
| target_kind, target, target_instance | likewise |
| note | a whole number or nothing; for events of OS events the name of the task that owns it |
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from pathlib import Path

from amalthea_uros._internal.csv_cells import original_text, safe_cell
from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.files import TracePlace, opened_text
from amalthea_uros.trace.reading import BLOCK, MAX, LineReader, Row, note_of, table_of
from amalthea_uros.trace.sinks import Encoder
from amalthea_uros.trace.table import Entity, EntityKind, EventKind, EventTable

HEADER = ["time_ps", "event", "source_kind", "source", "source_instance", "target_kind", "target", "target_instance", "note"]

#: The kinds of events by their names in files.
EVENT_NAMES = {kind.name.lower(): kind for kind in EventKind}


_KINDS = {kind.value: kind for kind in EntityKind}


class CsvReader(LineReader):
    """Gives the events of a CSV file."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._numbers: dict[tuple[str, ...], int] = {}

    def __iter__(self) -> Iterator[EventTable]:
        """The events, in consecutive tables."""
        with opened_text(self._path, self._problems) as stream:
            lines = self._lines(stream)
            if next(lines, (0, None))[1] != HEADER:
                message = f"the first line is not the header of a trace: {','.join(HEADER)}"
                self._problems.add("TRC005", Severity.WARNING, message, TracePlace(1, 1), "Check that this is a trace.")
            rows = (self._row(line, fields) or self._gap_row(self._last) for line, fields in lines)
            while block := list(islice(rows, BLOCK)):
                yield table_of(block, self._patterns, self._index)

    def _lines(self, stream: Iterable[str]) -> Iterator[tuple[int, list[str]]]:
        """The lines with their numbers; those that are not CSV, such as ones with a carriage return in a name, are empty."""
        reader = csv.reader(stream)
        while True:
            try:
                for fields in reader:
                    yield reader.line_num, fields
                return
            except csv.Error as error:
                message = f"a line is not CSV: {error}; it is ignored"
                self._problems.add("TRC002", Severity.ERROR, message, TracePlace(reader.line_num, 1))
                yield reader.line_num, []

    def _row(self, line: int, fields: Sequence[str]) -> Row | None:
        if not fields:
            return None
        try:
            time_field, event, source_kind, source, job_field, target_kind, target, instance_field, note_field = fields
            time, job, instance = int(time_field), int(job_field), int(instance_field)
            words = event, source_kind, source, target_kind, target
            pattern = self._numbers.get(words)
            if pattern is None:
                pattern = self._new_pattern(*words)
        except (ValueError, KeyError):
            message = f"a line has a number, name of an event or type that is wrong, or not {len(HEADER)} fields; it is ignored"
            self._problems.add("TRC002", Severity.ERROR, message, TracePlace(line, 1, ",".join(fields)))
            return None
        if not (0 <= time <= MAX and 0 <= job <= MAX and 0 <= instance <= MAX):
            message = "a number is negative or too large; this line is ignored"
            self._problems.add("TRC002", Severity.ERROR, message, TracePlace(line, 1, ",".join(fields)))
            return None
        if time < self._last:
            message = "the time is less than that of an event before; this line is ignored"
            self._problems.add(
                "TRC004", Severity.ERROR, message, TracePlace(line, 1, ",".join(fields)), "Sort the events by time."
            )
            return None
        self._last = time
        note = note_of(note_field, self._patterns[pattern][0], self._index, original_text(note_field))
        return time, pattern, job, instance, note

    def _new_pattern(self, event: str, source_kind: str, source: str, target_kind: str, target: str) -> int:
        kind, of_source, of_target = EVENT_NAMES[event], _KINDS[source_kind], _KINDS[target_kind]
        number = self._numbers[event, source_kind, source, target_kind, target] = len(self._patterns)
        first, second = (
            self._index.index(*end) for end in ((of_source, original_text(source)), (of_target, original_text(target)))
        )
        self._patterns.append((kind, first, second))
        return number


_NAMES = {int(kind): name for name, kind in EVENT_NAMES.items()}


class CsvEncoder(Encoder):
    """Makes the lines of a CSV file."""

    def __init__(self, entities: Sequence[Entity]) -> None:
        super().__init__(entities)
        self._fields: list[str] = []

    def begin(self) -> bytes:
        """The names of the columns."""
        return f"{','.join(HEADER)}\n".encode()

    def encode(self, table: EventTable) -> bytes:
        """The lines of some events."""
        fields = self._fields
        fields += [f"{entity.kind},{_quoted(safe_cell(entity.name))}" for entity in self._entities[len(fields) :]]
        rows = zip(
            table.time.tolist(),
            [_NAMES[kind] for kind in table.kind.tolist()],
            [fields[source] for source in table.source.tolist()],
            table.source_instance.tolist(),
            [fields[target] for target in table.target.tolist()],
            table.target_instance.tolist(),
            ["" if note is None else _quoted(safe_cell(note)) if isinstance(note, str) else note for note in table.notes()],
            strict=True,
        )
        return "".join(
            [
                f"{time},{kind},{source},{job},{target},{number},{note}\n"
                for time, kind, source, job, target, number, note in rows
            ]
        ).encode()


def _quoted(name: str) -> str:
    """A name as a field; always in quotes if it could be something else without."""
    return '"' + name.replace('"', '""') + '"' if any(character in name for character in ',"\r\n') else name
