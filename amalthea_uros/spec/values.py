"""Single values of an `app.yaml`: names, quantities with units, and numbers."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from math import isfinite
from typing import Annotated, Any, Literal, TypeAlias

from amalthea_uros import units
from amalthea_uros.spec.fields import After, Before, EditorSchema, Limits, Meanings
from amalthea_uros.spec.section import DescriptionSection
from amalthea_uros.spec.type_checks import WrongValueError

#: In characters.
MAX_NAME_LENGTH = 200
_NAME_RULE = f"1 to {MAX_NAME_LENGTH} printable characters without leading or trailing blanks"
_GREATEST_IDENTIFIER = 2**29 - 1
#: In bits: the length of a payload of XRCE-DDS has two bytes.
_LONGEST_PAYLOAD = 8 * 2**16
_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d{1,3})?", re.ASCII)


def problem(message: str) -> WrongValueError:
    """The exception for a wrong value."""
    return WrongValueError("value", message)


def unexpected(message: str) -> WrongValueError:
    """The exception for a wrong value, which the message is to show."""
    return WrongValueError("unexpected", message)


def _quantity(parse: Callable[[str], Any], dimension: units.Dimension) -> Callable[[Any], Any]:
    def convert(value: Any) -> Any:
        if isinstance(value, bool) or not isinstance(value, str | int):
            raise unexpected(f"expected {dimension.article} such as {dimension.example!r}")
        try:
            return parse(str(value))
        except ValueError as error:
            raise problem(str(error)) from None

    return convert


def _with_unit(value: Any) -> Any:
    return "0 s" if value == 0 and isinstance(value, int) and not isinstance(value, bool) else value


def _positive(value: Any) -> Any:
    if value <= 0:
        raise unexpected("must be greater than zero")
    return value


def _not_negative(value: Any) -> Any:
    if value < 0:
        raise unexpected("must not be negative")
    return value


#: What a pattern has to find before a number, for values above zero, and for values of zero or more.
_ABOVE_ZERO = r"(?=[+]?[0-9.]*[1-9])[+]?"
_ZERO_OR_MORE = r"(?!-[0.]*[1-9])[-+]?"
_DIGITS = r"([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][-+]?[0-9]{1,3})?"


def _text_schema(dimension: units.Dimension, *, zero: bool = False, number_zero: bool = False) -> EditorSchema:
    """How editors check a quantity.

    Parameters
    ----------
    zero : whether it may be zero
    number_zero : whether it may be the number 0
    """
    pattern = f"^\\s*{_ZERO_OR_MORE if zero else _ABOVE_ZERO}{_DIGITS}\\s*({'|'.join(dimension.units)})\\s*$"
    bound = "of zero or more" if zero else "above zero"
    known = ", ".join(unit for unit in dimension.units if unit.isascii())
    number: dict[str, Any] = {"type": ["string", "integer"], "minimum": 0, "maximum": 0} if number_zero else {}
    return editor_schema(
        f"expected {dimension.article} {bound} with a unit such as {dimension.example!r}; units: {known}",
        # With the list of one type, because yaml-language-server would replace the message where a mapping is allowed, too.
        **({"type": ["string"]} | number),
        pattern=pattern,
        examples=[dimension.example],
    )


def editor_schema(problem: str, **schema: Any) -> EditorSchema:
    """A JSON schema with the message that yaml-language-server shows for whatever does not match it."""
    with_pattern = {"patternErrorMessage": problem} if "pattern" in schema else {}
    return EditorSchema({**schema, **with_pattern, "errorMessage": problem})


def described(**meanings: str) -> Meanings:
    """What editors say of each word of a choice; words with a hyphen are written with an underscore here."""
    return Meanings(meanings)


def _name(value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, str | int):
        raise unexpected("expected a name")
    text = str(value)
    if not text.strip() or text != text.strip() or len(text) > MAX_NAME_LENGTH or not text.isprintable():
        raise problem(f"{units.shortened(text)!r} is not a name; use {_NAME_RULE}")
    return text


def _number(value: Any) -> float:
    # Decimals are text until here, so that a name such as 1.10 keeps its zero.
    if isinstance(value, bool) or not (isinstance(value, int) or (isinstance(value, str) and _NUMBER.fullmatch(value))):
        raise unexpected("expected a number such as 1.5")
    number = float(value)
    if not isfinite(number):
        raise unexpected("out of range")
    return number


def _payload(bits: int) -> int:
    if bits > _LONGEST_PAYLOAD:
        raise unexpected("must not be greater than 64 KiB")
    return bits


def _whole_number(value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, int):
        raise unexpected("expected a whole number")
    return value


def _identifier(value: Any) -> Any:
    if isinstance(value, str) and value.startswith("0x"):
        try:
            value = int(value, 16)
        except ValueError:
            raise unexpected("expected a hexadecimal number such as 0x120") from None
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= _GREATEST_IDENTIFIER:
        raise unexpected(f"expected an identifier of up to 29 bits, 0 to {_GREATEST_IDENTIFIER:#x}")
    return value


_TIME = Before(_quantity(units.parse_time, units.TIME))
_FREQUENCY = Before(_quantity(units.parse_frequency, units.FREQUENCY))
_DATA_SIZE = Before(_quantity(units.parse_data_size, units.DATA_SIZE))
_BIT_RATE = Before(_quantity(units.parse_bit_rate, units.BIT_RATE))

#: How the values of quantities are written, by what reads them.
_TEXTS: tuple[tuple[Before, Callable[[Any], str]], ...] = (
    (_TIME, units.time_text),
    (_FREQUENCY, units.frequency_text),
    (_DATA_SIZE, units.data_size_text),
    (_BIT_RATE, units.bit_rate_text),
)


def quantity_text(marks: Iterable[Any]) -> Callable[[Any], str] | None:
    """How a value is written that has some marks of a type; None if it is no quantity with a unit."""
    every = list(marks)
    return next((text for validator, text in _TEXTS if any(validator is mark for mark in every)), None)


#: A time above zero, in picoseconds.
Duration: TypeAlias = Annotated[int, _TIME, After(_positive), _text_schema(units.TIME)]
#: A time of zero or more, in picoseconds.
Offset: TypeAlias = Annotated[int, _TIME, After(_not_negative), _text_schema(units.TIME, zero=True)]
#: The same, or the number 0, which needs no unit.
OffsetOrNumberZero: TypeAlias = Annotated[
    int,
    _TIME,
    Before(_with_unit),
    After(_not_negative),
    _text_schema(units.TIME, zero=True, number_zero=True),
]
#: A frequency above zero, in hertz.
Rate: TypeAlias = Annotated[Any, _FREQUENCY, After(_positive), _text_schema(units.FREQUENCY)]
#: A data size above zero, in bits.
Size: TypeAlias = Annotated[int, _DATA_SIZE, After(_positive), _text_schema(units.DATA_SIZE)]
#: A data size of zero or more, in bits.
SizeOrNothing: TypeAlias = Annotated[int, _DATA_SIZE, After(_not_negative), _text_schema(units.DATA_SIZE, zero=True)]
#: Sizes of what fits into a payload of XRCE-DDS, in bits.
Payload: TypeAlias = Annotated[Size, After(_payload)]
PayloadOrNothing: TypeAlias = Annotated[SizeOrNothing, After(_payload)]
#: A bit rate above zero, in bits per second.
BitRate: TypeAlias = Annotated[int, _BIT_RATE, After(_positive), _text_schema(units.BIT_RATE)]
#: Symbols per second of a serial line, as everybody writes it: without a unit.
BaudRate: TypeAlias = Annotated[int, Limits(ge=300, le=100_000_000)]
#: Name of an object.
Name: TypeAlias = Annotated[
    str,
    Before(_name),
    # Numbers are names, too; that they are not is what YAML says, not the author.
    editor_schema(
        f"expected a name: {_NAME_RULE}", type=["string", "number"], pattern=r"^\S(.*\S)?$", maxLength=MAX_NAME_LENGTH
    ),
]
#: A number above zero.
Number: TypeAlias = Annotated[
    float,
    Before(_number),
    Limits(gt=0),
    editor_schema(
        "expected a number above zero such as 1.5",
        type=["number", "string"],
        exclusiveMinimum=0,
        pattern=f"^{_ABOVE_ZERO}{_DIGITS}$",
    ),
]
#: Before a choice of whole numbers, for which `true` and "1" would do as well.
WHOLE_NUMBER = Before(_whole_number)
#: A number of things.
Count: TypeAlias = Annotated[int, Limits(ge=1, le=1_000_000)]
#: A number of things, possibly zero.
CountOrNone: TypeAlias = Annotated[int, Limits(ge=0, le=1_000_000)]
#: A scheduling priority; a higher number is a higher priority.
Priority: TypeAlias = Annotated[int, Limits(ge=0, le=2**31 - 1)]
#: A number that a priority of a task can have in an operating system; threads of Zephyr that nothing preempts have negative ones.
PriorityNumber: TypeAlias = Annotated[int, Limits(ge=-(2**31) + 1, le=2**31 - 1)]
#: An identifier of CAN frames, of 11 or 29 bits: a whole number, or text such as "0x120".
CanIdentifier: TypeAlias = Annotated[
    int,
    Before(_identifier),
    editor_schema(
        f"expected an identifier of up to 29 bits, 0 to {_GREATEST_IDENTIFIER:#x}",
        type=["integer", "string"],
        minimum=0,
        maximum=_GREATEST_IDENTIFIER,
        pattern=r"^0x[0-9A-Fa-f_]+\s*$",
        examples=[0x120],
    ),
]


class VersionedSection(DescriptionSection):
    """The content of a file, with the version of its format."""

    amuros: Annotated[Literal[1], WHOLE_NUMBER]
    """Version of the format."""
