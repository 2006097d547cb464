"""Which column of a table is which quantity, and the unit of its values: `--column "rtt_ms=round-trip"`.

A quantity may be the difference of two columns with time stamps: `--column "reply_ns - request_ns=round-trip"`.
"""

from __future__ import annotations

import re
from typing import Final

from amalthea_uros._internal.records import dataclass
from amalthea_uros.measure.series import WHOLE_TIME
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.units import MICROSECOND, MILLISECOND, NANOSECOND, SECOND, Time

#: How a column is written.
FORM: Final = "COLUMN[ - COLUMN]=OBJECT[.QUANTITY]"
#: How it is written which rows have values.
VALID_FORM: Final = "COLUMN=VALUE[,VALUE]"
UNITS: Final = {"ps": 1, "ns": NANOSECOND, "us": MICROSECOND, "µs": MICROSECOND, "ms": MILLISECOND, "s": SECOND}
#: Larger times do not fit into the columns of a measurement.
LARGEST: Final = 2**62
#: A header that ends in a unit: `rtt_ms`, `rtt ms`, `rtt (ms)`, `rtt [ms]`.
_HEADER = re.compile(rf".*[_ (\[]({'|'.join(UNITS)})[)\]]?")
_MINUS = " - "


@dataclass(frozen=True, slots=True)
class TableColumn:
    """A quantity of a table.

    Attributes
    ----------
    column : with the values, or with the time stamps of their ends
    start : with the time stamps of their starts; None for values
    """

    column: str
    start: str | None
    object: str
    quantity: str = WHOLE_TIME

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns of the table that it needs."""
        return (self.column,) if self.start is None else (self.column, self.start)

    def __str__(self) -> str:
        return _MINUS.join(self.columns)


@dataclass(frozen=True, slots=True)
class ValidRows:
    """The rows that have values: those with one of these texts in a column; in the others, what was sent is lost."""

    column: str
    texts: tuple[str, ...]


#: A table with a column of this name says so itself.
USUAL_ROWS: Final = ValidRows("status", ("ok",))


def parse_column(text: str) -> TableColumn:
    """A quantity as it is written.

    >>> parse_column("rtt_ms=round-trip")
    TableColumn(column='rtt_ms', start=None, object='round-trip', quantity='time')

    Raises
    ------
    ValueError : the text has another form.
    """
    columns, equals, meant = (part.strip() for part in text.rpartition("="))
    names = [each.strip() for each in columns.split(_MINUS)]
    if not (equals and meant and all(names) and len(names) <= 2):
        raise ValueError(f"{text!r} is not of the form {FORM}; an example: 'rtt_ms=round-trip'")
    name, _, quantity = meant.rpartition(".")
    is_quantity = bool(name) and quantity in (*JobMetric, *ChainQuantity)
    known = (name, quantity) if is_quantity else (meant, WHOLE_TIME)
    return TableColumn(names[0], names[1] if names[1:] else None, *known)


def parse_valid_rows(text: str) -> ValidRows:
    """Which rows have values, as it is written.

    Raises
    ------
    ValueError : the text has another form.
    """
    column, equals, texts = text.partition("=")
    if not (column.strip() and equals):
        raise ValueError(f"{text!r} is not of the form {VALID_FORM}; an example: 'status=ok'")
    return ValidRows(column.strip(), tuple(each.strip() for each in texts.split(",")))


def parse_unit(text: str) -> Time:
    """The picoseconds of a unit.

    Raises
    ------
    ValueError : it is none.
    """
    if text not in UNITS:
        raise ValueError(f"{text!r} is not a unit of times; expected one of {', '.join(UNITS)}")
    return UNITS[text]


def unit_of(header: str) -> Time | None:
    """The picoseconds of the unit that the header of a column names; None if it names none."""
    match = _HEADER.fullmatch(header)
    return None if match is None else UNITS[match[1]]
