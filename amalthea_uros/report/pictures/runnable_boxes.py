"""Runnables as boxes within those of their process."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.report.pictures.jobs import Job, RunnableSpan
from amalthea_uros.report.pictures.svg import Markup, element, joined, text, tooltip
from amalthea_uros.report.pictures.text_widths import elided
from amalthea_uros.report.pictures.time_axis import TimeAxis
from amalthea_uros.units import time_text

#: Pixels; a narrower runnable is left out.
NARROWEST = 3.0
_INSET, _TEXT_SIZE, _SHORTEST_NAME = 4.0, 10, 3


def shown_runnables(jobs: Sequence[Job], axis: TimeAxis) -> tuple[list[RunnableSpan], bool]:
    """Those in the window that are wide enough, and whether there are others."""
    found = [span for job in jobs for span in job.runnables if span.start < axis.end and span.end > axis.start]
    wide = [span for span in found if _right(span, axis) - _left(span, axis) >= NARROWEST]
    return wide, len(wide) < len(found)


def draw_runnables(spans: Sequence[RunnableSpan], axis: TimeAxis, y: float, height: float) -> Markup:
    """Boxes with their names, within boxes that begin at `y`."""
    return joined(_drawn(span, axis, y + _INSET, height - 2 * _INSET) for span in spans)


def _left(span: RunnableSpan, axis: TimeAxis) -> float:
    return axis.x(axis.clipped(span.start))


def _right(span: RunnableSpan, axis: TimeAxis) -> float:
    return axis.x(axis.clipped(span.end))


def _drawn(span: RunnableSpan, axis: TimeAxis, y: float, height: float) -> Markup:
    left, right = _left(span, axis), _right(span, axis)
    tip = tooltip(f"{span.name}: {time_text(span.end - span.start)} from {time_text(span.start)} on")
    box = element("rect", class_="label", x=left + 0.5, y=y, width=right - left - 1, height=height, rx=2)
    name = elided(span.name, _TEXT_SIZE, right - left - 6)
    if len(name) < min(_SHORTEST_NAME, len(span.name)):
        return element("g", tip, box)
    label = element("text", text(name), font_size=_TEXT_SIZE, x=(left + right) / 2, y=y + height - 3, text_anchor="middle")
    return element("g", tip, box, label)
