"""Histograms of times, with marks of what was observed, of limits and of bounds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from enum import StrEnum
from fractions import Fraction
from itertools import pairwise
from math import ceil, floor

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.axes import HEIGHT, CountAxis, TimeAxis, draw_count_axis, draw_time_axis, width_of_counts
from amalthea_uros.report.pictures.page import MARGIN, TOP, WIDTH, Entry, picture_of, swatch
from amalthea_uros.report.pictures.svg import (
    SMALL_SIZE,
    Markup,
    element,
    elided,
    joined,
    path_of,
    text_at,
    text_width,
    tipped,
    tooltip,
    vertical,
)
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
    line = path_of(style, vertical(flag.x, y + 2, bottom), stroke_dasharray=dash)
    tip = f"{flag.mark.label}: {time_text(flag.mark.time)}"
    return tipped(tip, line, text_at(flag.label, flag.x + _OFFSET, y + 12, "small"))


def short_time_text(time: Time | Fraction) -> str:
    """A time with four significant digits.

    >>> short_time_text(16_654_321)
    '16.65 us'
    """
    picoseconds = round(time)
    places = len(str(abs(picoseconds))) - _SIGNIFICANT
    return time_text(round(picoseconds, -places) if places > 0 else picoseconds)


#: Pixels.
_PLOT, _GAP, _RIGHT = 240, 8, 34
#: With more bins they could not be told from each other.
_MOST_BINS = 200
#: So many bins are put together: widths of 1, 2, 10, 20, ... of anything become 1, 2, 5, 10, 20, 50, ... of it.
_GROUPS = [digit * 10**tens for tens in range(16) for digit in (1, 5)]
#: A lower bar would not be seen, in pixels.
_LOWEST = 1.5
#: A single bin is at least one part of so many of its value wide, so that the axis has readable numbers.
_RESOLUTION = 100
#: One part of so many is free on both sides, and at least so many bins have room: a single one is no wall.
_MARGIN, _FEWEST_BINS = 25, 12


@dataclass(frozen=True, slots=True)
class HistogramPicture:
    """A histogram.

    Attributes
    ----------
    edges : of the bins, rising; a bin has its lower edge, and the last one its upper edge as well
    name, counts : how many values are in each bin, and of what, such as "simulated" or "measured"
    quantity : what the values are, such as "response time"
    things : what is counted, such as "jobs"

    Raises
    ------
    InvalidArgumentError : edges that do not rise, counts that do not fit to them.
    """

    title: str
    edges: tuple[Time, ...]
    name: str
    counts: tuple[int, ...]
    marks: tuple[Mark, ...] = ()
    quantity: str = "response time"
    things: str = "jobs"

    def __post_init__(self) -> None:
        if len(self.edges) < 2 or any(low >= high for low, high in pairwise(self.edges)):
            raise InvalidArgumentError("a histogram needs at least two edges, each greater than the one before")
        if len(self.counts) != len(self.edges) - 1 or min(self.counts) < 0:
            raise InvalidArgumentError(f"{self.name!r} needs {len(self.edges) - 1} counts of at least 0, one for each bin")


def histogram(histogram: HistogramPicture) -> str:
    """The histogram as SVG; marks that are far from all values are at the edge, with an arrow."""
    drawn = _coarsened(_trimmed(histogram))
    highest = max(drawn.counts)
    left = MARGIN + SMALL_SIZE + 2 * _GAP + width_of_counts(highest)
    axis = _axis(drawn, left)
    top = TOP + LANE * lanes_of(drawn.marks, axis) + _GAP
    counts = CountAxis(highest, top, top + _PLOT)
    body = (
        draw_count_axis(counts, axis.left, axis.right, _caption(drawn)),
        Markup("") if any(drawn.counts) else _nothing(axis, counts),
        _bars(drawn, axis, counts),
        draw_marks(drawn.marks, axis, top - _GAP, counts.bottom),
        draw_time_axis(axis, counts.bottom, drawn.quantity),
    )
    used = {mark.kind for mark in drawn.marks}
    entries: list[Entry] = [(True, swatch("c0 bars"), drawn.name)]
    entries += [(kind in used, path_of(look, "M-9 0H9", stroke_dasharray=dash), kind) for kind, (look, dash) in LINES.items()]
    subtitle = f"{drawn.name}: {sum(drawn.counts):,} {drawn.things}"
    return picture_of(drawn.title, subtitle, body, counts.bottom + HEIGHT + _GAP, entries)


def _trimmed(histogram: HistogramPicture) -> HistogramPicture:
    """Without empty bins at its ends."""
    used = [index for index, count in enumerate(histogram.counts) if count]
    if not used:
        return histogram
    first, after = used[0], used[-1] + 1
    return replace(histogram, edges=histogram.edges[first : after + 1], counts=histogram.counts[first:after])


def _coarsened(histogram: HistogramPicture) -> HistogramPicture:
    """With so many neighbouring bins put together that they can be told from each other; edges are multiples of the new width."""
    edges = histogram.edges
    fewest = -(-len(edges) // (_MOST_BINS - 1)) if len(edges) > 2 else edges[1] // (edges[1] - edges[0]) // _RESOLUTION
    size = next(size for size in _GROUPS if size >= fewest)
    before = edges[0] // (edges[1] - edges[0]) % size
    after = -(before + len(edges) - 1) % size
    start, end = edges[0] - before * (edges[1] - edges[0]), edges[-1] + after * (edges[-1] - edges[-2])
    # The first group begins with bins that are not there.
    firsts = range(-before, len(histogram.counts), size)
    merged = tuple(sum(histogram.counts[max(first, 0) : first + size]) for first in firsts)
    return replace(histogram, edges=(start, *edges[size - before : -1 : size], end), counts=merged)


def _window(histogram: HistogramPicture) -> tuple[Time, Time]:
    """The bins, and the marks that are not farther from them than they are wide; with margins."""
    low, high = histogram.edges[0], histogram.edges[-1]
    span = high - low
    near = [mark.time for mark in histogram.marks if low - span <= mark.time <= high + span]
    start, end = floor(min([low, *near])), ceil(max([high, *near]))
    shortage = _FEWEST_BINS * (histogram.edges[1] - low) - (end - start)
    margin = max(-(-(end - start) // _MARGIN), shortage // 2)
    return (start - margin if start < 0 else max(start - margin, 0)), end + margin


def _axis(histogram: HistogramPicture, left: float) -> TimeAxis:
    return TimeAxis(*_window(histogram), left, WIDTH - max(_RIGHT, MARGIN + label_room(histogram.marks)) - left)


def _bars(histogram: HistogramPicture, axis: TimeAxis, counts: CountAxis) -> Markup:
    """A bar for each bin that has values; it is seen, however few these are."""
    bars = []
    for (low, high), count in zip(pairwise(histogram.edges), histogram.counts, strict=True):
        if count:
            left, right, top = axis.x(low), axis.x(high), min(counts.y(count), counts.bottom - _LOWEST)
            tip = tooltip(f"{time_text(low)} to {time_text(high)}: {count:,} {histogram.things}")
            bars.append(element("rect", tip, x=left, y=top, width=right - left, height=counts.bottom - top))
    return element("g", joined(bars), class_="c0 bars")


def _nothing(axis: TimeAxis, counts: CountAxis) -> Markup:
    x, y = axis.left + axis.width / 2, (counts.top + counts.bottom) / 2
    return text_at("no values", x, y, "muted", anchor="middle")


def _caption(histogram: HistogramPicture) -> str:
    """What the vertical axis counts, with the width of the bins if all but the last have the same."""
    widths = {
        short_time_text(high - low)
        for low, high in pairwise(histogram.edges[:-1] if len(histogram.edges) > 2 else histogram.edges)
    }
    bins = f"bin of {widths.pop()}" if len(widths) == 1 else "bin"
    return f"{histogram.things} per {bins}"
