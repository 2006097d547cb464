"""Tables with a column for each quantity, such as those that a benchmark on the host writes: a row for each value.

A row without a value, or that the table itself marks as failed, is one that was lost: it is counted, and never left out in silence.
"""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Iterator, Sequence
from decimal import Decimal
from pathlib import Path

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.compare.measured.columns import LARGEST, TableColumn, ValidRows
from amalthea_uros.compare.measured.records import Record, read_records
from amalthea_uros.compare.measured.table_layout import HeaderColumns, TableLayout
from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.series import Counts, MeasuredKind, Measurement, Series, statistics_or_none
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.trace.files import TracePlace, TraceProblems, opened_text
from amalthea_uros.units import Time

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
    ReadError : the file cannot be read, has no such column, or several of its name; or its unit is not known.
    InvalidArgumentError : two columns are the same quantity, or a part is to be measured of a table without times.
    """
    for (name, quantity), count in Counter((each.object, each.quantity) for each in columns).items():
        if count > 1:
            raise InvalidArgumentError(f"two columns are the {quantity.replace('_', ' ')} of {name!r}; leave one of them out")
    problems = TraceProblems(path)
    table: _TableOfValues | None = None
    with opened_text(path, problems) as lines:
        records = read_records(lines, problems)
        header = next(records, Record(1, []))
        table = _TableOfValues(problems, HeaderColumns(path, header).of(columns, valid, unit), window)
        if not table.has_times:
            window.refuse_part(path.name)
        for record in records:
            table.add(record)
    return Measurement(
        source=str(path),
        format="table",
        # The begin of a damaged file may not even have a header.
        duration=0 if table is None else table.duration,
        series=() if table is None else tuple(table.series()),
        findings=problems.findings,
    )


def _is_empty(fields: Sequence[str], place: int) -> bool:
    """Whether a row has no value at a place."""
    return place >= len(fields) or fields[place].lower() in _EMPTY


@dataclass(slots=True)
class _TableOfValues:
    """The values of the columns, and how many rows have none."""

    problems: TraceProblems
    layout: TableLayout
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
    def has_times(self) -> bool:
        """Whether the table says when its values were complete."""
        return self.layout.time is not None or any(self.layout.starts)

    @property
    def duration(self) -> Time:
        """From the first time to the last one; 0 if the table has none."""
        return 0 if self._first is None else int(self._last - self._first)

    def add(self, record: Record) -> None:
        """Take a row."""
        if not record.fields:
            self._lose(record.rows)
            return
        try:
            time = self._time(record)
        except ValueError:
            self._lose()
            self._wrong(record, "a row has no time; it counts as lost")
            return
        if time is not None and not self.window.contains(time):
            return
        cause = self._failure(record.fields)
        if cause:
            self._lose()
            self._note_loss(record, cause)
            return
        for number, column in enumerate(self.layout.columns):
            self._add_value(number, column, record, time)

    def _lose(self, rows: int = 1) -> None:
        """Count rows that have no value in any column."""
        self._lost = [lost + rows for lost in self._lost]

    def _time(self, record: Record) -> Time | None:
        """When a row was complete, from the first row on; None if that is not known.

        Raises
        ------
        ValueError : it has no time.
        """
        known = self.layout.time or next(
            (end for end, start in zip(self.layout.ends, self.layout.starts, strict=True) if start), None
        )
        if known is None:
            return None
        if known is not self.layout.time and _is_empty(record.fields, known.place):
            return None
        moment = known.of(record.fields)
        first = moment if self._first is None else self._first
        if abs(moment - first) > LARGEST:
            raise ValueError
        self._last = moment if self._first is None else max(self._last, moment)
        self._first = first
        return int(moment - first)

    def _failure(self, fields: Sequence[str]) -> str:
        """The mark that the table itself gives a row without a value, "" of one with a value."""
        place, valid = self.layout.status, self.layout.valid
        if place is None:
            return ""
        text = fields[place] if place < len(fields) else ""
        return "" if text in valid.texts else f"{valid.column} {text!r}"

    def _add_value(self, number: int, column: TableColumn, record: Record, time: Time | None) -> None:
        end, start = self.layout.ends[number], self.layout.starts[number]
        if any(_is_empty(record.fields, each.place) for each in (end, start) if each is not None):
            self._lost[number] += 1
            self._note_loss(record, f"no value in {column}")
            return
        try:
            value = end.of(record.fields) - (0 if start is None else start.of(record.fields))
        except ValueError:
            self._lost[number] += 1
            self._wrong(record, f"a row has no number in {column}; it counts as lost")
            return
        if not 0 <= value <= LARGEST:
            self._lost[number] += 1
            self._wrong(record, f"a row has a time in {column} that is negative or too large; it counts as lost")
            return
        self._values[number].append(int(value.to_integral_value()))
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
