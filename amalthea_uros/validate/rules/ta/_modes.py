"""Conditions on modes whose values are literals."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.metamodel.classes import EnumMode, ModeLabel, ModeValueCondition, RelationalOperator
from amalthea_uros.metamodel.element import Element


def by_label(conditions: Iterable[Element]) -> dict[ModeLabel, tuple[dict[str, None], dict[str, None]]]:
    """The literals that each mode label is compared with, for equality and for inequality."""
    found: dict[ModeLabel, tuple[dict[str, None], dict[str, None]]] = {}
    for condition in conditions:
        if not isinstance(condition, ModeValueCondition) or condition.label is None or condition.value is None:
            continue
        if isinstance(condition.label.mode, EnumMode) and condition.relation in _RELATIONS:
            found.setdefault(condition.label, ({}, {}))[_RELATIONS.index(condition.relation)][condition.value] = None
    return found


_RELATIONS = (RelationalOperator.EQUAL, RelationalOperator.NOT_EQUAL)
