"""Marks of verdicts: they differ in shape and not only in colour."""

from __future__ import annotations

from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.pictures.page import LegendEntry
from amalthea_uros.report.pictures.svg import Markup, element, tooltip

_MISSED = ("alert", "M-4 -4L4 4M4 -4L-4 4")
_SHAPES = {
    Verdict.MET: ("good", "M-5 0L-1.5 4L5 -4"),
    Verdict.MISSED: _MISSED,
    Verdict.UNBOUNDED: _MISSED,
    Verdict.UNKNOWN: ("unsure", "M-3 -2.5A3 3 0 1 1 1.2 0.2Q0 .8 0 2M0 4V5.5"),
}
#: Pixels that a mark takes.
MARK = 12


def draw_verdict(verdict: Verdict | None, x: float, y: float) -> Markup:
    """The mark of a verdict around (x, y); nothing for no verdict."""
    if verdict is None:
        return Markup("")
    style, shape = _SHAPES[verdict]
    mark = element("path", class_=style, d=shape)
    return element("g", tooltip(str(verdict)), mark, transform=f"translate({round(x, 2):g} {round(y, 2):g})")


def verdict_entries(shown: set[Verdict | None]) -> list[LegendEntry]:
    """Entries of the legend for the verdicts that a picture shows."""
    return [LegendEntry(draw_verdict(verdict, 0, 0), str(verdict)) for verdict in Verdict if verdict in shown]
