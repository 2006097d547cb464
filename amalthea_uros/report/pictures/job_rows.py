"""The row of a process in a picture: boxes of its states and runnables, arrows of activations and deadlines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.report.pictures.axes import TimeAxis
from amalthea_uros.report.pictures.jobs import Job, ProcessRow, RunnableSpan, State, StateSpan
from amalthea_uros.report.pictures.page import PALETTE, WIDTH, state_look
from amalthea_uros.report.pictures.svg import (
    SMALL_SIZE,
    Markup,
    element,
    elided,
    horizontal,
    joined,
    number,
    path_of,
    rect_at,
    text_at,
    text_width,
    tipped,
    tooltip,
    vertical,
)
from amalthea_uros.units import Time, time_text

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


def _all_boxes(row: ProcessRow, state: State, axis: TimeAxis) -> Iterator[StateBox]:
    """Of what shares more than an end with the window, or has no length and is in it."""
    for job in row.jobs:
        for span in job.spans:
            start, end = axis.clipped(span.start), axis.clipped(span.end)
            if span.state is state and (start < end or (span.start == span.end and axis.has(span.start))):
                yield StateBox(axis.x(start), axis.x(end), job, span)


def draw_boxes(boxes: Sequence[StateBox], process: str, colour: int, y: float, height: float, *, has_tooltips: bool) -> Markup:
    """Boxes of one state, with their upper edge at `y`; those of several spans are paler, because gaps between these are not seen."""
    parts = []
    for is_merged, paleness in ((False, {}), (True, {"opacity": _PALE})):
        found = [box for box in boxes if (box.count > 1) is is_merged]
        if not found:
            continue
        look = state_look(found[0].span.state, colour) | paleness
        if has_tooltips:
            rects = (
                element("rect", tooltip(_description(box, process)), x=box.left, y=y, width=box.width, height=height)
                for box in found
            )
            parts.append(element("g", joined(rects), **look))
        else:
            ends = ((number(box.left), number(box.width)) for box in found)
            d = "".join(f"M{left} {number(y)}h{width}v{number(height)}H{left}z" for left, width in ends)
            parts.append(element("path", **look, d=d))
    return joined(parts)


def draw_borders(boxes: Sequence[StateBox], y: float, height: float) -> Markup:
    """Gaps between jobs that follow each other at once."""
    touching = [after.left for before, after in pairwise(boxes) if before.right == after.left and before.job is not after.job]
    return path_of("gap", "".join(vertical(x, y, y + height) for x in touching))


def _description(box: StateBox, process: str) -> str:
    if box.count > 1:
        return f"{process}: {box.span.state} {box.count} times from {time_text(box.span.start)} on"
    length = time_text(box.span.end - box.span.start)
    core = f" on {box.span.core}" if box.span.core else ""
    ends = f"from {time_text(box.span.start)} to {time_text(box.span.end)}"
    return f"{process}, job {box.job.instance}: {box.span.state}{core} for {length} {ends}"


#: Pixels; a narrower runnable is left out.
NARROWEST_RUNNABLE = 3.0
_INSET, _TEXT_SIZE, _SHORTEST_NAME = 4.0, 10, 3


def shown_runnables(jobs: Sequence[Job], axis: TimeAxis) -> tuple[list[RunnableSpan], bool]:
    """Those in the window that are wide enough, and whether there are others."""
    found = [span for job in jobs for span in job.runnables if span.start < axis.end and span.end > axis.start]
    ends = [(span, *_ends(span, axis)) for span in found]
    wide = [span for span, left, right in ends if right - left >= NARROWEST_RUNNABLE]
    return wide, len(wide) < len(found)


def _ends(span: RunnableSpan, axis: TimeAxis) -> tuple[float, float]:
    return axis.x(axis.clipped(span.start)), axis.x(axis.clipped(span.end))


def _runnable_box(span: RunnableSpan, axis: TimeAxis, y: float, height: float) -> Markup:
    """A box with its name, if this has room."""
    left, right = _ends(span, axis)
    tip = f"{span.name}: {time_text(span.end - span.start)} from {time_text(span.start)} on"
    box = rect_at("label", left + 0.5, y, right - left - 1, height, rx=2)
    name = elided(span.name, _TEXT_SIZE, right - left - 6)
    if len(name) < min(_SHORTEST_NAME, len(span.name)):
        return tipped(tip, box)
    return tipped(tip, box, text_at(name, (left + right) / 2, y + height - 3, anchor="middle", font_size=_TEXT_SIZE))


#: Arrows that are nearer to each other, in pixels, are drawn as one.
NEAR = 3.0
_HEAD, _HALF = 6.5, 3.2


@dataclass(frozen=True, slots=True)
class Arrows:
    """Points in time of one kind in the window, in pixels, with how many there are at each.

    Attributes
    ----------
    are_merged : different points in time are drawn as one arrow
    """

    places: tuple[tuple[float, int], ...]
    are_merged: bool = False


def arrows_at(times: Iterable[Time | None], axis: TimeAxis) -> Arrows:
    """The arrows of those that are known and in the window."""
    places: list[tuple[float, int]] = []
    are_merged, last = False, None
    for time in sorted(time for time in times if time is not None and axis.has(time)):
        x = axis.x(time)
        if places and x - places[-1][0] < NEAR:
            places[-1] = places[-1][0], places[-1][1] + 1
            are_merged = are_merged or time != last
        else:
            places.append((x, 1))
        last = time
    return Arrows(tuple(places), are_merged)


def draw_instants(kinds: Iterable[Arrows], top: float, bottom: float) -> Markup:
    """Fine lines that lead arrows to the base line, if there are few enough to follow them."""
    places = [x for arrows in kinds if not arrows.are_merged for x, _ in arrows.places]
    return path_of("instant", "".join(vertical(x, top, bottom) for x in places))


def draw_activations(arrows: Arrows, top: float, bottom: float) -> Markup:
    """Arrows up from `bottom` to `top`; where several meet, their number if it has room."""
    stems = "".join(vertical(x, bottom, top + _HEAD) for x, _ in arrows.places)
    heads = "".join(f"M{number(x)} {number(top)}l{_HALF} {_HEAD}h{-2 * _HALF}z" for x, _ in arrows.places)
    return joined((path_of("mark", stems), path_of("head", heads), _counts(arrows, top)))


def draw_deadlines(arrows: Arrows, top: float, bottom: float, *, are_missed: bool) -> Markup:
    """Arrows down from `top` to `bottom`, with empty heads if they are kept."""
    stems = "".join(vertical(x, top, bottom - _HEAD) for x, _ in arrows.places)
    heads = "".join(f"M{number(x)} {number(bottom)}l{-_HALF} {-_HEAD}h{2 * _HALF}z" for x, _ in arrows.places)
    line, head = ("alert", "late") if are_missed else ("mark", "mark paper")
    return joined((path_of(line, stems), path_of(head, heads)))


def draw_lost(arrows: Arrows, top: float, bottom: float) -> Markup:
    """Crossed stems, for activations that have no job."""
    crosses = (f"{vertical(x, bottom, top + 4)}M{number(x - 4)} {number(top)}l8 8m0 -8l-8 8" for x, _ in arrows.places)
    return path_of("alert", "".join(crosses))


def _counts(arrows: Arrows, top: float) -> Markup:
    """The numbers at arrows that show several instants; none where some are merged for lack of room."""
    if arrows.are_merged:
        return Markup("")
    ends = [*(x for x, _ in arrows.places[1:]), WIDTH]
    parts = []
    for (x, count), following in zip(arrows.places, ends, strict=False):
        label = f"\N{MULTIPLICATION SIGN}{count}"
        if count > 1 and x + _HALF + 2 + text_width(label, SMALL_SIZE) < following - _HALF:
            parts.append(text_at(label, x + _HALF + 2, top + 7, "small halo"))
    return joined(parts)


#: Pixels: of a row, from its upper edge to its base line, of the boxes that hold a core.
ROW, BASE, FULL = 50, 43, 20
_ARROW_TOP, _LATE, _NUMBER_MARGIN = 5, 4, 16
#: What holds no core is lower.
HEIGHTS = {State.RUNNING: FULL, State.POLLING: FULL, State.ACTIVE: 6}
_OFF_CORE = 12


@dataclass(frozen=True, slots=True)
class DrawnRow:
    """What a row shows of the window.

    Attributes
    ----------
    colour : of the palette
    top : the upper edge
    late : from deadlines to the ends of the jobs that missed them, in pixels
    omits_runnables : some are too narrow
    """

    row: ProcessRow
    colour: int
    top: float
    boxes: Mapping[State, list[StateBox]]
    activations: Arrows
    deadlines: Arrows
    missed: Arrows
    lost: Arrows
    late: tuple[tuple[float, float], ...]
    runnables: tuple[RunnableSpan, ...]
    omits_runnables: bool

    @property
    def middle(self) -> float:
        """Of its boxes that hold a core."""
        return self.top + BASE - FULL / 2

    @property
    def number_of_boxes(self) -> int:
        """In all states."""
        return sum(map(len, self.boxes.values()))


def lay_out(row: ProcessRow, colour: int, top: float, axis: TimeAxis) -> DrawnRow:
    """What of a process is seen in the window, in pixels."""
    late = [job for job in row.jobs if job.misses_deadline(axis.end)]
    runnables, omits_runnables = shown_runnables(row.jobs, axis)
    return DrawnRow(
        row=row,
        colour=colour,
        top=top,
        boxes={state: boxes_of(row, state, axis) for state in State},
        activations=arrows_at((job.activation for job in row.jobs), axis),
        deadlines=arrows_at((job.deadline for job in row.jobs if not job.misses_deadline(axis.end)), axis),
        missed=arrows_at((job.deadline for job in late), axis),
        lost=arrows_at(row.lost, axis),
        late=tuple(_united(_lateness(late, axis))),
        runnables=tuple(runnables),
        omits_runnables=omits_runnables,
    )


def _lateness(late: Iterable[Job], axis: TimeAxis) -> Iterable[tuple[float, float]]:
    for job in late:
        begin = axis.clipped(axis.start if job.deadline is None else job.deadline)
        end = axis.end if job.end is None else axis.clipped(job.end)
        if begin < end:
            yield axis.x(begin), axis.x(end)


def _united(intervals: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Without those that overlap or touch in a pixel."""
    found: list[tuple[float, float]] = []
    for begin, end in sorted(intervals):
        if found and begin - found[-1][1] < 1:
            found[-1] = found[-1][0], max(found[-1][1], end)
        else:
            found.append((begin, end))
    return found


