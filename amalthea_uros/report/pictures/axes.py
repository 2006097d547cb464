"""Axes of times and of counts: nice numbers, windows of time, what zooms."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from itertools import count

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.page import levels, turned
from amalthea_uros.report.pictures.svg import (
    SMALL_SIZE,
    Markup,
    element,
    horizontal,
    joined,
    number,
    path_of,
    text_at,
    text_width,
    vertical,
)
from amalthea_uros.units import MICROSECOND, MILLISECOND, NANOSECOND, PICOSECOND, SECOND, Time, number_text, time_text

_UNITS = (("s", SECOND), ("ms", MILLISECOND), ("us", MICROSECOND), ("ns", NANOSECOND), ("ps", PICOSECOND))


def nice_steps() -> Iterator[int]:
    """1, 2, 5, 10, 20, 50 and so on."""
    return (factor * 10**power for power in count() for factor in (1, 2, 5))


def nice_step(span: int, parts: int) -> int:
    """The smallest nice number of which at most so many parts make up a span."""
    return next(step for step in nice_steps() if step * parts >= span)


def multiples(step: int, start: int, end: int) -> range:
    """The multiples of a step from `start` to `end`, both included."""
    return range(-(-start // step) * step, end + 1, step)


def unit_of(span: Time) -> tuple[str, Time]:
    """The largest unit of which a span has at least two, and its size."""
    return next(((name, size) for name, size in _UNITS if span >= 2 * size), _UNITS[-1])


#: On each side a tenth of what is shown, and the ends at multiples of about a twentieth.
_WINDOW_MARGIN, _WINDOW_PARTS = 10, 20
#: What has no length is shown in the middle of a window of about this one.
_SHORTEST = MICROSECOND


def default_window(start: Time, end: Time) -> tuple[Time, Time]:
    """A window around a job, from its activation to its end, or around the path of a chain: with a margin, its ends rounded.

    Raises
    ------
    InvalidArgumentError : the end is before the start.
    """
    if end < start:
        raise InvalidArgumentError(f"a window cannot start at {time_text(start)} and end before, at {time_text(end)}")
    margin = -(-max(end - start, _SHORTEST) // _WINDOW_MARGIN)
    step = nice_step(end - start + 2 * margin, _WINDOW_PARTS)
    left, right = (start - margin) // step * step, -(-(end + margin) // step) * step
    return (left if start < 0 else max(left, 0)), right


def check_window(start: Time, end: Time) -> None:
    """InvalidArgumentError if there is nothing between start and end."""
    if end <= start:
        raise InvalidArgumentError(
            f"the window of a picture must end after it starts, not at {time_text(end)} as it starts at {time_text(start)}"
        )


#: Pixels.
_NEAREST, _GAP, _TICK = 56, 14, 5
HEIGHT = 44
#: A label with more characters is written relative to a time near the window.
_LONGEST = 7


@dataclass(frozen=True, slots=True)
class TimeAxis:
    """The window from `start` to `end` in the pixels from `left` to `left + width`."""

    start: Time
    end: Time
    left: float
    width: float

    @property
    def right(self) -> float:
        """The pixel of the end."""
        return self.left + self.width

    @property
    def pixel(self) -> float:
        """Picoseconds in a pixel."""
        return (self.end - self.start) / self.width

    def x(self, time: Time | Fraction) -> float:
        """The pixel of a point in time."""
        return self.left + (time - self.start) / (self.end - self.start) * self.width

    def clipped(self, time: Time) -> Time:
        """The nearest point in time of the window."""
        return min(max(time, self.start), self.end)

    def has(self, time: Time | None) -> bool:
        """Whether a point in time is known and in the window."""
        return time is not None and self.start <= time <= self.end

    @property
    def unit(self) -> tuple[str, Time]:
        """What its labels count, and the size of that."""
        return unit_of(self.end - self.start)

    @property
    def origin(self) -> Time:
        """What its labels are relative to: zero, or a round time before a window that is far from zero."""
        is_near = len(number_text(Fraction(self.end, self.unit[1]))) <= _LONGEST and self.start >= 0
        if is_near or self.start <= 0 <= self.end:
            return 0
        thousand = 1000 * self.unit[1]
        return self.start // thousand * thousand

    def label(self, time: Time) -> str:
        """The number at a tick."""
        return number_text(Fraction(time - self.origin, self.unit[1]))

    @property
    def ticks(self) -> Sequence[Time]:
        """As many as have room for their labels."""
        for step in nice_steps():
            if step < _NEAREST * self.pixel:
                continue
            times = multiples(step, self.start - self.origin, self.end - self.origin)
            shifted = range(times.start + self.origin, times.stop + self.origin, step)
            if all(
                text_width(self.label(time), SMALL_SIZE) + _GAP <= step / self.pixel for time in (*shifted[:1], *shifted[-1:])
            ):
                return shifted
        raise AssertionError("there is always a wider step")

    def caption(self, quantity: str) -> str:
        """What the labels are."""
        after = f" after {time_text(self.origin)}" if self.origin else ""
        return f"{quantity} in {self.unit[0]}{after}"


def draw_grid(axis: TimeAxis, top: float, bottom: float) -> Markup:
    """Vertical lines at the ticks."""
    lines = "".join(vertical(axis.x(time), top, bottom) for time in axis.ticks)
    return path_of("grid", lines)


def draw_time_axis(axis: TimeAxis, y: float, quantity: str) -> Markup:
    """The line, its ticks and labels, and below them what they are."""
    parts = [path_of("rule", horizontal(axis.left, axis.right, y))]
    for time in axis.ticks:
        x = axis.x(time)
        parts.append(element("line", class_="rule", x1=x, x2=x, y1=y, y2=y + _TICK))
        parts.append(text_at(axis.label(time), x, y + 17, "small", anchor="middle"))
    middle = axis.left + axis.width / 2
    parts.append(text_at(axis.caption(quantity), middle, y + 34, "small muted", anchor="middle"))
    return joined(parts)


_MOST_COUNTS = 6


def count_ticks(highest: int) -> range:
    """From 0 to the first that is not below a number."""
    step = nice_step(max(highest, 1), _MOST_COUNTS)
    return multiples(step, 0, -(-max(highest, 1) // step) * step)


def width_of_counts(highest: int) -> float:
    """The pixels that the widest label of an axis of counts takes."""
    return max(text_width(f"{tick:,}", SMALL_SIZE) for tick in count_ticks(highest))


@dataclass(frozen=True, slots=True)
class CountAxis:
    """Whole numbers from 0 to at least `highest` in the pixels from `bottom` up to `top`."""

    highest: int
    top: float
    bottom: float

    def y(self, count: float) -> float:
        """The pixel of a number."""
        return self.bottom - count / count_ticks(self.highest)[-1] * (self.bottom - self.top)


def draw_count_axis(axis: CountAxis, left: float, right: float, quantity: str) -> Markup:
    """Horizontal lines at the ticks, their labels, and beside these what they are."""
    ticks = ((axis.y(tick), f"{tick:,}") for tick in count_ticks(axis.highest))
    return joined((*levels(ticks, left, right), turned(quantity, axis.top, axis.bottom)))


_CLIP = "amuros-plot"
#: Pixels around the plot in which lines and numbers at its ends are seen.
_EDGE = 6


def zoom_attributes(axis: TimeAxis, bottom: float) -> dict[str, str]:
    """The attributes of a picture: left and right end of the axis in pixels, start and end in picoseconds, and where the axis is."""
    ends = f"{number(axis.left)} {number(axis.right)} {axis.start} {axis.end}"
    return {"data_zoom": ends, "data_axis": number(bottom)}


def drawn_times(axis: TimeAxis, bottom: float, parts: Iterable[Markup]) -> tuple[Markup, ...]:
    """What is at its time, clipped to the axis, and the axis."""
    clip = element("rect", x=axis.left - _EDGE, y=0, width=axis.width + 2 * _EDGE, height=bottom + 2)
    return (
        element("clipPath", clip, id=_CLIP),
        element("g", joined(parts), data_plot="", clip_path=f"url(#{_CLIP})"),
        element("g", draw_time_axis(axis, bottom, "time"), data_axis=""),
    )
