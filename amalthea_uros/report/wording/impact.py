"""What a change does to results, in words."""

from __future__ import annotations

from enum import StrEnum
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.impact import ComparedFigure, Effect, FigureUnit, Impact, ImpactRow, Preference
from amalthea_uros.report.wording.cells import load_text
from amalthea_uros.units import Rounding, number_text, rounded, rounded_time_text

#: The names of quantities that tables have other words for.
_SHORT = {
    "schedulable": "schedulable",
    "worst_case_load": "worst load",
    "worst_case_response_time": "worst response",
    "max_response_time": "max response",
    "min_first_to_first": "min",
    "max_reduced_reaction_time": "reaction",
    "max_reduced_data_age": "data age",
}


def impact_cells(impact: Impact) -> list[tuple[str, ...]]:
    """A row of text for each figure that changed."""
    return [_cells(row) for row in impact.rows]


def unchanged_text(impact: Impact) -> str:
    """How many figures are not in the table."""
    if not impact.rows:
        return "nothing changed" + (f": {counted(impact.unchanged, 'figure')} compared" if impact.unchanged else "")
    verb = "is" if impact.unchanged == 1 else "are"
    return f"{counted(impact.unchanged, 'other figure')} {verb} unchanged"


def _cells(row: ImpactRow) -> tuple[str, ...]:
    others = row.after, row.before
    texts = (_text(figure, other) for figure, other in zip((row.before, row.after), others, strict=True))
    quantity = _SHORT.get(row.quantity, row.quantity.replace("_", " "))
    return (row.object or "system", quantity, *texts, str(row.effect), _claim(row))


def _claim(row: ImpactRow) -> str:
    """The claims of both values, once if they are equal; why the value is unknown if it is afterwards."""
    claims = dict.fromkeys(str(figure.claim) for figure in (row.before, row.after) if figure is not None and figure.claim)
    is_lost = row.after is not None and row.after.value is None and row.effect is not Effect.REMOVED
    return row.after.reason if row.after is not None and is_lost and row.after.reason else " -> ".join(claims)


def _text(figure: ComparedFigure | None, other: ComparedFigure | None) -> str:
    """The value of a figure, with as many digits as it takes to differ from the other one."""
    if figure is None:
        return "-"
    match figure.value:
        case None:
            return _open_text(figure)
        case StrEnum():
            return str(figure.value).replace("_", " ")
    against = other.value if other is not None and not isinstance(other.value, StrEnum) else None
    return _number(figure, Fraction(figure.value), against)


def _open_text(figure: ComparedFigure) -> str:
    if figure.unit is FigureUnit.VERDICT:
        return "not judged"
    if figure.at_least:
        return f"at least {_percent(figure.at_least, Preference.HIGH)}"
    return "unbounded" if figure.is_overload else "unknown"


def _number(figure: ComparedFigure, value: Fraction, other: int | Fraction | None) -> str:
    match figure.unit:
        case FigureUnit.SHARE:
            return _percent(value, figure.goal, other)
        case FigureUnit.NUMBER:
            return number_text(value)
    return rounded_time_text(value, Rounding.UP if figure.goal is Preference.LOW else Rounding.DOWN, other)


def _percent(load: Fraction, goal: Preference, other: int | Fraction | None = None) -> str:
    """A load in percent, rounded to the safe side, with as many digits as it takes to differ from the other one."""
    rounding = Rounding.UP if goal is Preference.LOW else Rounding.DOWN
    if other is None or other == load or (load > 1) != (other > 1):
        return load_text(load, rounding)
    return f"{number_text(rounded(load * 100, rounding, other * 100))} %"
