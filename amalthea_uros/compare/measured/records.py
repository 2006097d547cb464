"""The rows of tables: of CSV, and of the documents that `ros2 topic echo` writes.

In documents, a field in a field has the names of both, such as `header.stamp.sec`; where there are `sec` and `nanosec`, the moment is
the column before them with its unit: `header.stamp_s`.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from itertools import chain
from typing import NamedTuple

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.files import TracePlace, TraceProblems


class Record(NamedTuple):
    """A row: the number of its line, and its fields without spaces around them. The first one has the names of the columns."""

    line: int
    fields: list[str]


_COMMENT = "#"
_DELIMITERS = ",;\t"
#: What ends a document of `ros2 topic echo`.
_END = "---"
_FIELD = re.compile(r"( *)([A-Za-z_]\w*):(?: (.*))?")


def read_records(lines: Iterator[str], problems: TraceProblems) -> Iterator[Record]:
    """The header, then the rows; lines that are none are problems."""
    numbered = ((number, line) for number, line in enumerate(lines, 1) if line.strip() and not line.startswith(_COMMENT))
    first = next(numbered, None)
    if first is None:
        return iter(())
    rest = chain([first], numbered)
    is_document = _FIELD.fullmatch(first[1].rstrip("\r\n")) is not None or first[1].strip() == _END
    return _from_documents(rest) if is_document else _from_csv(rest, first[1], problems)


def _from_csv(lines: Iterator[tuple[int, str]], header: str, problems: TraceProblems) -> Iterator[Record]:
    delimiter = max(_DELIMITERS, key=header.count)
    for number, line in lines:
        try:
            # Fields do not go over several lines, so that a quote that is missing spoils one row only.
            fields = next(csv.reader([line], delimiter=delimiter, strict=True))
        except csv.Error as error:
            place = TracePlace(number, 1, line.rstrip("\r\n"))
            problems.add("MEA009", Severity.ERROR, f"a line is not CSV: {error}; it is ignored", place)
            continue
        yield Record(number, [field.strip() for field in fields])


def _from_documents(lines: Iterator[tuple[int, str]]) -> Iterator[Record]:
    names: list[str] = []
    for number, document in _documents(lines):
        if not names:
            names = list(document)
            yield Record(number, names)
        yield Record(number, [document.get(name, "") for name in names])


def _documents(lines: Iterator[tuple[int, str]]) -> Iterator[tuple[int, dict[str, str]]]:
    """The fields of each document, with the number of its first line."""
    fields: dict[str, str] = {}
    parents: list[tuple[int, str]] = []
    first = 1
    for number, line in lines:
        if line.strip() == _END:
            if fields:
                yield first, _with_moments(fields)
            fields, parents = {}, []
            continue
        match = _FIELD.fullmatch(line.rstrip("\r\n"))
        if match is None:
            continue
        first = first if fields else number
        indent, name, value = len(match[1]), match[2], (match[3] or "").strip()
        parents = [each for each in parents if each[0] < indent]
        if value:
            fields[".".join((*(parent for _, parent in parents), name))] = value
        else:
            parents.append((indent, name))
    if fields:
        yield first, _with_moments(fields)


def _with_moments(fields: dict[str, str]) -> dict[str, str]:
    """The fields, with the moments of which seconds and nanoseconds are there."""
    moments = {}
    for name, seconds in fields.items():
        before, _, last = name.rpartition(".")
        nanoseconds = fields.get(f"{before}.nanosec", "")
        if last == "sec" and seconds.isdigit() and nanoseconds.isdigit():
            moments[f"{before}_s"] = f"{seconds}.{nanoseconds:0>9}"
    return fields | moments
