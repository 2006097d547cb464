"""Times, frequencies, data sizes and bit rates, as exact numbers and as text.

Internally a time is a whole number of picoseconds, a data size of bits, a bit rate of bits per second, and a frequency an exact
fraction in hertz (a third of a megahertz is not a whole number of hertz). Text always has a unit: "10 ms", "250 kbit/s", "4 B".
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from decimal import MAX_EMAX, ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal
from enum import StrEnum
from fractions import Fraction
from functools import lru_cache
from math import ceil, floor
from typing import Generic, NamedTuple, Self, TypeAlias, TypeVar

from amalthea_uros._internal.records import dataclass

#: Picoseconds.
Time: TypeAlias = int
#: Hertz.
Frequency: TypeAlias = Fraction
#: Bits.
DataSize: TypeAlias = int
#: Bits per second.
BitRate: TypeAlias = int

#: A number: a time, a demand, a count.
N_co = TypeVar("N_co", int, Fraction, float, covariant=True)


@dataclass(frozen=True, slots=True)
class OpenInterval(Generic[N_co]):
    """Bounds of a value whose upper bound may be unknown (None)."""

    lower: N_co
    upper: N_co | None


@dataclass(frozen=True, slots=True)
class Interval(OpenInterval[N_co]):
    """Bounds of a value: the lower and the upper one, both known, in the unit of the value."""

    upper: N_co


@dataclass(frozen=True, slots=True, order=True)
class Duration:
    """A time that is more than a number: it cannot be taken for one of another unit.

    >>> print(Duration.of("1.5 ms") + Duration.of("250 us"), Duration(time=20_000) * 2)
    1.75 ms 40 ns

    Attributes
    ----------
    time : whole picoseconds, as results have them
    """

    time: Time

    def __post_init__(self) -> None:
        if isinstance(self.time, str):
            raise TypeError(f"a Duration is made of whole picoseconds; write Duration.of({self.time!r})")

    @classmethod
    def of(cls, text: str) -> Self:
        """The time of a text such as "10 ms"; ValueError as for `parse`."""
        return cls(parse_time(text))

    def __add__(self, other: Duration) -> Duration:
        return Duration(self.time + other.time)

    def __sub__(self, other: Duration) -> Duration:
        return Duration(self.time - other.time)

    def __mul__(self, factor: int) -> Duration:
        return Duration(self.time * factor)

    __rmul__ = __mul__

    def __str__(self) -> str:
        return time_text(self.time)


PICOSECOND: Time = 1
NANOSECOND: Time = 1000 * PICOSECOND
MICROSECOND: Time = 1000 * NANOSECOND
MILLISECOND: Time = 1000 * MICROSECOND
SECOND: Time = 1000 * MILLISECOND
HOUR: Time = 3600 * SECOND

_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,3})?"
_QUANTITY = re.compile(rf"\s*({_NUMBER})\s*((?:[^\s\d.,:+-]\S*)?)\s*", re.ASCII)
_COMMA = re.compile(r"\s*[+-]?\d+(?:,\d+)+(?:\.\d*)?\s*[^\s\d]*\s*", re.ASCII)
_LONGEST_NUMBER = 40
#: Longer texts are no quantities; to match them could take a time that grows with the square of the length.
_LONGEST_QUANTITY = 200
#: Quantities fit into 64 bits, so that arrays can hold them: times up to 106 days.
_LIMIT = 2**63


def _data_units(suffix: str = "") -> dict[str, int]:
    """Bytes and bits with decimal and binary prefixes: unit -> bits."""
    found = {}
    for symbol, bits in (("B", 8), ("bit", 1)):
        found[symbol + suffix] = bits
        for power, letter in enumerate("kMGT", start=1):
            found[f"{letter}{symbol}{suffix}"] = bits * 1000**power
            found[f"{letter.upper()}i{symbol}{suffix}"] = bits * 1024**power
    return found


class Dimension(NamedTuple):
    """A kind of quantity.

    Attributes
    ----------
    article : its name with the article, for messages
    units : unit -> its size in the internal unit
    example : a value
    whole : plural of the internal unit if values are whole numbers of it, else ""
    least : the smallest value besides zero
    """

    article: str
    units: Mapping[str, int]
    example: str
    whole: str = ""
    least: Fraction = Fraction(0)


TIME = Dimension(
    "a time",
    {
        "ps": PICOSECOND,
        "ns": NANOSECOND,
        "us": MICROSECOND,
        "µs": MICROSECOND,  # U+00B5, on keyboards
        "μs": MICROSECOND,  # U+03BC, to which Unicode normalises it
        "ms": MILLISECOND,
        "s": SECOND,
        "min": 60 * SECOND,
        "h": HOUR,
    },
    "10 ms",
    "picoseconds",
)
#: The period of the lowest frequency is the longest time.
FREQUENCY = Dimension(
    "a frequency", {"Hz": 1, "kHz": 10**3, "MHz": 10**6, "GHz": 10**9}, "50 Hz", least=Fraction(SECOND, _LIMIT - 1)
)
DATA_SIZE = Dimension("a data size", _data_units(), "4 B", "bits")
BIT_RATE = Dimension("a bit rate", _data_units("/s"), "250 kbit/s", "bits per second")


def parse(text: str, dimension: Dimension) -> Fraction:
    """The value of a text such as "10 ms", in the internal unit; exact.

    Raises
    ------
    ValueError : no number, no unit, an unknown unit, out of range, or not a whole number of the internal unit.
    """
    is_short = len(text) <= _LONGEST_QUANTITY
    if is_short and _COMMA.fullmatch(text):
        raise ValueError(f"{shortened(text)!r} contains a comma; write decimals with a point and no separators for thousands")
    match = _QUANTITY.fullmatch(text) if is_short else None
    if match is None or len(match[1]) > _LONGEST_NUMBER:
        raise ValueError(f"{shortened(text)!r} is not {dimension.article} such as {dimension.example!r}")
    number, unit = match.groups()
    if not unit:
        raise ValueError(f"{text.strip()!r} has no unit; write {dimension.article} such as {dimension.example!r}")
    if unit not in dimension.units:
        raise ValueError(f"{shortened(unit)!r} is not a unit of {dimension.article.split(' ', 1)[1]}{_advice(unit, dimension)}")
    value = Fraction(number) * dimension.units[unit]
    if abs(value) >= _LIMIT or 0 < abs(value) < dimension.least:
        raise ValueError(f"{text.strip()!r} is out of range")
    if dimension.whole and value.denominator != 1:
        raise ValueError(f"{text.strip()!r} is not a whole number of {dimension.whole}")
    return value


#: Units of time that people write, and the ones that are meant.
_OTHER_TIMES = {
    **dict.fromkeys(("m",), "'min' for minutes, or 'ms' for milliseconds"),
    **dict.fromkeys(("mins", "minute", "minutes"), "'min'"),
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "'s'"),
    **dict.fromkeys(("hr", "hrs", "hour", "hours"), "'h'"),
    **dict.fromkeys(("msec", "millis", "milliseconds"), "'ms'"),
    **dict.fromkeys(("usec", "micros", "microseconds"), "'us'"),
    **dict.fromkeys(("nsec", "nanoseconds"), "'ns'"),
    **dict.fromkeys(("d", "day", "days"), "hours, e.g. '24 h'"),
}


def _advice(unit: str, dimension: Dimension) -> str:
    from difflib import get_close_matches  # only after a mistake

    if dimension is TIME and unit.lower() in _OTHER_TIMES:
        return f"; write {_OTHER_TIMES[unit.lower()]}"
    folded = {known.lower(): known for known in dimension.units}
    near = folded.get(unit.lower()) or next(iter(get_close_matches(unit, dimension.units, n=1)), None)
    return f", did you mean {near!r}?" if near else f"; known units: {', '.join(dimension.units)}"


def shortened(text: str, length: int = 40) -> str:
    """The text, or its start if it is long."""
    return text if len(text) <= length else f"{text[:length]}..."


@lru_cache(maxsize=1024)
def parse_time(text: str) -> Time:
    """Picoseconds of a text such as "10 ms"; ValueError as for `parse`."""
    return int(parse(text, TIME))


def parse_duration(text: str) -> Time:
    """Picoseconds of a time that is greater than zero; ValueError as for `parse`, or if it is not."""
    duration = parse_time(text)
    if duration <= 0:
        raise ValueError("a duration must be greater than zero")
    return duration


def parse_frequency(text: str) -> Frequency:
    """Hertz of a text such as "300 MHz"; ValueError as for `parse`."""
    return parse(text, FREQUENCY)


def parse_data_size(text: str) -> DataSize:
    """Bits of a text such as "4 B"; ValueError as for `parse`."""
    return int(parse(text, DATA_SIZE))


def parse_bit_rate(text: str) -> BitRate:
    """Bits per second of a text such as "250 kbit/s"; ValueError as for `parse`."""
    return int(parse(text, BIT_RATE))


#: Units for output, largest first.
_TIME_STEPS = (("s", SECOND), ("ms", MILLISECOND), ("us", MICROSECOND), ("ns", NANOSECOND), ("ps", PICOSECOND))
_FREQUENCY_STEPS = (("GHz", 10**9), ("MHz", 10**6), ("kHz", 10**3), ("Hz", 1))
_BIT_RATE_STEPS = (("Gbit/s", 10**9), ("Mbit/s", 10**6), ("kbit/s", 10**3), ("bit/s", 1))
_DATA_STEPS = tuple((unit, DATA_SIZE.units[unit]) for unit in ("GiB", "GB", "MiB", "MB", "KiB", "kB", "B", "bit"))


_TWELVE_DIGITS = Context(prec=12, Emax=MAX_EMAX)


class Rounding(StrEnum):
    """How a value loses digits: a bound must stay one, so that upper bounds are rounded up, and lower ones down."""

    UP = ROUND_CEILING
    DOWN = ROUND_FLOOR
    NEAREST = ROUND_HALF_EVEN


#: Whole numbers from here on are shortened to twelve digits.
_SHORTENED = 10**12


def number_text(number: int | Fraction) -> str:
    """A number with at most twelve significant digits, also beyond the range of `float`: "2.5", "1e+20"."""
    quotient = _TWELVE_DIGITS.divide(Decimal(number.numerator), Decimal(number.denominator))
    value = _TWELVE_DIGITS.normalize(quotient)
    return f"{value:f}" if -7 < value.adjusted() < 12 else f"{value:g}"


def _steps_text(value: int | Fraction, steps: tuple[tuple[str, int], ...]) -> str:
    """The value in the largest unit in which it is at least 1."""
    exact = value if isinstance(value, int) else Fraction(value)
    unit, size = _step(exact, steps)
    whole, rest = divmod(exact.numerator, size * exact.denominator)
    if not rest and abs(whole) < _SHORTENED:
        return f"{whole} {unit}"
    return f"{number_text(Fraction(exact) / size)} {unit}"


def _step(value: int | Fraction, steps: tuple[tuple[str, int], ...]) -> tuple[str, int]:
    """The largest unit in which a value is at least 1; compared as whole numbers, which takes a tenth of the time of fractions."""
    magnitude, parts = abs(value.numerator), value.denominator
    return next((step for step in steps if magnitude >= step[1] * parts), steps[-1])


def time_text(value: Time | Fraction) -> str:
    """A time for people: "12 us", "16.65 us", "0 s"."""
    return _steps_text(value, _TIME_STEPS) if value else "0 s"


#: Significant digits of times in tables.
_DIGITS = 4


@lru_cache(maxsize=1 << 14)
def rounded_time_text(value: Time | Fraction, rounding: Rounding, limit: Time | Fraction | None = None) -> str:
    """A time for tables: whole numbers of its unit as they are, others with four significant digits, or without decimals.

    Parameters
    ----------
    limit : what the time is compared with: it has as many digits as it takes to be on the same side of it

    >>> rounded_time_text(20_029 * MICROSECOND, Rounding.UP), rounded_time_text(20_029 * MICROSECOND, Rounding.DOWN)
    ('20.03 ms', '20.02 ms')
    >>> rounded_time_text(12_345 * SECOND, Rounding.UP)
    '12345 s'
    >>> rounded_time_text(12_344_900 * NANOSECOND, Rounding.UP, limit=12_345 * MICROSECOND)
    '12.3449 ms'
    """
    exact = value if isinstance(value, int) else Fraction(value)
    _, size = _step(exact, _TIME_STEPS)
    if exact.denominator == 1 and exact.numerator % size == 0:
        return time_text(value)
    return time_text(rounded(Fraction(exact) / size, rounding, None if limit is None else Fraction(limit) / size) * size)


def rounded(value: Fraction, rounding: Rounding, limit: int | Fraction | None = None) -> Fraction:
    """A number with four significant digits, or without decimals; `limit` as for `rounded_time_text`."""
    digits = max(_DIGITS, len(str(int(abs(value)))))
    found = _with_digits(value, rounding, digits)
    while limit is not None and _side(found, limit) != _side(value, limit):
        digits += 1
        found = value if value == limit else _with_digits(value, rounding, digits)
    return found


def percent_text(share: Fraction | float, decimals: int, rounding: Rounding = Rounding.NEAREST) -> str:
    """A share in percent with some decimals, and with more of them where it takes more to be on its side of 100.

    >>> percent_text(Fraction(11, 10), 1), percent_text(Fraction(10_001, 10_000), 1)
    ('110.0', '100.01')
    """
    exact = Fraction(share) * 100
    found = _with_decimals(exact, decimals, rounding)
    while _side(found, 100) != _side(exact, 100):
        decimals += 1
        found = _with_decimals(exact, decimals, rounding)
    return f"{float(found):.{decimals}f}"


def _with_decimals(value: Fraction, decimals: int, rounding: Rounding) -> Fraction:
    whole = value * 10**decimals
    number = ceil(whole) if rounding is Rounding.UP else floor(whole) if rounding is Rounding.DOWN else round(whole)
    return Fraction(number, 10**decimals)


def _with_digits(value: Fraction, rounding: Rounding, digits: int) -> Fraction:
    context = Context(prec=digits, rounding=rounding, Emax=MAX_EMAX)
    return Fraction(context.divide(Decimal(value.numerator), Decimal(value.denominator)))


def _side(value: Fraction, limit: int | Fraction) -> tuple[bool, bool]:
    return value < limit, value > limit


def frequency_text(value: Frequency) -> str:
    """A frequency for people: "300 MHz"."""
    return _steps_text(value, _FREQUENCY_STEPS)


def bit_rate_text(value: BitRate) -> str:
    """A bit rate in the largest unit of which it has at least one: "250 kbit/s"."""
    return _steps_text(value, _BIT_RATE_STEPS)


def data_size_text(value: DataSize) -> str:
    """A data size for people, in the largest unit that needs no decimals: "240 KiB", "4 B"."""
    unit, size = next(step for step in _DATA_STEPS if (value and value % step[1] == 0) or step[1] == 1)
    return f"{number_text(value // size)} {unit}" if value else "0 B"


def ticks_of_time(time: Time, frequency: Frequency) -> Fraction:
    """The number of clock ticks in a time; exact, so that the caller decides how to round."""
    return Fraction(time) * frequency / SECOND


def time_of_ticks(ticks: int | Fraction, frequency: Frequency) -> Fraction:
    """The picoseconds that a number of ticks takes; exact, so that the caller decides how to round."""
    return Fraction(ticks) * SECOND / frequency


def up(value: Fraction) -> int:
    """Rounded towards a safe upper bound."""
    return ceil(value)


def down(value: Fraction) -> int:
    """Rounded towards a safe lower bound."""
    return floor(value)
