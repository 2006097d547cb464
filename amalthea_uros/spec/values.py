"""Single values of an `app.yaml`: names, quantities with units, and numbers."""

from __future__ import annotations

import re
from collections.abc import Callable
from math import isfinite
from typing import Annotated, Any, TypeAlias

from pydantic import AfterValidator, BeforeValidator, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

from amalthea_uros import units

#: In characters.
MAX_NAME_LENGTH = 200
_GREATEST_IDENTIFIER = 2**29 - 1
_NUMBER = re.compile(r"[-+]?(\d+(\.\d*)?|\.\d+)([eE][-+]?\d{1,3})?", re.ASCII)


def problem(message: str) -> PydanticCustomError:
    """The exception that a validator raises for a wrong value."""
    # Braces would be taken for placeholders.
    return PydanticCustomError("value", message.replace("{", "{{").replace("}", "}}"))


def unexpected(message: str) -> PydanticCustomError:
    """The exception that a validator raises for a wrong value, which the message is to show."""
    return PydanticCustomError("unexpected", message)


def _quantity(parse: Callable[[str], Any], dimension: units.Dimension) -> Callable[[Any], Any]:
    def convert(value: Any) -> Any:
        if isinstance(value, bool) or not isinstance(value, str | int):
            raise unexpected(f"expected {dimension.article} such as {dimension.example!r}")
        try:
            return parse(str(value))
        except ValueError as error:
            raise problem(str(error)) from None

    return convert


def _positive(value: Any) -> Any:
    if value <= 0:
        raise unexpected("must be greater than zero")
    return value


def _not_negative(value: Any) -> Any:
    if value < 0:
        raise unexpected("must not be negative")
    return value


def _text_schema(dimension: units.Dimension) -> WithJsonSchema:
    known = "|".join(dimension.units)
    number = r"[+]?([0-9]+([.][0-9]*)?|[.][0-9]+)([eE][-+]?[0-9]+)?"
    return WithJsonSchema({"type": "string", "pattern": f"^\\s*{number}\\s*({known})\\s*$", "examples": [dimension.example]})


def _name(value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, str | int):
        raise unexpected("expected a name")
    text = str(value)
    if not text.strip() or text != text.strip() or len(text) > MAX_NAME_LENGTH or not text.isprintable():
        allowed = f"1 to {MAX_NAME_LENGTH} printable characters without leading or trailing blanks"
        raise problem(f"{units.shortened(text)!r} is not a name; use {allowed}")
    return text


def _number(value: Any) -> float:
    # Decimals are text until here, so that a name such as 1.10 keeps its zero.
    if isinstance(value, bool) or not (isinstance(value, int) or (isinstance(value, str) and _NUMBER.fullmatch(value))):
        raise unexpected("expected a number such as 1.5")
    number = float(value)
    if not isfinite(number):
        raise unexpected("out of range")
    return number


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


_TIME = BeforeValidator(_quantity(units.parse_time, units.TIME))
_FREQUENCY = BeforeValidator(_quantity(units.parse_frequency, units.FREQUENCY))
_DATA_SIZE = BeforeValidator(_quantity(units.parse_data_size, units.DATA_SIZE))
_BIT_RATE = BeforeValidator(_quantity(units.parse_bit_rate, units.BIT_RATE))

#: A time above zero, in picoseconds.
Duration: TypeAlias = Annotated[int, _TIME, AfterValidator(_positive), _text_schema(units.TIME)]
#: A time of zero or more, in picoseconds.
Offset: TypeAlias = Annotated[int, _TIME, AfterValidator(_not_negative), _text_schema(units.TIME)]
#: A frequency above zero, in hertz.
Rate: TypeAlias = Annotated[Any, _FREQUENCY, AfterValidator(_positive), _text_schema(units.FREQUENCY)]
#: A data size above zero, in bits.
Size: TypeAlias = Annotated[int, _DATA_SIZE, AfterValidator(_positive), _text_schema(units.DATA_SIZE)]
#: A data size of zero or more, in bits.
SizeOrNothing: TypeAlias = Annotated[int, _DATA_SIZE, AfterValidator(_not_negative), _text_schema(units.DATA_SIZE)]
#: A bit rate above zero, in bits per second.
BitRate: TypeAlias = Annotated[int, _BIT_RATE, AfterValidator(_positive), _text_schema(units.BIT_RATE)]
#: Name of an object.
Name: TypeAlias = Annotated[str, BeforeValidator(_name), WithJsonSchema({"type": "string", "minLength": 1})]
#: A number above zero.
Number: TypeAlias = Annotated[float, BeforeValidator(_number, json_schema_input_type=float), Field(gt=0)]
#: Before a choice of whole numbers, for which `true` and "1" would do as well.
WHOLE_NUMBER = BeforeValidator(_whole_number)
#: A number of things.
Count: TypeAlias = Annotated[int, Field(strict=True, ge=1, le=1_000_000)]
#: A number of things, possibly zero.
CountOrNone: TypeAlias = Annotated[int, Field(strict=True, ge=0, le=1_000_000)]
#: A scheduling priority; a higher number is a higher priority.
Priority: TypeAlias = Annotated[int, Field(strict=True, ge=0, le=2**31 - 1)]
#: An identifier of CAN frames, of 11 or 29 bits: a whole number, or text such as "0x120".
CanIdentifier: TypeAlias = Annotated[
    int,
    BeforeValidator(_identifier),
    WithJsonSchema(
        {
            "anyOf": [
                {"type": "integer", "minimum": 0, "maximum": _GREATEST_IDENTIFIER},
                {"type": "string", "examples": ["0x120"]},
            ]
        }
    ),
]
