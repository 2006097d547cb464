"""Reads BTF files of versions 2.1, 2.2 and 2.3, with names or numbers, old spellings, and blanks around fields."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.btf.header import BLANKS, BtfHeader
from amalthea_uros.trace.files import opened_text
from amalthea_uros.trace.problems import TracePlace
from amalthea_uros.trace.reading import BLOCK, MAX, LineReader, NumberedTable, Pattern, Row, note_of, numbered_table
from amalthea_uros.trace.table import NO_NOTE, EventKind
from amalthea_uros.trace.vocabulary import EVENTS, SOURCES

#: Types and events of older versions and of descriptions of the system, which say nothing about its timing.
_IGNORED_TYPES = frozenset({"SIM", "SYS", "IB", "ECU", "Processor", "P", "M", "C"})
_IGNORED_EVENTS = frozenset(
    [
        "tag",
        "description",
        "error",
        "finalize",
        "boundedmigration",
        "phasemigration",
        "fullmigration",
        "enforcedmigration",
        "processactivate",
        "processpolling",
        "processterminate",
        "ready",
        "exclusivesemaphore",
    ]
)
#: In the place of the number of a pattern: lines with these words are left out.
_LEFT_OUT = -1
_FIELDS = ("time", "source", "source instance", "type", "target", "target instance", "event")
#: The places of fields that are numbers.
_NUMBERS = (0, 2, 5)
#: Before BTF 2.2, stimuli that come from outside have the simulation as source, since then themselves.
_SIMULATION = "SIM"


class BtfReader(LineReader):
    """Gives the events of a BTF file."""

    def __init__(self, path: Path) -> None:
        super().__init__(path)
        self._header = BtfHeader(self._index, self._problems)
        self._numbers: dict[tuple[str, str, str, str], int] = {}

    def numbered(self) -> Iterator[NumberedTable]:
        """The events, with the number of the line of each."""
        with opened_text(self._path, self._problems) as stream:
            line = 1
            while lines := list(islice(stream, BLOCK)):
                rows = self._rows(lines, line)
                line += len(lines)
                if rows:
                    yield numbered_table(rows, self._patterns, self._index, self._header.scale)

    def _rows(self, lines: Sequence[str], start: int) -> list[Row]:
        """The rows of some lines, of which the first one has a number; what is unusual is left to other methods."""
        rows: list[Row] = []
        # Names of its own, because this loop is where reading takes its time.
        numbers, last, limit = self._numbers, self._last, MAX // self._header.scale
        for line, text in enumerate(lines, start):
            try:
                time_field, source, job_field, kind, target, instance_field, event, *notes = text.split(",")
                time, job, instance = int(time_field), int(job_field or 0), int(instance_field or 0)
            except ValueError:
                if not self._read_other(line, text) and self._patterns:
                    rows.append(self._gap_row(last, line))
                limit = MAX // self._header.scale
                continue
            pattern = numbers.get((source, kind, target, event))
            if pattern is None:
                pattern = self._new_pattern(source, kind, target, event, TracePlace(line, None, text.rstrip(BLANKS)))
            if not (last <= time <= limit and -1 <= job <= MAX and -1 <= instance <= MAX):
                self._report_range(time, last, TracePlace(line, 1, text.rstrip(BLANKS)))
                rows.append(self._gap_row(last, line))
            elif pattern != _LEFT_OUT:
                last = time
                rows.append((time, pattern, job, instance, self._note(notes[0], pattern) if notes else NO_NOTE, line))
        self._last = last
        return rows

    def _note(self, field: str, pattern: int) -> int:
        text = field.strip(BLANKS)
        return note_of(text, self._patterns[pattern][0], self._index, self._header.name(text))

    def _new_pattern(self, source: str, kind: str, target: str, event: str, place: TracePlace) -> int:
        """The number of a pattern, by fields as they are in the file."""
        if not self._numbers:
            self._header.end(place)
        pattern = self._resolved(source.strip(BLANKS), kind.strip(BLANKS), target.strip(BLANKS), event.strip(BLANKS), place)
        if pattern is None:
            number = _LEFT_OUT
        else:
            number = len(self._patterns)
            self._patterns.append(pattern)
        self._numbers[source, kind, target, event] = number
        return number

    def _resolved(self, source: str, type_field: str, target: str, word: str, place: TracePlace) -> Pattern | None:
        type_name, kind = self._header.type_name(type_field), self._header.kind(type_field)
        event = EVENTS.get(kind, {}).get(word) if kind is not None else None
        if kind is None or event is None:
            if type_name not in _IGNORED_TYPES and word not in _IGNORED_EVENTS:
                message = f"{word!r} is not an event of entities of type {type_name!r}; it is ignored"
                self._problems.add("TRC003", Severity.WARNING, message, place)
            return None
        target_index = self._index.index(kind, self._header.name(target))
        is_itself = source == target or (event is EventKind.TRIGGER and self._header.name(source) == _SIMULATION)
        if is_itself and kind in SOURCES[event]:
            return event, target_index, target_index
        source_index = self._header.entity(source)
        if source_index is None:
            source_index = self._index.source_index(self._header.name(source), SOURCES[event])
        return event, source_index, target_index

    def _read_other(self, line: int, text: str) -> bool:
        """Read a line that is not an event; whether nothing is wrong with it."""
        text = text.rstrip(BLANKS)
        if text.startswith("#"):
            self._header.read(text, TracePlace(line, 1, text))
        elif text:
            fields = text.split(",")
            wrong = next((field for field in _NUMBERS if field < len(fields) and not _is_number(fields[field])), None)
            if len(fields) < len(_FIELDS) or wrong is None:
                message = f"an event has {len(_FIELDS)} fields and maybe a note: {', '.join(_FIELDS)}; this line is ignored"
                self._problems.add("TRC002", Severity.ERROR, message, TracePlace(line, 1, text))
            else:
                column = len(",".join(fields[:wrong])) + (2 if wrong else 1)
                message = f"the {_FIELDS[wrong]} is not a whole number; this line is ignored"
                self._problems.add("TRC002", Severity.ERROR, message, TracePlace(line, column, text))
            return False
        return True

    def _report_range(self, time: int, last: int, place: TracePlace) -> None:
        if 0 <= time < last:
            message = "the time is less than that of an event before; this line is ignored"
            self._problems.add("TRC004", Severity.ERROR, message, place, "Sort the events by time.")
        else:
            message = "a number is negative or too large; this line is ignored"
            self._problems.add("TRC002", Severity.ERROR, message, place)


def _is_number(field: str) -> bool:
    try:
        int(field or 0)
    except ValueError:
        return False
    return True
