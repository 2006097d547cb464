"""The path of one occurrence of a chain's stimulus through the jobs that pass its effect on."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from math import hypot

from amalthea_uros._internal.records import dataclass
from amalthea_uros.report.pictures.axes import TimeAxis
from amalthea_uros.report.pictures.page import ARROW_END
from amalthea_uros.report.pictures.svg import (
    TEXT_SIZE,
    Markup,
    element,
    elided,
    horizontal,
    joined,
    number,
    path_of,
    text_at,
    text_width,
    tipped,
    vertical,
)
from amalthea_uros.units import Time, time_text

#: Pixels.
LANE = 30
_RADIUS, _TICK = 4.0, 5
#: Different chains have different dashes.
_DASHES = ("none", "7 3", "2.5 2.5", "9 3 2 3")


@dataclass(frozen=True, slots=True)
class ChainStep:
    """The effect passes a process."""

    process: str
    time: Time


@dataclass(frozen=True, slots=True)
class DrawnPath:
    """The path of a chain's effect.

    Attributes
    ----------
    name : of the chain
    steps : in the order of time
    start, end : between which its latency is; None: the first step, the last step
    """

    name: str
    steps: tuple[ChainStep, ...]
    start: Time | None = None
    end: Time | None = None

    @property
    def ends(self) -> tuple[Time, Time]:
        """From when to when its latency is."""
        start = self.steps[0].time if self.start is None else self.start
        return start, self.steps[-1].time if self.end is None else self.end


def draw_path(path: DrawnPath, index: int, axis: TimeAxis, lane: float, middles: Mapping[str, float]) -> Markup:
    """The path from step to step, and its latency as a dimension line above all rows.

    Parameters
    ----------
    index : of the chain among those of the picture
    lane : the upper edge of where the dimension line is
    middles : where the boxes of each process are
    """
    points = [
        (axis.x(step.time), middles[step.process]) for step in path.steps if step.process in middles and axis.has(step.time)
    ]
    dash = _DASHES[index % len(_DASHES)]
    y = lane + LANE - 8
    start, end = path.ends
    extensions = [
        (axis.x(time), point[1])
        for time, point in zip((start, end), (points[:1] + points[-1:]), strict=False)
        if axis.has(time)
    ]
    parts = [path_of("rule", vertical(x, y - _TICK, bottom), stroke_dasharray="1.5 3") for x, bottom in extensions]
    parts += [_segment(*ends, dash) for ends in pairwise(points)]
    parts += [element("circle", class_="line paper", cx=x, cy=height, r=_RADIUS) for x, height in points]
    return tipped(_description(path), joined(parts), _dimension(path, axis, y, dash))


def _segment(begin: tuple[float, float], end: tuple[float, float], dash: str) -> Markup:
    """An arrow from the edge of a point to the edge of the next, with a rim that sets it off from boxes."""
    length = hypot(end[0] - begin[0], end[1] - begin[1])
    if length <= 2 * _RADIUS:
        return Markup("")
    inset_x, inset_y = ((end[axis] - begin[axis]) * (_RADIUS + 1) / length for axis in (0, 1))
    ends = f"M{number(begin[0] + inset_x)} {number(begin[1] + inset_y)}L{number(end[0] - inset_x)} {number(end[1] - inset_y)}"
    line = path_of("line", ends, stroke_dasharray=dash, marker_end=ARROW_END)
    return joined((path_of("halo", ends), line))


def _dimension(path: DrawnPath, axis: TimeAxis, y: float, dash: str) -> Markup:
    start, end = path.ends
    left, right = axis.x(axis.clipped(start)), axis.x(axis.clipped(end))
    ticks = "".join(vertical(axis.x(time), y - _TICK, y + _TICK) for time in (start, end) if axis.has(time))
    latency = time_text(end - start)
    name = elided(path.name, TEXT_SIZE, axis.width - text_width(f": {latency}", TEXT_SIZE))
    label = f"{name}: {latency}"
    half = text_width(label, TEXT_SIZE) / 2
    middle = min(max((left + right) / 2, axis.left + half), axis.right - half)
    line = path_of("line", horizontal(left, right, y), stroke_dasharray=dash)
    return joined((line, path_of("line", ticks), text_at(label, middle, y - 9, anchor="middle")))


def _description(path: DrawnPath) -> str:
    start, end = path.ends
    steps = ", ".join(f"{step.process} at {time_text(step.time)}" for step in path.steps)
    return f"{path.name}: {time_text(end - start)} from {time_text(start)} on; {steps}"
