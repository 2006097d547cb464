"""Nice numbers for axes: 1, 2 or 5 times a power of ten."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count

from amalthea_uros.units import MICROSECOND, MILLISECOND, NANOSECOND, PICOSECOND, SECOND, Time

_UNITS = (("s", SECOND), ("ms", MILLISECOND), ("us", MICROSECOND), ("ns", NANOSECOND), ("ps", PICOSECOND))


def nice_steps() -> Iterator[int]:
    """1, 2, 5, 10, 20, 50 and so on."""
    return (factor * 10**power for power in count() for factor in (1, 2, 5))


def nice_step(span: int, parts: int) -> int:
    """The smallest nice number of which at most so many parts make up a span."""
    return next(step for step in nice_steps() if step * parts >= span)


def multiples(step: int, start: int, end: int) -> range:
    """The multiples of a step from `start` to `end`, both included."""
    return range(-(-start // step) * step, end + 1, step)


def unit_of(span: Time) -> tuple[str, Time]:
    """The largest unit of which a span has at least two, and its size."""
    return next(((name, size) for name, size in _UNITS if span >= 2 * size), _UNITS[-1])
