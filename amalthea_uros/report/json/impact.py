"""What a change does to the results, for programs: exact numbers."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from amalthea_uros.analyze.impact import Amount, Effect, Figure, Impact, ImpactRow, Unit


def content(impact: Impact) -> dict[str, Any]:
    """The figures that changed, and the number of the others."""
    return {
        "rows": [_row(row) for row in impact.rows],
        "unchanged": impact.unchanged,
        "effects": {effect: impact.counts.get(effect, 0) for effect in Effect},
    }


def _row(row: ImpactRow) -> dict[str, Any]:
    return {
        "part": row.part,
        "object": row.object,
        "quantity": row.quantity,
        "unit": _UNITS[row.figure.unit],
        "effect": row.effect,
        "before": _figure(row.before),
        "after": _figure(row.after),
    }


_UNITS = {Unit.TIME: "ps", Unit.SHARE: "share", Unit.NUMBER: "number", Unit.VERDICT: "verdict"}


def _figure(figure: Figure | None) -> dict[str, Any] | None:
    if figure is None:
        return None
    return {
        "value": _amount(figure.value),
        "claim": figure.claim,
        "at_least": _amount(figure.at_least),
        "overload": figure.is_overload,
        "reason": figure.reason,
    }


def _amount(value: Amount | None) -> int | str | None:
    """A whole number, a word, or a fraction as text such as "3/200", which loses no digit."""
    if isinstance(value, Fraction):
        return value.numerator if value.denominator == 1 else str(value)
    return value
