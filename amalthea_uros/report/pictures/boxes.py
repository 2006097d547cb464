"""The boxes of a process in a state, and their places in pixels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from amalthea_uros.report.pictures.jobs import Job, ProcessRow, State, StateSpan
from amalthea_uros.report.pictures.style import state_look
from amalthea_uros.report.pictures.svg import Markup, element, joined, number, tooltip
from amalthea_uros.report.pictures.time_axis import TimeAxis
from amalthea_uros.units import time_text

#: Boxes that are narrower than this cannot be told from each other if there is less than a pixel between them.
NARROW, _NEAR = 0.25, 1.0
_PALE = ".5"
#: From this number of boxes on they have no tooltips, to keep the picture small.
MOST_TOOLTIPS = 1500


@dataclass(frozen=True, slots=True)
class StateBox:
    """A part of a row, in pixels.

    Attributes
    ----------
    job, span : what it shows; the first ones if it shows several
    count : of spans that it shows
    """

    left: float
    right: float
    job: Job
    span: StateSpan
    count: int = 1

    @property
    def width(self) -> float:
        """Pixels; a rectangle without a width would not be drawn at all."""
        return max(self.right - self.left, NARROW)

    @property
    def _is_narrow(self) -> bool:
        return self.count > 1 or self.right - self.left < NARROW

    def absorbs(self, other: StateBox) -> bool:
        """Whether the next box cannot be told from this one."""
        return self._is_narrow and other._is_narrow and other.left - self.right < _NEAR


def boxes_of(row: ProcessRow, state: State, axis: TimeAxis) -> list[StateBox]:
    """The boxes of a state in the window; those that cannot be told from each other are one."""
    found: list[StateBox] = []
    for box in _all_boxes(row, state, axis):
        if found and found[-1].absorbs(box):
            last = found[-1]
            found[-1] = replace(last, right=max(last.right, box.right), count=last.count + 1)
        else:
            found.append(box)
    return found


def _all_boxes(row: ProcessRow, state: State, axis: TimeAxis) -> Iterable[StateBox]:
    for job in row.jobs:
        for span in job.spans:
            if span.state is state and _is_seen(span, axis):
                yield StateBox(axis.x(axis.clipped(span.start)), axis.x(axis.clipped(span.end)), job, span)


def _is_seen(span: StateSpan, axis: TimeAxis) -> bool:
    """Whether it shares more than an end with the window, or has no length and is in it."""
    start, end = axis.clipped(span.start), axis.clipped(span.end)
    return start < end or (span.start == span.end and axis.has(span.start))


def draw_boxes(boxes: Sequence[StateBox], process: str, colour: int, y: float, height: float, *, has_tooltips: bool) -> Markup:
    """Boxes of one state, with their upper edge at `y`; those of several spans are paler, because gaps between these are not seen."""
    single, merged = [box for box in boxes if box.count == 1], [box for box in boxes if box.count > 1]
    return joined(
        (_drawn_with_tooltips(group, process, y, height, look) if has_tooltips else _drawn(group, y, height, look))
        for group, paleness in ((single, {}), (merged, {"opacity": _PALE}))
        if group
        for look in (state_look(group[0].span.state, colour) | paleness,)
    )


def _drawn(boxes: Sequence[StateBox], y: float, height: float, look: Mapping[str, str]) -> Markup:
    path = "".join(f"M{number(box.left)} {number(y)}h{number(box.width)}v{number(height)}H{number(box.left)}z" for box in boxes)
    return element("path", **look, d=path)


def _drawn_with_tooltips(boxes: Sequence[StateBox], process: str, y: float, height: float, look: Mapping[str, str]) -> Markup:
    drawn = (
        element("rect", tooltip(_description(box, process)), x=box.left, y=y, width=box.width, height=height) for box in boxes
    )
    return element("g", joined(drawn), **look)


def draw_borders(boxes: Sequence[StateBox], y: float, height: float) -> Markup:
    """Gaps between jobs that follow each other at once."""
    touching = [after.left for before, after in pairwise(boxes) if before.right == after.left and before.job is not after.job]
    path = "".join(f"M{number(x)} {number(y)}v{number(height)}" for x in touching)
    return element("path", class_="gap", d=path) if path else Markup("")


def _description(box: StateBox, process: str) -> str:
    if box.count > 1:
        return f"{process}: {box.span.state} {box.count} times from {time_text(box.span.start)} on"
    length = time_text(box.span.end - box.span.start)
    core = f" on {box.span.core}" if box.span.core else ""
    ends = f"from {time_text(box.span.start)} to {time_text(box.span.end)}"
    return f"{process}, job {box.job.instance}: {box.span.state}{core} for {length} {ends}"
