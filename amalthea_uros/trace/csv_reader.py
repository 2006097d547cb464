"""Reads traces in CSV; `csv_format` describes the columns."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from pathlib import Path

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.csv_format import EVENT_NAMES, HEADER
from amalthea_uros.trace.line_reader import LineReader
from amalthea_uros.trace.problems import Place
from amalthea_uros.trace.row_tables import BLOCK, MAX, NumberedTable, Row, note_of, numbered_table
from amalthea_uros.trace.table import EntityKind
from amalthea_uros.trace.text_lines import opened_text

_KINDS = {kind.value: kind for kind in EntityKind}


class Reader(LineReader):
    """Gives the events of a CSV file."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._numbers: dict[tuple[str, ...], int] = {}

    def numbered(self) -> Iterator[NumberedTable]:
        """The events, with the number of the line of each."""
        with opened_text(self._path, self._problems) as stream:
            lines = self._lines(stream)
            if next(lines, (0, None))[1] != HEADER:
                message = f"the first line is not the header of a trace: {','.join(HEADER)}"
                self._problems.add("TRC005", Severity.WARNING, message, Place(1, 1), "Check that this is a trace.")
            rows = (self._row(line, fields) or self._gap_row(self._last, line) for line, fields in lines)
            while block := list(islice(rows, BLOCK)):
                yield numbered_table(block, self._patterns, self._index, scale=1)

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
                self._problems.add("TRC002", Severity.ERROR, message, Place(reader.line_num, 1))
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
            self._problems.add("TRC002", Severity.ERROR, message, Place(line, 1, ",".join(fields)))
            return None
        if not (0 <= time <= MAX and 0 <= job <= MAX and 0 <= instance <= MAX):
            message = "a number is negative or too large; this line is ignored"
            self._problems.add("TRC002", Severity.ERROR, message, Place(line, 1, ",".join(fields)))
            return None
        if time < self._last:
            message = "the time is less than that of an event before; this line is ignored"
            self._problems.add("TRC004", Severity.ERROR, message, Place(line, 1, ",".join(fields)), "Sort the events by time.")
            return None
        self._last = time
        return time, pattern, job, instance, note_of(note_field, self._patterns[pattern][0], self._index, note_field), line

    def _new_pattern(self, event: str, source_kind: str, source: str, target_kind: str, target: str) -> int:
        kind, of_source, of_target = EVENT_NAMES[event], _KINDS[source_kind], _KINDS[target_kind]
        number = self._numbers[event, source_kind, source, target_kind, target] = len(self._patterns)
        self._patterns.append((kind, self._index.index(of_source, source), self._index.index(of_target, target)))
        return number
