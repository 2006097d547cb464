"""Predicted times beside measured distributions, each quantity with an axis of its own."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import ceil, floor

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass
from amalthea_uros.report.pictures.axes import TimeAxis, draw_time_axis
from amalthea_uros.report.pictures.page import MARGIN, TOP, WIDTH, Entry, nothing, picture_of, swatch
from amalthea_uros.report.pictures.svg import (
    Markup,
    element,
    horizontal,
    joined,
    number,
    path_of,
    rect_at,
    text_at,
    tipped,
    vertical,
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
    notes = [f"{counted(hidden, 'other quantity')} not shown."] if hidden else []
    rows = [_row(each, TOP + _ROW * index) for index, each in enumerate(quantities)] or [nothing("nothing was compared")]
    return picture_of(title, subtitle, rows, bottom + _GAP, _legend(quantities), notes)


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
    return tipped(
        _description(shown),
        rect_at("band", MARGIN, top + 1, WIDTH - 2 * MARGIN, _ROW - 4),
        text_at(shown.name, MARGIN + 6, top + 24, "header", room=_NAME),
        text_at(shown.quantity, MARGIN + 6, top + 42, "small muted", room=_NAME),
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
    line = path_of("grid", horizontal(axis.left, axis.right, base))
    return joined((line, element("g", joined(bars), class_="c0 bars")))


def _bracket(interval: DrawnInterval, style: str, axis: TimeAxis, y: float) -> Markup:
    """A line from the least to the greatest value with ticks at both, and a dot at the mean; arrows where it goes on."""
    left = axis.left if interval.low is None else max(axis.x(interval.low), axis.left)
    right = axis.right if interval.high is None else min(axis.x(interval.high), axis.right)
    is_open_left = interval.low is None or interval.low < axis.start
    is_open_right = interval.high is None or interval.high > axis.end
    line = horizontal(left, right, y) + _end(left, y, is_open_left, 1) + _end(right, y, is_open_right, -1)
    mean = Markup("")
    if interval.middle is not None:
        mean = element("circle", class_=style.replace(" steps", ""), cx=axis.x(interval.middle), cy=y, r=3, fill="none")
    return element("g", path_of(style, line), mean)


def _end(x: float, y: float, is_open: bool, inward: int) -> str:
    if is_open:
        return f"M{number(x + 5 * inward)} {number(y - _TICK)}L{number(x)} {number(y)}L{number(x + 5 * inward)} {number(y + _TICK)}"
    return vertical(x, y - _TICK, y + _TICK)


def _verdict(shown: ComparedQuantity, top: float) -> Markup:
    x = _RIGHT + _GAP
    style = "good" if shown.agrees else "alert"
    mark = f"M{number(x)} {number(top + 20)}l4 4l7 -9" if shown.agrees else f"M{number(x)} {number(top + 15)}l9 9m0 -9l-9 9"
    verdict = text_at(shown.verdict, x + 17, top + 24, room=_VERDICT - 20)
    return joined((path_of(style, mark), verdict, text_at(shown.remark, x, top + 42, "small muted", room=_VERDICT)))


def _description(shown: ComparedQuantity) -> str:
    parts = [f"measured {_interval_text(shown.measured)}"]
    parts += [f"simulated {_interval_text(shown.simulated)}"] if shown.simulated else []
    parts += [f"bounds {_interval_text(shown.bounds)}"] if shown.bounds else []
    return f"{shown.quantity} of {shown.name}: {', '.join((*parts, shown.verdict, shown.remark))}"


def _interval_text(interval: DrawnInterval) -> str:
    low, high = ("?" if end is None else time_text(round(end)) for end in (interval.low, interval.high))
    return f"{low} to {high}"


def _legend(quantities: Sequence[ComparedQuantity]) -> list[Entry]:
    bracket = "M-9 0H9M-9 -4v8M9 -4v8"
    return [
        (any(each.values for each in quantities), swatch("c0 bars"), "measured"),
        (any(not each.values for each in quantities), path_of("mark", bracket), "measured, min to max"),
        (any(each.simulated for each in quantities), path_of("t1 steps", bracket), "simulated, with mean"),
        (any(each.bounds for each in quantities), path_of("bound", bracket), "bounds of the analysis"),
    ]
