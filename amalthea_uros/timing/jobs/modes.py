"""Conditions on modes, only some of which are known."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

from amalthea_uros.perf.conditions import ChannelFillIs, Comparison, Condition, ModeLabelsAre, ModeValueIs, Relation, Undecided

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
