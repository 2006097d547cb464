"""Predicted times beside measured distributions, each quantity with an axis of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, floor

from amalthea_uros._internal.plural import counted
from amalthea_uros.report.pictures.axes import TimeAxis, draw_time_axis
from amalthea_uros.report.pictures.svg import (
    MARGIN,
    SMALL_SIZE,
    TEXT_SIZE,
    TOP,
    WIDTH,
    LegendEntry,
    Markup,
    document,
    draw_legend,
    element,
    elided,
    joined,
    number,
    text,
    tooltip,
)
from amalthea_uros.units import MICROSECOND, Time, time_text

#: Pixels: of a row, its bars and its brackets, and of the columns for names and verdicts.
_ROW, _BARS, _LANE, _GAP = 130, 40, 15, 12
_NAME, _VERDICT = 230, 130
_LEFT, _RIGHT = MARGIN + _NAME + _GAP, WIDTH - MARGIN - _VERDICT - _GAP
_BINS = 80
#: What is so much wider than the measured and simulated values is cut off, with an arrow.
_WIDEST = 8
_TICK = 4


@dataclass(frozen=True, slots=True)
class DrawnInterval:
    """From the least to the greatest value; `middle` is the mean, None if it is not known. Of bounds, an end may be missing."""

    low: Fraction | None
    high: Fraction | None
    middle: Fraction | None = None

    @property
    def ends(self) -> list[Fraction]:
        """The known ends."""
        return [end for end in (self.low, self.high) if end is not None]


@dataclass(frozen=True, slots=True)
class ComparedQuantity:
    """What is drawn of a quantity.

    Attributes
    ----------
    values : how often which time was measured; empty if only statistics are known
    agrees : whether the prediction holds
    """

    name: str
    quantity: str
    measured: DrawnInterval
    values: tuple[tuple[Time, int], ...]
    simulated: DrawnInterval | None
    bounds: DrawnInterval | None
    verdict: str
    remark: str
    agrees: bool


def compared_times(title: str, subtitle: str, quantities: Sequence[ComparedQuantity], hidden: int = 0) -> str:
    """The picture as SVG.

    Parameters
    ----------
    hidden : number of quantities that are not drawn
    """
    bottom = TOP + _ROW * max(len(quantities), 1)
    nothing = element("text", text("nothing was compared"), class_="muted", x=MARGIN, y=TOP + 20)
    notes = [f"{counted(hidden, 'other quantity')} not shown."] if hidden else []
    legend, height = draw_legend(_legend(quantities), notes, bottom + _GAP)
    rows = [_row(each, TOP + _ROW * index) for index, each in enumerate(quantities)] or [nothing]
    return document(title, subtitle, (*rows, legend), height + MARGIN)


def _row(shown: ComparedQuantity, top: float) -> Markup:
    axis = _axis(shown)
    base = top + 6 + _BARS
    lanes = [
        (shown.measured if not shown.values else None, "mark"),
        (shown.simulated, "t1 steps"),
        (shown.bounds, "bound"),
    ]
    brackets, y = [], base + _LANE / 2 + 2
    for interval, style in lanes:
        if interval is not None:
            brackets.append(_bracket(interval, style, axis, y))
            y += _LANE
    return element(
        "g",
        tooltip(_description(shown)),
        element("rect", class_="band", x=MARGIN, y=top + 1, width=WIDTH - 2 * MARGIN, height=_ROW - 4),
        element("text", text(elided(shown.name, TEXT_SIZE, _NAME, is_bold=True)), class_="header", x=MARGIN + 6, y=top + 24),
        element("text", text(elided(shown.quantity, SMALL_SIZE, _NAME)), class_="small muted", x=MARGIN + 6, y=top + 42),
        _bars(shown, axis, top + 6, base),
        *brackets,
        draw_time_axis(axis, top + _ROW - 46, shown.quantity),
        _verdict(shown, top),
    )


def _axis(shown: ComparedQuantity) -> TimeAxis:
    """All of what was measured and simulated; bounds as far as they are near to it."""
    near = [*shown.measured.ends, *(shown.simulated.ends if shown.simulated else ())]
    low, high = min(near, default=Fraction(0)), max(near, default=Fraction(MICROSECOND))
    room = max(high - low, abs(high) / 10, Fraction(1000))
    far = [end for end in (shown.bounds.ends if shown.bounds else ()) if low - _WIDEST * room <= end <= high + _WIDEST * room]
    start, end = min([low, *far]), max([high, *far])
    margin = max((end - start) / 12, abs(end) / 10, Fraction(1000))
    return TimeAxis(floor(start - margin), ceil(end + margin), _LEFT, _RIGHT - _LEFT)


def _bars(shown: ComparedQuantity, axis: TimeAxis, top: float, base: float) -> Markup:
    """A histogram of the measured values."""
    width = max((axis.end - axis.start) // _BINS, 1)
    counts: dict[int, int] = {}
    for value, count in shown.values:
        place = (value - axis.start) // width
        counts[place] = counts.get(place, 0) + count
    highest = max(counts.values(), default=1)
    bars = []
    for place, count in sorted(counts.items()):
        height = max(count / highest * (base - top), 1.5)
        left, right = axis.x(axis.start + place * width), axis.x(axis.start + (place + 1) * width)
        bars.append(element("rect", x=left, y=base - height, width=right - left, height=height))
    line = element("path", class_="grid", d=f"M{number(axis.left)} {number(base)}H{number(axis.right)}")
    return joined((line, element("g", joined(bars), class_="c0 bars")))


def _bracket(interval: DrawnInterval, style: str, axis: TimeAxis, y: float) -> Markup:
    """A line from the least to the greatest value with ticks at both, and a dot at the mean; arrows where it goes on."""
    left = axis.left if interval.low is None else max(axis.x(interval.low), axis.left)
    right = axis.right if interval.high is None else min(axis.x(interval.high), axis.right)
    parts = [f"M{number(left)} {number(y)}H{number(right)}"]
    is_open_left = interval.low is None or interval.low < axis.start
    is_open_right = interval.high is None or interval.high > axis.end
    parts.append(_end(left, y, is_open_left, 1))
    parts.append(_end(right, y, is_open_right, -1))
    mean = Markup("")
    if interval.middle is not None:
        mean = element("circle", class_=style.replace(" steps", ""), cx=axis.x(interval.middle), cy=y, r=3, fill="none")
    return element("g", element("path", class_=style, d="".join(parts)), mean)


def _end(x: float, y: float, is_open: bool, inward: int) -> str:
    if is_open:
        return f"M{number(x + 5 * inward)} {number(y - _TICK)}L{number(x)} {number(y)}L{number(x + 5 * inward)} {number(y + _TICK)}"
    return f"M{number(x)} {number(y - _TICK)}v{2 * _TICK}"


def _verdict(shown: ComparedQuantity, top: float) -> Markup:
    x = _RIGHT + _GAP
    style = "good" if shown.agrees else "alert"
    mark = f"M{number(x)} {number(top + 20)}l4 4l7 -9" if shown.agrees else f"M{number(x)} {number(top + 15)}l9 9m0 -9l-9 9"
    return joined(
        (
            element("path", class_=style, d=mark),
            element("text", text(elided(shown.verdict, TEXT_SIZE, _VERDICT - 20)), x=x + 17, y=top + 24),
            element("text", text(elided(shown.remark, SMALL_SIZE, _VERDICT)), class_="small muted", x=x, y=top + 42),
        )
    )


def _description(shown: ComparedQuantity) -> str:
    parts = [f"measured {_interval_text(shown.measured)}"]
    parts += [f"simulated {_interval_text(shown.simulated)}"] if shown.simulated else []
    parts += [f"bounds {_interval_text(shown.bounds)}"] if shown.bounds else []
    return f"{shown.quantity} of {shown.name}: {', '.join((*parts, shown.verdict, shown.remark))}"


def _interval_text(interval: DrawnInterval) -> str:
    low, high = ("?" if end is None else time_text(round(end)) for end in (interval.low, interval.high))
    return f"{low} to {high}"


def _legend(quantities: Sequence[ComparedQuantity]) -> list[LegendEntry]:
    bracket = "M-9 0H9M-9 -4v8M9 -4v8"
    entries = (
        (
            any(each.values for each in quantities),
            element("rect", class_="c0 bars", x=-9, y=-6, width=18, height=12),
            "measured",
        ),
        (any(not each.values for each in quantities), element("path", class_="mark", d=bracket), "measured, min to max"),
        (any(each.simulated for each in quantities), element("path", class_="t1 steps", d=bracket), "simulated, with mean"),
        (any(each.bounds for each in quantities), element("path", class_="bound", d=bracket), "bounds of the analysis"),
    )
    return [LegendEntry(key, meaning) for is_shown, key, meaning in entries if is_shown]
