"""Conditions on modes and channels, and assignments to modes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias


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
