"""Measured values in CSV: a row for each value, or for each start and end; docs/measure.md describes both forms.

The header tells the form: `object,value_us`, or `object,start_us,end_us`; the unit is in the name of the column (ps, ns, us, ms, s).
Further columns: `quantity`, `kind`, and `time_..`, when a value was complete.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from amalthea_uros._internal.csv_cells import original_text
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.compare.measured.columns import LARGEST, UNITS
from amalthea_uros.compare.measured.records import Record, read_records
from amalthea_uros.compare.measured.table_layout import TimesColumn
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.measure.series import Counts, MeasuredKind, Measurement, Series
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.trace.files import TracePlace, TraceProblems, opened_text

_COLUMN = re.compile(rf"(value|start|end|time)_({'|'.join(UNITS)})")
_PLAIN = ("object", "quantity", "kind")


def columns_of(header: Sequence[str]) -> dict[str, list[TimesColumn]] | None:
    """The columns by what they have, of texts and of times; None if it is not a header of measured values."""
    found: dict[str, list[TimesColumn]] = {}
    for place, name in enumerate(header):
        match = _COLUMN.fullmatch(name)
        if match is not None:
            found.setdefault(match[1], []).append(TimesColumn(place, UNITS[match[2]]))
        elif name in _PLAIN:
            found.setdefault(name, []).append(TimesColumn(place, 1))
    is_complete = "object" in found and ("value" in found or {"start", "end"} <= found.keys())
    return found if is_complete else None


def is_value_table(path: Path) -> bool:
    """Whether a file has measured values, by its name and its header."""
    if not path.name.lower().removesuffix(".gz").endswith(".csv"):
        return False
    with opened_text(path, TraceProblems(path)) as lines:
        header = next(read_records(lines, TraceProblems(path)), None)
        return header is not None and columns_of(header.fields) is not None


def measured_values(path: Path, window: MeasurementWindow) -> Measurement:
    """Read measured values; lines that are none are counted in a finding.

    Raises
    ------
    ReadError : the file cannot be read, or two of its columns have the same.
    InvalidArgumentError : a part is to be measured of values without times.
    """
    problems = TraceProblems(path)
    with opened_text(path, problems) as lines:
        records = read_records(lines, problems)
        table = _TableOfTimes(problems, window, _only_columns(path, next(records, Record(1, []))))
        if not {"time", "end"} & table.columns.keys():
            window.refuse_part(path.name)
        for record in records:
            table.add(record)
    return Measurement(
        source=str(path),
        format="measured values",
        duration=table.duration,
        series=tuple(table.series()),
        findings=problems.findings,
    )


def _only_columns(path: Path, header: Record) -> dict[str, TimesColumn]:
    """The columns of a header, of which no two have the same."""
    found = columns_of(header.fields) or {}
    for what, columns in found.items():
        if len(columns) > 1:
            message = f"the table has {len(columns)} columns with '{what}', and which one is meant is not known"
            place = Location(path, header.line, 1, ",".join(header.fields))
            raise ReadError([Finding("MEA016", Severity.ERROR, message, place, "Leave the others out.")])
    return {what: columns[0] for what, columns in found.items()}


@dataclass(slots=True)
class _TableOfTimes:
    problems: TraceProblems
    window: MeasurementWindow
    columns: dict[str, TimesColumn]
    _rows: dict[tuple[str, str, str], list[tuple[int, int | None]]] = field(default_factory=dict)
    _first: int | None = None
    _last: int = 0

    @property
    def duration(self) -> int:
        """From the first time to the last one."""
        return 0 if self._first is None else self._last - self._first

    def add(self, record: Record) -> None:
        """Take a row."""
        line, fields = record.line, record.fields
        if not fields:
            return
        try:
            name, quantity, kind = (self._text(fields, column, default) for column, default in _DEFAULTS.items())
            time, value = self._times(fields)
            MeasuredKind(kind)
        except (ValueError, IndexError):
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
        known = self.columns.get(column)
        text = fields[known.place] if known is not None else default
        if not text:
            raise ValueError(column)
        return original_text(text)

    def _times(self, fields: list[str]) -> tuple[int | None, int]:
        """When the value was complete, if that is known, and the value."""
        if "value" in self.columns:
            return (self._time(fields, "time") if "time" in self.columns else None), self._time(fields, "value")
        start, end = self._time(fields, "start"), self._time(fields, "end")
        return end, end - start

    def _time(self, fields: list[str], column: str) -> int:
        time = self.columns[column].of(fields)
        if abs(time) > LARGEST:
            raise ValueError(column)
        return round(time)

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
