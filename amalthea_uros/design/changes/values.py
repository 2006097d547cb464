"""Values of changes as text; a ValueError says what is wrong with one."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import StrEnum
from typing import TypeVar

from amalthea_uros.units import Frequency, Time, parse_frequency, parse_time

E = TypeVar("E", bound=StrEnum)


def duration(text: str) -> Time:
    """A time of at least 0."""
    time = parse_time(text)
    if time < 0:
        raise ValueError(f"{text!r} is negative; expected at least 0 s")
    return time


def positive_duration(text: str) -> Time:
    """A time greater than 0."""
    time = parse_time(text)
    if time <= 0:
        raise ValueError(f"{text!r} is not greater than 0 s")
    return time


def positive_frequency(text: str) -> Frequency:
    """A frequency greater than 0."""
    frequency = parse_frequency(text)
    if frequency <= 0:
        raise ValueError(f"{text!r} is not greater than 0 Hz")
    return frequency


def whole_number(text: str) -> int:
    """A whole number."""
    try:
        return int(text)
    except ValueError:
        raise ValueError(f"{text!r} is not a whole number such as 2") from None


def positive_number(text: str) -> int:
    """A whole number of at least 1."""
    number = whole_number(text)
    if number < 1:
        raise ValueError(f"{text!r} is less than 1")
    return number


def one_of(members: Iterable[E]) -> Callable[[str], E]:
    """One of some words."""
    choices = {str(member): member for member in members}

    def choose(text: str) -> E:
        if text not in choices:
            raise ValueError(f"{text!r} is not one of {', '.join(choices)}")
        return choices[text]

    return choose
