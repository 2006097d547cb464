"""The header of BTF files: parameters of 2.2 and newer, and the tables of 2.1 and older; and how names are written.

BTF knows no quotes: what would end a field or a line is written as a percent sign and two digits. That is a comma, a control character,
a blank at either end, which readers drop, and a percent sign before two digits.
"""

from __future__ import annotations

import re

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.problems import TracePlace, TraceProblems
from amalthea_uros.trace.reading import EntityIndex
from amalthea_uros.trace.table import EntityKind
from amalthea_uros.trace.vocabulary import TYPES

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
