"""The row of a process in a Gantt chart: what it shows, and how it is drawn."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from amalthea_uros.report.pictures.arrows import Arrows, arrows_at, draw_activations, draw_deadlines, draw_instants, draw_lost
from amalthea_uros.report.pictures.boxes import StateBox, boxes_of, draw_borders, draw_boxes
from amalthea_uros.report.pictures.jobs import Job, ProcessRow, RunnableSpan, State
from amalthea_uros.report.pictures.runnable_boxes import draw_runnables, shown_runnables
from amalthea_uros.report.pictures.style import PALETTE, SMALL_SIZE
from amalthea_uros.report.pictures.svg import Markup, element, joined, number, text
from amalthea_uros.report.pictures.text_widths import text_width
from amalthea_uros.report.pictures.time_axis import TimeAxis

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
    boxes = [
        draw_boxes(found, drawn.row.name, drawn.colour, base - height, height, has_tooltips=has_tooltips)
        for state, found in drawn.boxes.items()
        for height in (HEIGHTS.get(state, _OFF_CORE),)
    ]
    return joined(
        part
        for part in (
            element("path", class_="rule", d=f"M{number(axis.left)} {number(base)}H{number(axis.right)}"),
            draw_instants((drawn.activations, drawn.deadlines), foot, base),
            *boxes,
            draw_borders(drawn.boxes[State.RUNNING], foot, FULL),
            draw_runnables(drawn.runnables, axis, foot, FULL),
            Markup("") if drawn.runnables else _job_numbers(drawn, base),
            _late_bars(drawn, base),
            draw_deadlines(drawn.deadlines, top, foot, are_missed=False),
            draw_activations(drawn.activations, top, foot),
            draw_deadlines(drawn.missed, top, foot, are_missed=True),
            draw_lost(drawn.lost, top, base),
        )
        if part
    )


def _late_bars(drawn: DrawnRow, base: float) -> Markup:
    path = "".join(f"M{number(begin)} {number(base + 1)}H{number(end)}v{_LATE}H{number(begin)}z" for begin, end in drawn.late)
    return element("path", class_="late", d=path) if path else Markup("")


def _job_numbers(drawn: DrawnRow, base: float) -> Markup:
    """The number of the job in each box that is wide enough."""
    parts = []
    for box in drawn.boxes[State.RUNNING]:
        label = str(box.job.instance)
        if box.count == 1 and text_width(label, SMALL_SIZE) + _NUMBER_MARGIN <= box.width:
            middle = (box.left + box.right) / 2
            look = f"small on{drawn.colour % len(PALETTE)}"
            parts.append(element("text", text(label), class_=look, x=middle, y=base - 6, text_anchor="middle"))
    return joined(parts)
