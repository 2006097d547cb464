"""Values of attributes as text, and back, as EMF writes and reads them (Java's number formats)."""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Callable
from typing import Any, NamedTuple

from amalthea_uros.metamodel.defaults import enum_class
from amalthea_uros.metamodel.versions import VersionFacts


class DataType(NamedTuple):
    """How the values of an Ecore data type are written.

    Attributes
    ----------
    python_type : what a value is an instance of
    parse : text -> value; raises ValueError
    format : value -> text
    """

    python_type: type
    parse: Callable[[str], Any]
    format: Callable[[Any], str]


def parse_boolean(text: str) -> bool:
    """`true` or `false`, in any case like `Boolean.parseBoolean`, but nothing else."""
    lowered = text.strip().lower()
    if lowered not in ("true", "false"):
        raise ValueError(f"{text!r} is neither true nor false")
    return lowered == "true"


def format_boolean(value: bool) -> str:
    """`true` or `false`."""
    return "true" if value else "false"


_DECIMAL = re.compile(r"[+-]?[0-9]+").fullmatch


def parse_integer(text: str) -> int:
    """Decimal with an optional sign."""
    if text.isdigit() and text.isascii():
        return int(text)
    if not _DECIMAL(text.strip()):
        raise ValueError(f"{text!r} is not a whole number")
    return int(text)


_ADDRESS = re.compile(r"(?:0[xX]|#)(?P<hex>[0-9a-fA-F]+)|0(?P<octal>[0-7]+)|(?P<decimal>0|[1-9][0-9]*)").fullmatch


def parse_address(text: str) -> int:
    """Unsigned `0x1f`, `#1f`, octal `017` or decimal, like `java.lang.Long.decode`."""
    match = _ADDRESS(text.strip())
    if not match:
        raise ValueError(f"{text!r} is not an address: expected a hexadecimal (0x1f) or decimal number without a sign")
    if match["hex"]:
        return int(match["hex"], 16)
    return int(match["octal"], 8) if match["octal"] else int(match["decimal"])


_FLOATING = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]+)?[dDfF]?").fullmatch
_SPECIAL = {"NaN": math.nan, "Infinity": math.inf, "+Infinity": math.inf, "-Infinity": -math.inf}


def parse_float(text: str) -> float:
    """What `java.lang.Double.valueOf` accepts, except hexadecimal floating point."""
    text = text.strip()
    if text in _SPECIAL:
        return _SPECIAL[text]
    if not _FLOATING(text):
        raise ValueError(f"{text!r} is not a number")
    return float(text.rstrip("dDfF"))


def format_double(value: float) -> str:
    """`java.lang.Double.toString`: plain between 1e-3 and 1e7, else scientific, always with a fraction digit.

    >>> format_double(20348070.0), format_double(0.0005), format_double(80000)
    ('2.034807E7', '5.0E-4', '80000.0')
    """
    return _format_java(value, repr(float(value)))


def format_float(value: float) -> str:
    """`java.lang.Float.toString`: the fewest digits that give the same 32-bit number."""
    rounded = _single(value)
    if not math.isfinite(rounded):
        return _format_java(rounded, "")
    digits = next(d for d in (f"{rounded:.{n}e}" for n in range(9)) if _single(float(d)) == rounded)
    return _format_java(rounded, digits)


def _single(value: float) -> float:
    """The nearest 32-bit number, infinite if it is too large for one."""
    try:
        return float(struct.unpack("f", struct.pack("f", value))[0])
    except OverflowError:
        return math.copysign(math.inf, value)


def _format_java(value: float, decimal: str) -> str:
    """Lay out the shortest decimal of a number as Java does."""
    if math.isnan(value):
        return "NaN"
    if math.isinf(value):
        return "Infinity" if value > 0 else "-Infinity"
    if value == 0:
        return "-0.0" if math.copysign(1, value) < 0 else "0.0"
    sign = "-" if value < 0 else ""
    mantissa, _, exponent_text = decimal.lstrip("-").partition("e")
    whole, _, fraction = mantissa.partition(".")
    digits = (whole + fraction).lstrip("0")
    exponent = int(exponent_text or 0) + len(whole) - 1 - (len(whole + fraction) - len(digits))
    digits = digits.rstrip("0")
    if -3 <= exponent < 7:
        if exponent < 0:
            return f"{sign}0.{'0' * (-exponent - 1)}{digits}"
        digits = digits.ljust(exponent + 2, "0")
        return f"{sign}{digits[: exponent + 1]}.{digits[exponent + 1 :]}"
    return f"{sign}{digits[0]}.{digits[1:] or '0'}E{exponent}"


_INTEGER = DataType(int, parse_integer, str)
_DOUBLE = DataType(float, parse_float, format_double)

_DATA_TYPES = {
    "EString": DataType(str, str, str),
    "EBoolean": DataType(bool, parse_boolean, format_boolean),
    "EInt": _INTEGER,
    "ELong": _INTEGER,
    "EBigInteger": _INTEGER,
    "EIntegerObject": _INTEGER,
    "ELongObject": _INTEGER,
    "Address": DataType(int, parse_address, lambda value: f"0x{value:x}"),
    "EDouble": _DOUBLE,
    "EDoubleObject": _DOUBLE,
    "EFloat": DataType(float, parse_float, format_float),
}


class ValueCache(dict[str, Any]):
    """Parsed values by text: a model has thousands of values, but few different ones."""

    #: Once full, new texts are parsed each time: a cache that rarely hits is not worth its memory.
    MAX_ENTRIES = 1_000

    def __init__(self, parse: Callable[[str], Any]) -> None:
        super().__init__()
        self._parse = parse

    def __missing__(self, text: str) -> Any:
        value = self._parse(text)
        if len(self) < self.MAX_ENTRIES:
            self[text] = value
        return value


def data_type_of(declared: VersionFacts, type_name: str) -> DataType:
    """The data type of an Ecore type in one AMALTHEA version."""
    if type_name in declared.enums:
        return _enumeration(declared, type_name)
    number = declared.numbers.get(type_name)
    if number is None or type_name in _DATA_TYPES:
        return _DATA_TYPES[type_name]
    return _DOUBLE if number.java_type == "double" else _INTEGER


def _enumeration(declared: VersionFacts, type_name: str) -> DataType:
    enum = enum_class(type_name)
    members = {literal: enum(literal) for literal in declared.enums[type_name].literals}

    def parse(text: str) -> Any:
        member = members.get(text)
        if member is None:
            raise ValueError(f"{text!r} is not one of {', '.join(literal for literal in members if literal[0] != '_')}")
        return member

    return DataType(enum, parse, str)