def draw_row(drawn: DrawnRow, axis: TimeAxis, *, has_tooltips: bool) -> Markup:
    """Boxes on the base line, and arrows above them, so that neither hides the other."""
    base, top = drawn.top + BASE, drawn.top + _ARROW_TOP
    foot = base - FULL
    late = "".join(f"{horizontal(begin, end, base + 1)}v{_LATE}H{number(begin)}z" for begin, end in drawn.late)
    boxes = [
        draw_boxes(found, drawn.row.name, drawn.colour, base - height, height, has_tooltips=has_tooltips)
        for state, found in drawn.boxes.items()
        for height in (HEIGHTS.get(state, _OFF_CORE),)
    ]
    return joined(
        (
            path_of("rule", horizontal(axis.left, axis.right, base)),
            draw_instants((drawn.activations, drawn.deadlines), foot, base),
            *boxes,
            draw_borders(drawn.boxes[State.RUNNING], foot, FULL),
            *(_runnable_box(span, axis, foot + _INSET, FULL - 2 * _INSET) for span in drawn.runnables),
            *([] if drawn.runnables else _job_numbers(drawn, base)),
            path_of("late", late),
            draw_deadlines(drawn.deadlines, top, foot, are_missed=False),
            draw_activations(drawn.activations, top, foot),
            draw_deadlines(drawn.missed, top, foot, are_missed=True),
            draw_lost(drawn.lost, top, base),
        )
    )


def _job_numbers(drawn: DrawnRow, base: float) -> Iterator[Markup]:
    """The number of the job in each box that is wide enough."""
    look = f"small on{drawn.colour % len(PALETTE)}"
    for box in drawn.boxes[State.RUNNING]:
        label = str(box.job.instance)
        if box.count == 1 and text_width(label, SMALL_SIZE) + _NUMBER_MARGIN <= box.width:
            yield text_at(label, (box.left + box.right) / 2, base - 6, look, anchor="middle")
