"""How far values are from their limits."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import inf
from typing import Protocol, TypeVar

Number = TypeVar("Number", int, Fraction)


class Limited(Protocol):
    """A quantity with its limit."""

    @property
    def value(self) -> int | Fraction | None:
        """What is compared with the limit; None if it is unknown."""

    @property
    def limit(self) -> int | Fraction | None:
        """None if there is none."""

    @property
    def is_upper(self) -> bool:
        """Whether the value must not exceed the limit; otherwise it must not fall below it."""


L = TypeVar("L", bound=Limited)


def margin_of(value: Number | None, limit: Number | None, is_upper: bool) -> Number | None:
    """The distance of a value from its limit; negative if the limit is missed."""
    if value is None or limit is None:
        return None
    return limit - value if is_upper else value - limit


def share_left(item: Limited) -> Fraction | float | None:
    """How much is left up to a limit, as a share: of an upper limit, or of the value that a lower limit is below.

    So that limits of all sizes have one order: 20 us of 1 ms are less than 990 us of 1 s. Negative if the limit is missed.
    """
    if item.value is None or item.limit is None:
        return None
    value, limit = Fraction(item.value), Fraction(item.limit)
    margin = limit - value if item.is_upper else value - limit
    scale = max(abs(value), abs(limit))
    if not item.is_upper and limit == 0 <= margin:
        # No time falls below zero; a difference of times can, and has a negative limit then.
        return inf
    return margin / scale if scale else Fraction(0)


def tightest(items: Iterable[L]) -> L | None:
    """The one of which the smallest share of the limit is left; None if no limit has a value."""
    shares = [(share, item) for item in items if (share := share_left(item)) is not None]
    return min(shares, key=lambda pair: pair[0], default=(None, None))[1]
