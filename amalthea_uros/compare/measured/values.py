"""Measured values in CSV: a row for each value, or for each start and end; docs/measure.md describes both forms.

The header tells the form: `object,value_us`, or `object,start_us,end_us`; the unit is in the name of the column (ps, ns, us, ms, s).
Further columns: `quantity`, `kind`, and `time_..`, when a value was complete.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from decimal import Decimal, InvalidOperation
from fractions import Fraction
from pathlib import Path

from amalthea_uros.compare.measured.columns import LARGEST, UNITS
from amalthea_uros.diagnostics import Severity
from amalthea_uros.measure.series import Counts, MeasuredKind, Measurement, Series
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.trace.files import TracePlace, TraceProblems, opened_text

_COLUMN = re.compile(rf"(value|start|end|time)_({'|'.join(UNITS)})")
_PLAIN = ("object", "quantity", "kind")


def columns_of(header: list[str]) -> dict[str, tuple[int, int]] | None:
    """The places of the columns, and the picoseconds of their unit; None if it is not a header of measured values."""
    found: dict[str, tuple[int, int]] = {}
    for place, name in enumerate(each.strip() for each in header):
        match = _COLUMN.fullmatch(name)
        if match is not None:
            found[match[1]] = place, UNITS[match[2]]
        elif name in _PLAIN:
            found[name] = place, 1
    is_complete = "object" in found and ("value" in found or {"start", "end"} <= found.keys())
    return found if is_complete else None


def is_value_table(path: Path) -> bool:
    """Whether a file has measured values, by its name and its header."""
    if not path.name.lower().removesuffix(".gz").endswith(".csv"):
        return False
    with opened_text(path, TraceProblems(path)) as lines:
        return columns_of(next(csv.reader([next(lines, "")]), [])) is not None


def measured_values(path: Path, window: MeasurementWindow) -> Measurement:
    """Read measured values; lines that are none are counted in a finding.

    Raises
    ------
    ReadError : the file cannot be read.
    InvalidArgumentError : a part is to be measured of values without times.
    """
    problems = TraceProblems(path)
    with opened_text(path, problems) as lines:
        table = _Table(path.name, problems, window)
        table.read(csv.reader(lines))
    return Measurement(
        source=str(path),
        format="measured values",
        duration=table.duration,
        series=tuple(table.series()),
        findings=problems.findings,
    )


@dataclass(slots=True)
class _Table:
    name: str
    problems: TraceProblems
    window: MeasurementWindow
    _rows: dict[tuple[str, str, str], list[tuple[int, int | None]]] = field(default_factory=dict)
    _columns: dict[str, tuple[int, int]] = field(default_factory=dict)
    _first: int | None = None
    _last: int = 0

    def read(self, lines: csv._reader) -> None:  # type: ignore[name-defined]
        self._columns = columns_of(next(lines, [])) or {}
        if not {"time", "end"} & self._columns.keys():
            self.window.refuse_part(self.name)
        while True:
            try:
                for fields in lines:
                    self._add(lines.line_num, fields)
                return
            except csv.Error as error:
                self._wrong(lines.line_num, f"a line is not CSV: {error}; it is ignored", "")

    @property
    def duration(self) -> int:
        """From the first time to the last one."""
        return 0 if self._first is None else self._last - self._first

    def _add(self, line: int, fields: list[str]) -> None:
        if not fields:
            return
        try:
            name, quantity, kind = (self._text(fields, column, default) for column, default in _DEFAULTS.items())
            time, value = self._times(fields)
            MeasuredKind(kind)
        except (ValueError, IndexError, InvalidOperation):
            self._wrong(line, "a line has a time or a kind that is wrong, or too few fields; it is ignored", ",".join(fields))
            return
        if value < 0:
            self._wrong(line, "an interval ends before it starts; it is ignored", ",".join(fields))
            return
        if time is not None:
            self._first = time if self._first is None else self._first
            self._last = max(self._last, time)
            offset = time - self._first
            if not self.window.contains(offset):
                return
            time = offset
        self._rows.setdefault((name, quantity, kind), []).append((value, time))

    def _text(self, fields: list[str], column: str, default: str | None) -> str:
        place = self._columns.get(column)
        text = fields[place[0]].strip() if place is not None else default
        if not text:
            raise ValueError(column)
        return text

    def _times(self, fields: list[str]) -> tuple[int | None, int]:
        """When the value was complete, if that is known, and the value."""
        if "value" in self._columns:
            return (self._time(fields, "time") if "time" in self._columns else None), self._time(fields, "value")
        start, end = self._time(fields, "start"), self._time(fields, "end")
        return end, end - start

    def _time(self, fields: list[str], column: str) -> int:
        place, unit = self._columns[column]
        time = round(Fraction(Decimal(fields[place].strip())) * unit)
        if abs(time) > LARGEST:
            raise ValueError(column)
        return time

    def _wrong(self, line: int, message: str, text: str) -> None:
        self.problems.add("MEA009", Severity.ERROR, message, TracePlace(line, 1, text))

    def series(self) -> Iterator[Series]:
        """The values of each object and quantity."""
        import numpy as np

        from amalthea_uros.measure.series import statistics_of

        for (name, quantity, kind), rows in self._rows.items():
            values = np.array([value for value, _ in rows], np.int64)
            times = [time for _, time in rows if time is not None]
            yield Series(
                kind=MeasuredKind(kind),
                name=name,
                quantity=quantity,
                statistics=statistics_of(values),
                values=values,
                times=np.array(times, np.int64) if len(times) == len(rows) else None,
                counts=Counts(),
                method="values from a table",
            )


_DEFAULTS: dict[str, str | None] = {"object": None, "quantity": "duration", "kind": MeasuredKind.INTERVAL}
