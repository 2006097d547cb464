"""Tables with a column for each quantity, such as those that a benchmark on the host writes: a row for each value.

A row without a value, or that the table itself marks as failed, is one that was lost: it is counted, and never left out in silence.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from decimal import Decimal, InvalidOperation
from pathlib import Path

from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.compare.measured.columns import UNITS, USUAL_ROWS, TableColumn, ValidRows, unit_of
from amalthea_uros.compare.measured.records import Record, read_records
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.measure.series import Counts, MeasuredKind, Measurement, Series, statistics_or_none
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.names import listed
from amalthea_uros.trace.files import TracePlace, TraceProblems, opened_text
from amalthea_uros.units import Time

#: The column with the time at which a value was complete, before its unit.
_TIME = "time_"
#: Larger times do not fit into the columns.
_LARGEST = 2**62
#: What stands for no value.
_EMPTY = ("", "nan", "null", "none", "-", "inf", "-inf", "infinity")
#: So many different texts that mark lost rows are reported on their own.
_MOST_CAUSES = 5


def measured_table(
    path: Path, columns: Sequence[TableColumn], valid: ValidRows | None, unit: Time | None, window: MeasurementWindow
) -> Measurement:
    """Read the quantities of a table.

    Parameters
    ----------
    valid : which rows have values; None: those with the status "ok", if the table has a column of that name
    unit : of the columns whose header names none

    Raises
    ------
    ReadError : the file cannot be read, or has no such column; or its unit is not known.
    InvalidArgumentError : two columns are the same quantity.
    """
    meant = [(each.object, each.quantity) for each in columns]
    for name, quantity in meant:
        if meant.count((name, quantity)) > 1:
            raise InvalidArgumentError(f"two columns are the {quantity.replace('_', ' ')} of {name!r}; leave one of them out")
    problems = TraceProblems(path)
    with opened_text(path, problems) as lines:
        records = read_records(lines, problems)
        header = next(records, Record(1, []))
        table = _Table(problems, _HeaderColumns(path, header).of(columns, valid, unit), window)
        for record in records:
            table.add(record)
    return Measurement(
        source=str(path),
        format="table",
        digest="",
        duration=table.duration,
        resolution=None,
        series=tuple(table.series()),
        findings=problems.findings,
    )


@dataclass(frozen=True, slots=True)
class _Time:
    """A column with times: its place, and the picoseconds of its unit."""

    place: int
    unit: Time

    def of(self, fields: Sequence[str]) -> Decimal:
        """The time of a row in picoseconds, which may be one since 1970."""
        return Decimal(fields[self.place]) * self.unit


@dataclass(frozen=True, slots=True)
class _TableLayout:
    """Where a table has what is read."""

    columns: tuple[TableColumn, ...]
    ends: tuple[_Time, ...]
    starts: tuple[_Time | None, ...]
    status: int | None
    valid: ValidRows
    time: _Time | None


@dataclass(frozen=True, slots=True)
class _HeaderColumns:
    """The columns of a header."""

    path: Path
    header: Record

    def of(self, columns: Sequence[TableColumn], valid: ValidRows | None, unit: Time | None) -> _TableLayout:
        names = self.header.fields
        times = [name for name in names if name.startswith(_TIME) and name.removeprefix(_TIME) in UNITS]
        rows = valid or USUAL_ROWS
        return _TableLayout(
            columns=tuple(columns),
            ends=tuple(self._time(each.column, unit) for each in columns),
            starts=tuple(None if each.start is None else self._time(each.start, unit) for each in columns),
            status=self._place(rows.column) if valid is not None or rows.column in names else None,
            valid=rows,
            time=self._time(times[0], unit) if times else None,
        )

    def _place(self, name: str) -> int:
        names = self.header.fields
        if name in names:
            return names.index(name)
        what = f"it has {listed(names)}" if names else "it is empty"
        advice = did_you_mean(name, dict.fromkeys(names)) or "name a column of the header with --column"
        raise self._error(f"the table has no column {name!r}; {what}", f"{advice[:1].upper()}{advice[1:]}")

    def _time(self, name: str, unit: Time | None) -> _Time:
        place, own = self._place(name), unit_of(name) or unit
        if own is None:
            raise self._error(f"the header {name!r} names no unit of its times", "Say it with --unit, e.g. --unit ms.")
        return _Time(place, own)

    def _error(self, message: str, advice: str) -> ReadError:
        place = Location(self.path, self.header.line, 1, ",".join(self.header.fields))
        return ReadError([Finding("MEA016", Severity.ERROR, message, place, advice)])


@dataclass(slots=True)
class _Table:
    """The values of the columns, and how many rows have none."""

    problems: TraceProblems
    layout: _TableLayout
    window: MeasurementWindow
    _values: list[array[int]] = field(init=False)
    _times: list[array[int]] = field(init=False)
    _lost: list[int] = field(init=False)
    _causes: set[str] = field(default_factory=set)
    _first: Decimal | None = None
    _last: Decimal = Decimal(0)

    def __post_init__(self) -> None:
        columns = self.layout.columns
        self._values, self._times = [array("q") for _ in columns], [array("q") for _ in columns]
        self._lost = [0] * len(columns)

    @property
    def duration(self) -> Time:
        """From the first time to the last one; 0 if the table has none."""
        return 0 if self._first is None else int(self._last - self._first)

    def add(self, record: Record) -> None:
        """Take a row."""
        try:
            time = self._time(record)
        except (ArithmeticError, IndexError):
            self._wrong(record, "a row has no time; it is ignored")
            return
        if time is not None and not self._is_in_window(time):
            return
        cause = self._failure(record.fields)
        for number, column in enumerate(self.layout.columns):
            if cause:
                self._lost[number] += 1
            else:
                self._add_value(number, column, record, time)
        if cause:
            self._note_loss(record, cause)

    def _time(self, record: Record) -> Time | None:
        """When a row was complete, from the first row on; None if that is not known."""
        known = self.layout.time or next(
            (end for end, start in zip(self.layout.ends, self.layout.starts, strict=True) if start), None
        )
        if known is None:
            return None
        if known is not self.layout.time and record.fields[known.place].lower() in _EMPTY:
            return None
        moment = known.of(record.fields)
        self._first = moment if self._first is None else self._first
        self._last = max(self._last, moment)
        return int(moment - self._first)

    def _is_in_window(self, time: Time) -> bool:
        return self.window.start <= time and (self.window.end is None or time < self.window.end)

    def _failure(self, fields: Sequence[str]) -> str:
        """The mark that the table itself gives a row without a value, "" of one with a value."""
        place, valid = self.layout.status, self.layout.valid
        if place is None:
            return ""
        text = fields[place] if place < len(fields) else ""
        return "" if text in valid.texts else f"{valid.column} {text!r}"

    def _add_value(self, number: int, column: TableColumn, record: Record, time: Time | None) -> None:
        end, start = self.layout.ends[number], self.layout.starts[number]
        places = [each.place for each in (end, start) if each is not None]
        if any(place >= len(record.fields) or record.fields[place].lower() in _EMPTY for place in places):
            self._lost[number] += 1
            self._note_loss(record, f"no value in {column}")
            return
        try:
            value = end.of(record.fields) - (0 if start is None else start.of(record.fields))
            picoseconds = int(value.to_integral_value())
        except (InvalidOperation, ValueError, OverflowError):
            self._lost[number] += 1
            self._wrong(record, f"a row has no number in {column}; it counts as lost")
            return
        if not 0 <= picoseconds <= _LARGEST:
            self._lost[number] += 1
            self._wrong(record, f"a row has a time in {column} that is negative or too large; it counts as lost")
            return
        self._values[number].append(picoseconds)
        if time is not None:
            self._times[number].append(time)

    def _note_loss(self, record: Record, cause: str) -> None:
        if cause not in self._causes and len(self._causes) >= _MOST_CAUSES:
            cause = "another cause"
        self._causes.add(cause)
        place = TracePlace(record.line, 1, ",".join(record.fields))
        message = f"a row with {cause} counts as lost: how long it would have taken is not known"
        self.problems.add(
            "MEA015", Severity.WARNING, message, place, "See the share of lost values before the maxima are used."
        )

    def _wrong(self, record: Record, message: str) -> None:
        self.problems.add("MEA009", Severity.ERROR, message, TracePlace(record.line, 1, ",".join(record.fields)))

    def series(self) -> Iterator[Series]:
        """The values of each column."""
        import numpy as np

        parts = zip(self.layout.columns, self._values, self._times, self._lost, strict=True)
        for column, column_values, times, lost in parts:
            values = np.array(column_values, np.int64)
            what = "difference of the columns" if column.start is not None else "column"
            yield Series(
                kind=MeasuredKind.INTERVAL,
                name=column.object,
                quantity=column.quantity,
                statistics=statistics_or_none(values),
                values=values,
                times=np.array(times, np.int64) if len(times) == len(values) else None,
                counts=Counts(lost=lost),
                method=f"{what} {column} of a table",
            )
