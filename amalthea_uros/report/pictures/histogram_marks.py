"""Vertical marks in a histogram: what was observed, limits, bounds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction

from amalthea_uros.report.pictures.style import SMALL_SIZE
from amalthea_uros.report.pictures.svg import Markup, element, joined, number, text, tooltip
from amalthea_uros.report.pictures.text_widths import elided, text_width
from amalthea_uros.report.pictures.time_axis import TimeAxis
from amalthea_uros.units import Time, time_text

#: Pixels.
LANE = 17
_WIDEST, _OFFSET = 170.0, 4.0
_SIGNIFICANT = 4


class MarkKind(StrEnum):
    """What a mark says."""

    OBSERVED = "observed"
    LIMIT = "limit"
    BOUND = "bound"


#: Their lines: the class of the style sheet, and the dashes.
LINES = {MarkKind.OBSERVED: ("mark", "none"), MarkKind.LIMIT: ("alert", "6 3"), MarkKind.BOUND: ("bound", "8 3 2 3")}


@dataclass(frozen=True, slots=True)
class Mark:
    """A time with a name, such as "mean", "p99", "limit" or "WCRT"."""

    label: str
    time: Time | Fraction
    kind: MarkKind = MarkKind.OBSERVED


@dataclass(frozen=True, slots=True)
class _Flag:
    """A mark in pixels; `lane` counts up from the plot."""

    mark: Mark
    x: float
    label: str
    lane: int


def label_room(marks: Iterable[Mark]) -> float:
    """The pixels to keep free for labels at the right of the last mark."""
    return max((min(_width(_label(mark)), _WIDEST) for mark in marks), default=0.0) + 2 * _OFFSET


def lanes_of(marks: Sequence[Mark], axis: TimeAxis) -> int:
    """How many labels have to be above each other."""
    return max((flag.lane for flag in _flags(marks, axis)), default=0)


def draw_marks(marks: Sequence[Mark], axis: TimeAxis, top: float, bottom: float) -> Markup:
    """A line from `bottom` up to a label above `top` for each mark."""
    return joined(_drawn(flag, top, bottom) for flag in _flags(marks, axis))


def _flags(marks: Sequence[Mark], axis: TimeAxis) -> list[_Flag]:
    """Each label is at the right of its line, and above the labels of all lines that it covers, so that no line crosses a label."""
    found: list[_Flag] = []
    for mark in sorted(marks, key=lambda mark: mark.time, reverse=True):
        x = min(max(axis.x(mark.time), axis.left), axis.right)
        label = elided(_label(mark, axis), SMALL_SIZE, _WIDEST)
        right = x + _width(label) + 2 * _OFFSET
        lane = 1 + max((other.lane for other in found if other.x <= right), default=0)
        found.append(_Flag(mark, x, label, lane))
    return found


def _label(mark: Mark, axis: TimeAxis | None = None) -> str:
    label = f"{mark.label} {short_time_text(mark.time)}"
    if axis is None or mark.time > axis.end:
        return f"{label} \N{RIGHTWARDS ARROW}"
    return f"\N{LEFTWARDS ARROW} {label}" if mark.time < axis.start else label


def _width(label: str) -> float:
    return text_width(label, SMALL_SIZE)


def _drawn(flag: _Flag, top: float, bottom: float) -> Markup:
    style, dash = LINES[flag.mark.kind]
    y = top - LANE * flag.lane
    line = element("path", class_=style, stroke_dasharray=dash, d=f"M{number(flag.x)} {number(y + 2)}V{number(bottom)}")
    tip = tooltip(f"{flag.mark.label}: {time_text(flag.mark.time)}")
    return element("g", tip, line, element("text", text(flag.label), class_="small", x=flag.x + _OFFSET, y=y + 12))


def short_time_text(time: Time | Fraction) -> str:
    """A time with four significant digits.

    >>> short_time_text(16_654_321)
    '16.65 us'
    """
    picoseconds = round(time)
    places = len(str(abs(picoseconds))) - _SIGNIFICANT
    return time_text(round(picoseconds, -places) if places > 0 else picoseconds)
