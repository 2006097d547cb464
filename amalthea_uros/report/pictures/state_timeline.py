"""The states of one process over time, with a line of its own for each state."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import pairwise

from amalthea_uros._internal.plural import counted
from amalthea_uros.report.pictures.arrows import draw_activations, draw_deadlines, draw_instants, draw_lost
from amalthea_uros.report.pictures.boxes import MOST_TOOLTIPS, draw_borders, draw_boxes
from amalthea_uros.report.pictures.gantt_legend import legend_entries, legend_notes
from amalthea_uros.report.pictures.gantt_rows import DrawnRow, lay_out
from amalthea_uros.report.pictures.jobs import ProcessRow, State
from amalthea_uros.report.pictures.page import MARGIN, TOP, WIDTH, document, draw_legend
from amalthea_uros.report.pictures.svg import Markup, element, joined, number, text
from amalthea_uros.report.pictures.time_axis import HEIGHT, TimeAxis, draw_grid, draw_time_axis
from amalthea_uros.report.pictures.windows import check_window
from amalthea_uros.units import Time, time_text

#: Pixels.
_LEFT, _RIGHT, _ARROWS, _LINE, _BOX, _GAP = 110, 90, 24, 28, 16, 8


@dataclass(frozen=True, slots=True)
class StateTimeline:
    """The states of a process in the window from `start` to `end`.

    Raises
    ------
    InvalidArgumentError : the window does not end after it starts.
    """

    title: str
    start: Time
    end: Time
    process: ProcessRow

    def __post_init__(self) -> None:
        check_window(self.start, self.end)


def state_timeline(timeline: StateTimeline) -> str:
    """The timeline as SVG: the states that occur, each with the share of the window that its jobs are in it."""
    axis = TimeAxis(timeline.start, timeline.end, _LEFT, WIDTH - _LEFT - _RIGHT)
    row = replace(lay_out(timeline.process, 0, TOP, axis), late=(), runnables=(), omits_runnables=False)
    states = [state for state in reversed(State) if row.boxes[state]]
    tops = {state: TOP + _ARROWS + _LINE * index for index, state in enumerate(states)}
    bottom = TOP + _ARROWS + _LINE * max(len(states), 1) + _GAP
    has_tooltips = row.number_of_boxes <= MOST_TOOLTIPS
    legend, height = draw_legend(legend_entries([row], has_chains=False), legend_notes([row], axis), bottom + HEIGHT + _GAP)
    body = (
        draw_grid(axis, TOP + _ARROWS, bottom),
        _heading(axis) if states else _nothing(),
        draw_instants((row.activations, row.deadlines), TOP + _ARROWS, bottom),
        _transitions(timeline.process, axis, tops) if has_tooltips else Markup(""),
        *(_line(row, state, top, axis, has_tooltips) for state, top in tops.items()),
        draw_deadlines(row.deadlines, TOP, TOP + _ARROWS - 4, are_missed=False),
        draw_activations(row.activations, TOP, TOP + _ARROWS - 4),
        draw_deadlines(row.missed, TOP, TOP + _ARROWS - 4, are_missed=True),
        draw_lost(row.lost, TOP, TOP + _ARROWS - 4),
        draw_time_axis(axis, bottom, "time"),
        legend,
    )
    jobs = counted(sum(job.is_in(axis.start, axis.end) for job in timeline.process.jobs), "job")
    subtitle = f"{timeline.process.name}: {time_text(timeline.start)} to {time_text(timeline.end)}, {jobs}"
    return document(timeline.title, subtitle, body, height + MARGIN)


def _heading(axis: TimeAxis) -> Markup:
    x = axis.right + _RIGHT - MARGIN
    return element("text", text("of window"), class_="small muted", x=x, y=TOP + _ARROWS - 6, text_anchor="end")


def _nothing() -> Markup:
    return element("text", text("no job in this window"), class_="muted", x=_LEFT + _GAP, y=TOP + _ARROWS + 18)


def _line(row: DrawnRow, state: State, top: float, axis: TimeAxis, has_tooltips: bool) -> Markup:
    base = top + (_LINE + _BOX) / 2
    share = _time_in(row.row, state, axis) / (axis.end - axis.start)
    return joined(
        (
            element("path", class_="grid", d=f"M{number(axis.left)} {number(base)}H{number(axis.right)}"),
            element("text", text(state), x=MARGIN, y=base - 4),
            draw_boxes(row.boxes[state], row.row.name, row.colour, base - _BOX, _BOX, has_tooltips=has_tooltips),
            draw_borders(row.boxes[state], base - _BOX, _BOX) if state is State.RUNNING else Markup(""),
            element("text", text(f"{100 * share:.2f} %"), class_="small", x=WIDTH - MARGIN, y=base - 4, text_anchor="end"),
        )
    )


def _time_in(process: ProcessRow, state: State, axis: TimeAxis) -> Time:
    return sum(
        axis.clipped(span.end) - axis.clipped(span.start) for job in process.jobs for span in job.spans if span.state is state
    )


def _transitions(process: ProcessRow, axis: TimeAxis, tops: Mapping[State, float]) -> Markup:
    """Vertical lines from each state of a job to the next."""
    path = "".join(
        f"M{number(axis.x(after.start))} {number(tops[before.state] + _LINE / 2)}V{number(tops[after.state] + _LINE / 2)}"
        for job in process.jobs
        for before, after in pairwise(job.spans)
        if before.end == after.start and axis.has(after.start) and before.state in tops and after.state in tops
    )
    return element("path", class_="rule", d=path) if path else Markup("")
