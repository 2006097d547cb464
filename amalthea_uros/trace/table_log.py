"""What readers of tables have in common that viewers of traces export: columns are found by the words in their headings."""

from __future__ import annotations

import csv
import re
from abc import abstractmethod
from collections.abc import Mapping, Sequence

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.problems import Place
from amalthea_uros.trace.thread_log import ThreadLogReader, picoseconds

#: What may separate columns.
_DELIMITERS = "\t;,"
#: What viewers put between the digits of numbers: blanks of all kinds and apostrophes.
_GROUPING = re.compile(r"[\s'\u2019_]+")
#: Units in headings, as powers of ten of picoseconds.
_UNITS = {"ns": 3, "us": 6, "µs": 6, "μs": 6, "ms": 9, "s": 12}
_UNIT = re.compile(r"[\[(]\s*(ns|us|µs|μs|ms|s)\s*[\])]|\b(ns|us|ms)\b")


def fields_of(line: str, delimiter: str) -> list[str]:
    """The fields of a line, without the blanks around them."""
    try:
        row = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    except csv.Error:
        return []
    return [field.strip() for field in row]


def headings(line: str, wanted: Mapping[str, Sequence[str]]) -> tuple[str, dict[str, int]] | None:
    """The delimiter and the places of columns in a line of headings, None if the line is none.

    Parameters
    ----------
    wanted : of each column the words of which its heading contains one, and the first ones are preferred; columns of which the name
        ends in a question mark need not be there
    """
    for delimiter in _DELIMITERS:
        fields = [field.lower() for field in fields_of(line, delimiter)]
        found: dict[str, int] = {}
        for column, words in wanted.items():
            places = (place for word in words for place, field in enumerate(fields) if re.search(rf"\b{word}\b", field))
            place = next((place for place in places if place not in found.values()), None)
            if place is not None:
                found[column.removesuffix("?")] = place
            elif not column.endswith("?"):
                break
        else:
            return delimiter, found
    return None


class TableLogReader(ThreadLogReader):
    """Gives the events of a table with headings.

    Attributes
    ----------
    columns : the words in their headings
    """

    columns: Mapping[str, Sequence[str]] = {}

    _delimiter = ","
    _places: dict[str, int] | None = None
    _exponent = _UNITS["s"]

    @abstractmethod
    def _read_row(self, fields: Mapping[str, str], number: int, text: str) -> None:
        """Read a row of which the time is that of the next events."""

    def _read(self, text: str, number: int) -> None:
        if self._places is None:
            self._read_heading(text)
            return
        row = fields_of(text, self._delimiter)
        if len(row) <= max(self._places.values()):
            self._reject("a line has fewer fields than the headings", number, text)
            return
        fields = {column: row[place] for column, place in self._places.items()}
        time = picoseconds(_plain(fields["time"]), self._exponent)
        if time is None:
            self._reject("the time is not a number", number, text)
        elif self._move_to(time, number, text):
            self._read_row(fields, number, text)

    def _read_heading(self, text: str) -> None:
        found = headings(text, self.columns)
        if found is not None:
            self._delimiter, self._places = found
            heading = fields_of(text, self._delimiter)[self._places["time"]].lower()
            self._exponent = self._unit(heading, text)

    def _unit(self, heading: str, text: str) -> int:
        match = _UNIT.search(heading)
        if match is None:
            message = "the heading of the time has no unit; assuming seconds"
            self._problems.add(
                "TRC005", Severity.INFO, message, Place(None, None, text), "Export with the unit, e.g. Time (us)."
            )
            return _UNITS["s"]
        return _UNITS[match[1] or match[2]]


def _plain(text: str) -> str:
    """A number without the characters that group its digits."""
    digits = _GROUPING.sub("", text).removesuffix("s")
    return digits.replace(",", ".") if digits.count(",") == 1 and "." not in digits else digits
