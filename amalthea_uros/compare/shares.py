"""Shares that users give: "20 %", "0.2" or 0.2."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.errors import InvalidArgumentError


def parse_share(share: Fraction | float | str, what: str) -> Fraction:
    """A share such as "20%", "0.2" or 0.2.

    Raises
    ------
    InvalidArgumentError : it is no share.
    """
    text = str(share).strip()
    try:
        return Fraction(text.removesuffix("%").strip()) / (100 if text.endswith("%") else 1)
    except (ValueError, ZeroDivisionError):
        raise InvalidArgumentError(f"{what}: {share!r} is not a share such as '20%'") from None


def parse_tolerance(value: str | float | Fraction) -> Fraction:
    """A tolerance as a share: "20 %", "0.2" or 0.2.

    Raises
    ------
    InvalidArgumentError : it is none, or a number above 1, which may be meant in percent.
    """
    text = str(value).strip()
    number, percent = text.removesuffix("%").strip(), text.endswith("%")
    try:
        share = Fraction(number) / (100 if percent else 1)
    except (ValueError, ZeroDivisionError):
        raise InvalidArgumentError(f"{value!r} is not a tolerance such as '20%'") from None
    if share < 0 or (share > 1 and not percent):
        raise InvalidArgumentError(f"{value!r} is not a tolerance from 0 to 1; write percent as in '20%'")
    return share
