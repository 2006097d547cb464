"""Conditions on modes and fill levels."""

from __future__ import annotations

from collections.abc import Mapping
from operator import eq, ge, gt, le, lt, ne
from typing import NamedTuple

RELATIONS = {
    "EQUAL": eq,
    "NOT_EQUAL": ne,
    "LESS_THAN": lt,
    "LESS_THAN_OR_EQUAL": le,
    "GREATER_THAN": gt,
    "GREATER_THAN_OR_EQUAL": ge,
}


class Holds(NamedTuple):
    """A comparison of a mode or a fill level with a number."""

    kind: str
    name: str
    relation: str
    number: int


#: Alternatives, each of comparisons that hold together; none: always true.
Condition = tuple[tuple[Holds, ...], ...]


def holds(kind: str, name: str, relation: str, number: int) -> Holds:
    """A comparison, whose relation must be known."""
    if relation not in RELATIONS:
        raise ValueError(f"unknown relation {relation!r}")
    return Holds(kind, name, relation, number)


def is_true(condition: Condition, modes: Mapping[str, int], fills: Mapping[str, int]) -> bool:
    """Whether a condition holds now."""
    if not condition:
        return True
    state = {"mode": modes, "fill": fills}
    return any(all(RELATIONS[c.relation](state[c.kind][c.name], c.number) for c in alternative) for alternative in condition)
