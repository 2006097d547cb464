"""A vertical axis of counts or shares."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from amalthea_uros.report.pictures.page import MARGIN
from amalthea_uros.report.pictures.style import SMALL_SIZE
from amalthea_uros.report.pictures.svg import Markup, element, joined, number, text
from amalthea_uros.report.pictures.text_widths import text_width
from amalthea_uros.report.pictures.ticks import multiples, nice_step
from amalthea_uros.units import number_text

_PARTS = 6
#: Shares are drawn in parts of a millionth.
MILLION = 10**6


def count_ticks(highest: int) -> range:
    """From 0 to the first that is not below a number."""
    step = nice_step(max(highest, 1), _PARTS)
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
