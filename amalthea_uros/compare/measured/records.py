"""The rows of tables: of CSV, and of the documents that `ros2 topic echo` writes.

In documents, a field in a field has the names of both, such as `header.stamp.sec`; where there are `sec` and `nanosec`, the moment is
the column before them with its unit: `header.stamp_s`. Between documents, the tool reports how many messages were lost (ros2/ros2cli,
ros2topic/verb/echo.py), and it ends each document with a line: one without it was cut off.
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
    """A row, or rows that were lost. The first one has the names of the columns.

    Attributes
    ----------
    line : its number
    fields : without spaces around them; empty if nothing of it is known
    rows : how many were lost, if it has no fields
    """

    line: int
    fields: list[str]
    rows: int = 1


_COMMENT = "#"
_DELIMITERS = ",;\t"
#: What ends a document of `ros2 topic echo`.
_END = "---"
_FIELD = re.compile(r"( *)([A-Za-z_]\w*):(?: (.*))?")
_LOST_TITLE = "A message was lost!!!"
_LOST = re.compile(r"\s*total count change:\s*(\d{1,15})\s*")


def read_records(lines: Iterator[str], problems: TraceProblems) -> Iterator[Record]:
    """The header, then the rows; lines that are none are problems, and lost rows."""
    numbered = ((number, line) for number, line in enumerate(lines, 1) if line.strip() and not line.startswith(_COMMENT))
    first = next(numbered, None)
    if first is None:
        return iter(())
    rest = chain([first], numbered)
    is_document = _FIELD.fullmatch(first[1].rstrip("\r\n")) is not None or first[1].strip() in (_END, _LOST_TITLE)
    return _from_documents(rest, problems) if is_document else _from_csv(rest, first[1], problems)


def _from_csv(lines: Iterator[tuple[int, str]], header: str, problems: TraceProblems) -> Iterator[Record]:
    delimiter, width = max(_DELIMITERS, key=header.count), 0
    for number, line in lines:
        place = TracePlace(number, 1, line.rstrip("\r\n"))
        try:
            # Fields do not go over several lines, so that a quote that is missing spoils one row only.
            fields = [field.strip() for field in next(csv.reader([line], delimiter=delimiter, strict=True))]
        except csv.Error as error:
            problems.add("MEA009", Severity.ERROR, f"a line is not CSV: {error}; it has no value", place)
            fields = []
        width = width or len(fields)
        if any(fields[width:]):
            message = "a line has more fields than the header; it has no value"
            problems.add("MEA009", Severity.ERROR, message, place, _SEPARATORS)
            fields = []
        yield Record(number, fields)


#: A number with a decimal comma would be two fields.
_SEPARATORS = "If numbers have decimal commas, write them with points."


def _from_documents(lines: Iterator[tuple[int, str]], problems: TraceProblems) -> Iterator[Record]:
    names: list[str] = []
    lost: list[Record] = []
    for found in _documents(lines, problems):
        if isinstance(found, Record):
            lost.append(found)
            continue
        number, document = found
        if not names:
            names = list(document)
            yield Record(number, names)
        yield Record(number, [document.get(name, "") for name in names])
    yield from lost


def _documents(lines: Iterator[tuple[int, str]], problems: TraceProblems) -> Iterator[tuple[int, dict[str, str]] | Record]:
    """The fields of each document, with the number of its first line, and the rows that were lost."""
    fields: dict[str, str] = {}
    parents: list[tuple[int, str]] = []
    first = 1
    for number, line in lines:
        if line.strip() == _END:
            if fields:
                yield first, _with_moments(fields)
            fields, parents = {}, []
        elif match := _LOST.fullmatch(line):
            problems.add("MEA015", Severity.WARNING, "messages were lost, as the tool reports", TracePlace(number, 1, line))
            yield Record(number, [], int(match[1]))
        elif match := _FIELD.fullmatch(line.rstrip("\r\n")):
            first = first if fields else number
            indent, name, value = len(match[1]), match[2], (match[3] or "").strip()
            parents = [each for each in parents if each[0] < indent]
            path = ".".join((*(parent for _, parent in parents), name))
            if not value:
                parents.append((indent, name))
            else:
                # Of the elements of a list, which one is meant is not known.
                fields[path] = "" if path in fields else value
    if fields:
        message = "the last document is cut off; it counts as lost"
        problems.add("MEA009", Severity.ERROR, message, TracePlace(first, 1))
        yield Record(first, [])


def _with_moments(fields: dict[str, str]) -> dict[str, str]:
    """The fields, with the moments of which seconds and nanoseconds are there."""
    moments = {}
    for name, seconds in fields.items():
        before, _, last = name.rpartition(".")
        nanoseconds = fields.get(f"{before}.nanosec", "")
        if last == "sec" and seconds.isdigit() and nanoseconds.isdigit():
            moments[f"{before}_s"] = f"{seconds}.{nanoseconds:0>9}"
    return fields | moments
