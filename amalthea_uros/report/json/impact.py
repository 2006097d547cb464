"""What a change does to the results, for programs: exact numbers."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from amalthea_uros.analyze.impact import ComparedFigure, Effect, FigureUnit, Impact, ImpactRow


def content(impact: Impact) -> dict[str, Any]:
    """The figures that changed, and the number of the others."""
    return {
        "rows": [row_json(row) for row in impact.rows],
        "unchanged": impact.unchanged,
        "effects": {effect: impact.counts.get(effect, 0) for effect in Effect},
    }


def row_json(row: ImpactRow) -> dict[str, Any]:
    """A figure before and after the change."""
    return {
        "part": row.part,
        "object": row.object,
        "quantity": row.quantity,
        "effect": row.effect,
        "before": _figure(row.before),
        "after": _figure(row.after),
    }


def _figure(figure: ComparedFigure | None) -> dict[str, Any] | None:
    if figure is None:
        return None
    return {
        **_value(figure),
        "claim": figure.claim,
        "overload": figure.is_overload,
        "reason": figure.reason,
    }


def _value(figure: ComparedFigure) -> dict[str, Any]:
    match figure.unit, figure.value:
        case FigureUnit.TIME, value:
            return {"value_ps": None if value is None else round(Fraction(value))}
        case FigureUnit.SHARE | FigureUnit.NUMBER, value:
            exact = None if value is None else Fraction(value)
            known = {} if figure.at_least is None else {"at_least": float(figure.at_least)}
            return {"value": None if exact is None else float(exact), "exact": None if exact is None else str(exact), **known}
    return {"value": figure.value}
