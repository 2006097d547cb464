"""Best Trace Format (BTF): read in versions 2.1, 2.2 and 2.3, and written in 2.3.0.

BTF knows no quotes: what would end a field or a line is written as a percent sign and two digits. That is a comma, a control character,
a blank at either end, which readers drop, and a percent sign before two digits.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import islice
from pathlib import Path

import numpy as np

from amalthea_uros._version import __version__
from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.files import TracePlace, TraceProblems, opened_text
from amalthea_uros.trace.reading import (
    BLOCK,
    MAX,
    EntityIndex,
    LineReader,
    Pattern,
    Row,
    note_of,
    table_of,
)
from amalthea_uros.trace.sinks import Encoder
from amalthea_uros.trace.table import NO_NOTE, Entity, EntityKind, EventKind, EventTable
from amalthea_uros.trace.vocabulary import EVENTS, OS_EVENTS, SOURCES, TYPES, WORDS

#: What may be around fields and at the ends of lines; other white space belongs to names.
BLANKS = " \t\r\n"

_UNWRITABLE = re.compile(r"[,\x00-\x1f\x7f]|^ | $|%(?=[0-9A-F]{2})")
_ESCAPED = re.compile(r"%([0-9A-F]{2})")


def escape(name: str) -> str:
    """A name as it is written."""
    return _UNWRITABLE.sub(lambda found: f"%{ord(found[0]):02X}", name)


def unescape(text: str) -> str:
    """A name that `escape` has written; names of other tools hardly ever look like that."""
    return _ESCAPED.sub(lambda found: chr(int(found[1], 16)), text) if "%" in text else text


#: What the rows of the old tables mean in new parameters; `entityType` is in an example of version 1.
_TABLES = {
    "typetable": "typemapping",
    "entitytype": "typemapping",
    "entitytable": "entitymapping",
    "entitytypetable": "entitytypemapping",
}
#: Picoseconds of the units of time.
TIMESCALES = {"ps": 1, "ns": 10**3, "us": 10**6, "ms": 10**9, "s": 10**12}
#: The unit of times where no header says it (BTF 2.1.5).
_DEFAULT = "ns"


class BtfHeader:
    """What the header says; parameters may come between events, before what they are about.

    Attributes
    ----------
    scale : picoseconds of the unit of time
    """

    def __init__(self, index: EntityIndex, problems: TraceProblems) -> None:
        self.scale = TIMESCALES[_DEFAULT]
        self._index, self._problems = index, problems
        self._has_events = False
        self._table = ""
        self._seen: set[str] = set()
        self._types: dict[str, str] = {}
        self._names: dict[str, str] = {}
        self._known: dict[str, int] = {}

    def read(self, line: str, place: TracePlace) -> None:
        """Read a comment or a parameter; unknown ones are ignored, as the standard wants it."""
        keyword, _, value = line[1:].strip(BLANKS).partition(" ")
        if keyword.startswith("-"):
            keyword, value = self._table, f"{keyword[1:]} {value}"
        keyword = keyword.lower()
        self._seen.add(keyword)
        if keyword in _TABLES:
            self._table = _TABLES[keyword]
        elif keyword == "timescale":
            self._set_timescale(value.strip(BLANKS), place)
        elif keyword.endswith("mapping"):
            first, _, second = value.strip(BLANKS).partition(" ")
            self._map(keyword, first, second.strip(BLANKS))

    def end(self, place: TracePlace) -> None:
        """Report what should have been said before the first event, which is at a place."""
        self._has_events = True
        if "version" not in self._seen:
            self._problems.add("TRC005", Severity.WARNING, "the header has no #version", place, "Check that this is BTF.")
        if "timescale" not in self._seen:
            message = f"the header has no #timescale; assuming {_DEFAULT}"
            self._problems.add("TRC005", Severity.WARNING, message, place, "Add e.g. #timescale ns.")

    def kind(self, field: str) -> EntityKind | None:
        """The type that a field stands for, None if it has no events that are of interest."""
        return TYPES.get(self._types.get(field, field))

    def type_name(self, field: str) -> str:
        """The letters of the type that a field stands for."""
        return self._types.get(field, field)

    def name(self, field: str) -> str:
        """The name of the entity that a field stands for."""
        return self._names[field] if field in self._names else unescape(field)

    def entity(self, field: str) -> int | None:
        """The index of the entity with a number of which the header says the type."""
        return self._known.get(field)

    def _set_timescale(self, unit: str, place: TracePlace) -> None:
        if self._has_events:
            message = "the timescale comes after the first event; it is ignored"
            self._problems.add("TRC005", Severity.WARNING, message, place, "Move #timescale to the top.")
        elif unit in TIMESCALES:
            self.scale = TIMESCALES[unit]
        else:
            message = f"unknown timescale {unit!r}; assuming {_DEFAULT}"
            self._problems.add("TRC005", Severity.WARNING, message, place, f"Use one of {', '.join(TIMESCALES)}.")

    def _map(self, keyword: str, first: str, second: str) -> None:
        if keyword == "typemapping":
            self._types[first] = second
        elif keyword == "entitymapping":
            self._names[first] = unescape(second)
        elif keyword == "entitytypemapping":
            kind = self.kind(first)
            if kind is not None:
                index = self._index.index(kind, self.name(second))
                if second in self._names:
                    self._known[second] = index


# Reading: with names or numbers, old spellings, and blanks around fields.


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

    def __iter__(self) -> Iterator[EventTable]:
        """The events, in consecutive tables."""
        with opened_text(self._path, self._problems) as stream:
            line = 1
            while lines := list(islice(stream, BLOCK)):
                rows = self._rows(lines, line)
                line += len(lines)
                if rows:
                    yield table_of(rows, self._patterns, self._index, self._header.scale)

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
                    rows.append(self._gap_row(last))
                limit = MAX // self._header.scale
                continue
            pattern = numbers.get((source, kind, target, event))
            if pattern is None:
                pattern = self._new_pattern(source, kind, target, event, TracePlace(line, None, text.rstrip(BLANKS)))
            if not (last <= time <= limit and -1 <= job <= MAX and -1 <= instance <= MAX):
                self._report_range(time, last, TracePlace(line, 1, text.rstrip(BLANKS)))
                rows.append(self._gap_row(last))
            elif pattern != _LEFT_OUT:
                last = time
                rows.append((time, pattern, job, instance, self._note(notes[0], pattern) if notes else NO_NOTE))
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


# Writing: events of chains are left out.


_KNOWN = np.array(sorted(WORDS))
_ENDINGS = {int(kind): f",{word}\n" for kind, word in WORDS.items()}


class BtfEncoder(Encoder):
    """Makes the lines of a BTF file, without a date, so that equal traces are equal files."""

    def __init__(self, entities: Sequence[Entity]) -> None:
        super().__init__(entities)
        self._names: list[str] = []
        self._targets: list[str] = []

    def begin(self) -> bytes:
        """The header."""
        lines = ("#version 2.3.0", f"#creator amuros {__version__}", "#timescale ps", *self._types_of_new_entities())
        return _joined(lines)

    def encode(self, table: EventTable) -> bytes:
        """The lines of some events, after the types of new entities."""
        types = self._types_of_new_entities()
        is_known = np.isin(table.kind, _KNOWN)
        if not is_known.all():
            table = table.where(is_known)
        names, targets = self._names, self._targets
        rows = zip(
            table.time.tolist(),
            [names[source] for source in table.source.tolist()],
            table.source_instance.tolist(),
            [targets[target] for target in table.target.tolist()],
            table.target_instance.tolist(),
            self._endings(table),
            strict=True,
        )
        lines = "".join(
            [f"{time},{source},{job},{target}{number}{ending}" for time, source, job, target, number, ending in rows]
        )
        return _joined(types) + lines.encode()

    def _types_of_new_entities(self) -> list[str]:
        lines = []
        for entity in self._entities[len(self._names) :]:
            name = escape(entity.name)
            if entity.kind is not EntityKind.CHAIN:
                lines.append(f"#entityTypeMapping {entity.kind} {name}")
            self._names.append(name)
            self._targets.append(f"{entity.kind},{name},")
        return lines

    def _endings(self, table: EventTable) -> list[str]:
        """The last fields of the events: the word, and the note if there is one."""
        kinds = table.kind.tolist()
        endings = [_ENDINGS[kind] for kind in kinds]
        for row in np.flatnonzero(table.note != NO_NOTE).tolist():
            note = int(table.note[row])
            # The standard wants the owner of an OS event there.
            text = self._names[note] if kinds[row] in OS_EVENTS else str(note)
            endings[row] = f"{endings[row][:-1]},{text}\n"
        return endings


def _joined(lines: Sequence[str]) -> bytes:
    return "".join(f"{line}\n" for line in lines).encode()
