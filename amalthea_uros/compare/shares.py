"""Shares that users give: "20 %", "0.2" or 0.2."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.errors import InvalidArgumentError

#: Digits of a number, and characters of its exponent; exact shares of Python have as many.
_MOST_DIGITS, _LONGEST_EXPONENT = 80, 4
#: A million times as much, or that in percent, is no share that somebody means.
_LARGEST = 10**8


def parse_share(share: Fraction | float | str, what: str) -> Fraction:
    """A share such as "20%", "0.2" or 0.2.

    Raises
    ------
    InvalidArgumentError : it is no share.
    """
    text = str(share).strip()
    try:
        return _number(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    except (ValueError, ZeroDivisionError):
        raise InvalidArgumentError(f"{what}: {text[:40]!r} is not a share such as '20%'") from None


def _number(text: str) -> Fraction:
    """A number; an exponent such as that of 1e999999999 would take all memory to be exact."""
    number, _, exponent = text.lower().strip().partition("e")
    if len(number) > _MOST_DIGITS or len(exponent) > _LONGEST_EXPONENT:
        raise ValueError("out of range")
    share = Fraction(text.strip())
    if abs(share) > _LARGEST:
        raise ValueError("out of range")
    return share


def parse_tolerance(value: str | float | Fraction) -> Fraction:
    """A tolerance as a share: "20 %", "0.2" or 0.2.

    Raises
    ------
    InvalidArgumentError : it is none, or a number above 1, which may be meant in percent.
    """
    text = str(value).strip()
    number, percent = text.removesuffix("%").strip(), text.endswith("%")
    try:
        share = _number(number) / (100 if percent else 1)
    except (ValueError, ZeroDivisionError):
        raise InvalidArgumentError(f"{text[:40]!r} is not a tolerance such as '20%'") from None
    if share < 0 or (share > 1 and not percent):
        raise InvalidArgumentError(f"{value!r} is not a tolerance from 0 to 1; write percent as in '20%'")
    return share
