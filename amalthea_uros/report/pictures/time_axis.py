"""A horizontal axis of time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.report.pictures.style import SMALL_SIZE
from amalthea_uros.report.pictures.svg import Markup, element, joined, number, text
from amalthea_uros.report.pictures.text_widths import text_width
from amalthea_uros.report.pictures.ticks import multiples, nice_steps, unit_of
from amalthea_uros.units import Time, number_text, time_text

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
