"""Conditions on modes and channels, and assignments to modes."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from enum import StrEnum
from fractions import Fraction
from typing import Any, TypeAlias

from amalthea_uros._internal.records import dataclass


class Relation(StrEnum):
    """How two values are compared."""

    EQUAL = "=="
    NOT_EQUAL = "!="
    LESS = "<"
    LESS_OR_EQUAL = "<="
    GREATER = ">"
    GREATER_OR_EQUAL = ">="


@dataclass(frozen=True, slots=True, kw_only=True)
class ModeValueIs:
    """A mode label compared with a value: a literal, or a number as text."""

    label: str
    relation: Relation
    value: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ModeLabelsAre:
    """Two mode labels compared with each other."""

    first: str
    relation: Relation
    second: str


@dataclass(frozen=True, slots=True, kw_only=True)
class ChannelFillIs:
    """The number of elements in a channel compared with a number."""

    channel: str
    relation: Relation
    level: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Undecided:
    """A comparison that can be true or false, because a model does not state it completely.

    Attributes
    ----------
    reason : what is not stated, or not supported
    """

    reason: str


Comparison: TypeAlias = ModeValueIs | ModeLabelsAre | ChannelFillIs | Undecided


@dataclass(frozen=True, slots=True)
class Condition:
    """True if all comparisons of at least one of the alternatives are."""

    alternatives: tuple[tuple[Comparison, ...], ...]


def read_by(condition: Condition) -> tuple[str, ...]:
    """The mode labels and channels on which a condition depends."""
    found: list[str] = []
    for comparison in (each for every in condition.alternatives for each in every):
        match comparison:
            case ModeValueIs(label=label):
                found.append(label)
            case ModeLabelsAre(first=first, second=second):
                found += (first, second)
            case ChannelFillIs(channel=channel):
                found.append(channel)
            case Undecided():
                pass
    return tuple(dict.fromkeys(found))


@dataclass(frozen=True, slots=True, kw_only=True)
class ModeAssignment:
    """A value that a mode label gets: a literal, or a number as text."""

    label: str
    value: str


_COMPARE: dict[Relation, Callable[[Any, Any], bool]] = {
    Relation.EQUAL: operator.eq,
    Relation.NOT_EQUAL: operator.ne,
    Relation.LESS: operator.lt,
    Relation.LESS_OR_EQUAL: operator.le,
    Relation.GREATER: operator.gt,
    Relation.GREATER_OR_EQUAL: operator.ge,
}


def holds(condition: Condition | None, modes: Mapping[str, str]) -> bool | None:
    """Whether a condition is true; None if that depends on an unknown mode, or if nothing is compared."""
    if condition is None or not all(condition.alternatives):
        return None
    found = [_all_of([_compared(comparison, modes) for comparison in every]) for every in condition.alternatives]
    if True in found:
        return True
    return None if None in found or not found else False


def _all_of(values: list[bool | None]) -> bool | None:
    if False in values:
        return False
    return None if None in values else True


def _compared(comparison: Comparison, modes: Mapping[str, str]) -> bool | None:
    match comparison:
        case ModeValueIs(label=label, relation=relation, value=value):
            return _related(modes.get(label), relation, value)
        case ModeLabelsAre(first=first, relation=relation, second=second):
            return _related(modes.get(first), relation, modes.get(second))
        case ChannelFillIs() | Undecided():
            return None


def _related(first: str | None, relation: Relation, second: str | None) -> bool | None:
    """Compares numbers by value; literals of an enumeration can only be equal or not."""
    if first is None or second is None:
        return None
    numbers = _number(first), _number(second)
    if None not in numbers:
        return _COMPARE[relation](*numbers)
    return _COMPARE[relation](first, second) if relation in (Relation.EQUAL, Relation.NOT_EQUAL) else None


def _number(text: str) -> Fraction | None:
    try:
        return Fraction(text)
    except (ValueError, ZeroDivisionError):
        return None
