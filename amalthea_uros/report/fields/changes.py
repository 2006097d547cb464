"""The fields of what changes do to a system and to its results."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from amalthea_uros.analyze.impact import ComparedFigure, Effect, FigureUnit, Impact, ImpactRow
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.report.fields.declaration import ABSENT, ALSO, Field, declare, given


def _value(figure: ComparedFigure) -> dict[str, Any]:
    match figure.unit, figure.value:
        case FigureUnit.TIME, value:
            return {"value_ps": None if value is None else round(Fraction(value))}
        case FigureUnit.SHARE | FigureUnit.NUMBER, value:
            exact = None if value is None else Fraction(value)
            known = {} if figure.at_least is None else {"at_least": float(figure.at_least)}
            return {"value": None if exact is None else float(exact), "exact": None if exact is None else str(exact), **known}
    return {"value": figure.value}


#: The fields of a result whose system was changed: what changed, and what that does.
CHANGED: tuple[Field, ...] = (
    ("changes", lambda result: ABSENT if result.impact is None else result.differences),
    ("impact", given("impact")),
)

declare(Difference, ("key", "target"), ("from", "before"), ("to", "after"), ("consequence", "is_consequence"))
declare(Impact, "rows", "unchanged", ("effects", lambda impact: {effect: impact.counts.get(effect, 0) for effect in Effect}))
declare(ImpactRow, *("part", "object", "quantity", "effect", "before", "after"))
declare(ComparedFigure, (ALSO, _value), "claim", ("overload", "is_overload"), "reason")
