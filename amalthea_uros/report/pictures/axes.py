"""Axes of times and of counts: nice numbers, windows of time, what zooms."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import count

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.svg import MARGIN, SMALL_SIZE, Markup, element, joined, number, text, text_width
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
    """A window around a job, from its activation to its end, or around the way of a chain: with a margin and round ends.

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
    lines = "".join(f"M{number(axis.x(time))} {number(top)}V{number(bottom)}" for time in axis.ticks)
    return element("path", class_="grid", d=lines)


def draw_time_axis(axis: TimeAxis, y: float, quantity: str) -> Markup:
    """The line, its ticks and labels, and below them what they are."""
    parts = [element("path", class_="rule", d=f"M{number(axis.left)} {number(y)}H{number(axis.right)}")]
    for time in axis.ticks:
        x = axis.x(time)
        parts.append(element("line", class_="rule", x1=x, x2=x, y1=y, y2=y + _TICK))
        parts.append(element("text", text(axis.label(time)), class_="small", x=x, y=y + 17, text_anchor="middle"))
    middle = axis.left + axis.width / 2
    parts.append(element("text", text(axis.caption(quantity)), class_="small muted", x=middle, y=y + 34, text_anchor="middle"))
    return joined(parts)


_MOST_COUNTS = 6
#: Shares are drawn in parts of a millionth.
MILLION = 10**6


def count_ticks(highest: int) -> range:
    """From 0 to the first that is not below a number."""
    step = nice_step(max(highest, 1), _MOST_COUNTS)
    return multiples(step, 0, -(-max(highest, 1) // step) * step)


def count_label(count: int, *, is_share: bool) -> str:
    """A number with separators of thousands, or a percentage."""
    return f"{number_text(Fraction(100 * count, MILLION))} %" if is_share else f"{count:,}"


def width_of_labels(highest: int, *, is_share: bool) -> float:
    """The pixels that the widest label takes."""
    return max(text_width(count_label(tick, is_share=is_share), SMALL_SIZE) for tick in count_ticks(highest))


@dataclass(frozen=True, slots=True)
class CountAxis:
    """Whole numbers from 0 to at least `highest` in the pixels from `bottom` up to `top`.

    Attributes
    ----------
    is_share : they are millionths, and labelled as percentages
    """

    highest: int
    top: float
    bottom: float
    is_share: bool

    @property
    def ticks(self) -> range:
        """Where it has labels."""
        return count_ticks(self.highest)

    def y(self, count: float) -> float:
        """The pixel of a number."""
        return self.bottom - count / self.ticks[-1] * (self.bottom - self.top)


def draw_count_axis(axis: CountAxis, left: float, right: float, quantity: str) -> Markup:
    """Horizontal lines at the ticks, their labels, and beside these what they are."""
    parts = []
    for tick in axis.ticks:
        y = axis.y(tick)
        parts.append(element("path", class_="grid", d=f"M{number(left)} {number(y)}H{number(right)}"))
        parts.append(
            element(
                "text", text(count_label(tick, is_share=axis.is_share)), class_="small", x=left - 8, y=y + 4, text_anchor="end"
            )
        )
    place = f"translate({MARGIN + SMALL_SIZE} {number((axis.top + axis.bottom) / 2)}) rotate(-90)"
    parts.append(element("text", text(quantity), class_="small muted", transform=place, text_anchor="middle"))
    return joined(parts)


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
