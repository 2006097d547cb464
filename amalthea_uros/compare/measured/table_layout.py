"""Where a table has what is read of it: the places of its columns, and their units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal
from functools import cached_property
from pathlib import Path

from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.compare.measured.columns import UNITS, USUAL_ROWS, TableColumn, ValidRows, unit_of
from amalthea_uros.compare.measured.records import Record
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.names import listed
from amalthea_uros.units import Time

#: The column with the time at which a value was complete, before its unit.
_TIME = "time_"


@dataclass(frozen=True, slots=True)
class TimesColumn:
    """A column with times: its place, and the picoseconds of its unit."""

    place: int
    unit: Time

    def of(self, fields: Sequence[str]) -> Decimal:
        """The time of a row in picoseconds, which may be one since 1970.

        Raises
        ------
        ValueError : the row has no finite number there.
        """
        try:
            time = Decimal(fields[self.place]) * self.unit
        except (ArithmeticError, IndexError):
            raise ValueError from None
        if not time.is_finite():
            raise ValueError
        return time


@dataclass(frozen=True, slots=True)
class TableLayout:
    """The columns of a table that are read.

    Attributes
    ----------
    starts : None for a column with values
    status : the place of the column that says whether a row has values; None if all have
    time : when a row was complete; None if no column says it
    """

    columns: tuple[TableColumn, ...]
    ends: tuple[TimesColumn, ...]
    starts: tuple[TimesColumn | None, ...]
    status: int | None
    valid: ValidRows
    time: TimesColumn | None


@dataclass(frozen=True)
class HeaderColumns:
    """The columns of a header."""

    path: Path
    header: Record

    @cached_property
    def _places(self) -> Mapping[str, Sequence[int]]:
        """The places of each name: more than one for equal names."""
        places: dict[str, list[int]] = {}
        for place, name in enumerate(self.header.fields):
            places.setdefault(name, []).append(place)
        return places

    def of(self, columns: Sequence[TableColumn], valid: ValidRows | None, unit: Time | None) -> TableLayout:
        """The layout of the table.

        Raises
        ------
        ReadError : a column is absent or there twice, or its unit is not known or contradicts the header.
        """
        names = self.header.fields
        times = [name for name in names if name.startswith(_TIME) and name.removeprefix(_TIME) in UNITS]
        rows = valid or USUAL_ROWS
        self._refuse_other_unit([name for each in columns for name in each.columns], unit)
        return TableLayout(
            columns=tuple(columns),
            ends=tuple(self._time(each.column, unit) for each in columns),
            starts=tuple(None if each.start is None else self._time(each.start, unit) for each in columns),
            status=self._place(rows.column) if valid is not None or rows.column in names else None,
            valid=rows,
            time=self._time(times[0], unit) if times else None,
        )

    def _place(self, name: str) -> int:
        places = self._places.get(name, ())
        if len(places) > 1:
            message = f"the table has {len(places)} columns {name!r}, and which one is meant is not known"
            raise self._error(message, "Give each column a name of its own.")
        if places:
            return places[0]
        names = self.header.fields
        what = f"it has {listed(names)}" if names else "its header is empty"
        advice = did_you_mean(name, dict.fromkeys(names)) or "name a column of the header with --column"
        raise self._error(f"the table has no column {name!r}; {what}", f"{advice[:1].upper()}{advice[1:]}")

    def _time(self, name: str, unit: Time | None) -> TimesColumn:
        place, own = self._place(name), unit_of(name) or unit
        if own is None:
            raise self._error(f"the header {name!r} names no unit of its times", "Say it with --unit, e.g. --unit ms.")
        return TimesColumn(place, own)

    def _refuse_other_unit(self, names: Sequence[str], unit: Time | None) -> None:
        """Refuse a unit that is of no column, and another one than a header names: one of both is wrong."""
        own = {name: unit_of(name) for name in names}
        others = [name for name, each in own.items() if each != unit]
        if unit is not None and others and None not in own.values():
            message = f"the header {others[0]!r} names another unit than --unit"
            raise self._error(message, "Omit --unit, or correct the header.")

    def _error(self, message: str, advice: str) -> ReadError:
        place = Location(self.path, self.header.line, 1, ",".join(self.header.fields))
        return ReadError([Finding("MEA016", Severity.ERROR, message, place, advice)])
