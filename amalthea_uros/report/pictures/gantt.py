"""Which job is in which state when: Gantt charts of cores and processes, and the timeline of one process."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from amalthea_uros._internal.plural import counted
from amalthea_uros.report.pictures.axes import (
    HEIGHT,
    TimeAxis,
    check_window,
    draw_grid,
    draw_time_axis,
    drawn_times,
    zoom_attributes,
)
from amalthea_uros.report.pictures.chain_paths import LANE, DrawnPath, draw_path
from amalthea_uros.report.pictures.job_rows import (
    BASE,
    MOST_TOOLTIPS,
    NARROW,
    NARROWEST_RUNNABLE,
    NEAR,
    ROW,
    Arrows,
    DrawnRow,
    draw_activations,
    draw_borders,
    draw_boxes,
    draw_deadlines,
    draw_instants,
    draw_lost,
    draw_row,
    lay_out,
)
from amalthea_uros.report.pictures.jobs import CoreRows, ProcessRow, State
from amalthea_uros.report.pictures.svg import (
    ARROW_END,
    MARGIN,
    TEXT_SIZE,
    TOP,
    WIDTH,
    LegendEntry,
    Markup,
    document,
    draw_legend,
    element,
    elided,
    joined,
    number,
    state_look,
    text,
    text_width,
    tooltip,
)
from amalthea_uros.units import Time, time_text

_MEANINGS = {
    State.RUNNING: "running",
    State.READY: "ready (preempted)",
    State.WAITING: "waiting for an event",
    State.POLLING: "polling (holds the core)",
    State.PARKING: "parking (preempted while polling)",
    State.ACTIVE: "activated, not started",
}
_HEIGHTS = {State.RUNNING: 12, State.POLLING: 12, State.ACTIVE: 6}
_ONE = Arrows(((0.0, 1),))
_LOWER, _UPPER = 7, -7


def legend_entries(rows: Sequence[DrawnRow], *, has_chains: bool) -> list[LegendEntry]:
    """Entries of what the rows show."""
    return [*state_entries({state for row in rows for state, boxes in row.boxes.items() if boxes}), *_marks(rows, has_chains)]


def state_entries(states: set[State]) -> list[LegendEntry]:
    """Entries of the states."""
    return [LegendEntry(_state_key(state), meaning) for state, meaning in _MEANINGS.items() if state in states]


def _state_key(state: State) -> Markup:
    height = _HEIGHTS.get(state, 9)
    return element("rect", x=-9, y=6 - height, width=18, height=height, **state_look(state, 0))


def _marks(rows: Sequence[DrawnRow], has_chains: bool) -> Iterable[LegendEntry]:
    if any(row.activations.places for row in rows):
        yield LegendEntry(draw_activations(_ONE, _UPPER, _LOWER), "activation")
    if any(row.deadlines.places for row in rows):
        yield LegendEntry(draw_deadlines(_ONE, _UPPER, _LOWER, are_missed=False), "deadline")
    if any(row.missed.places for row in rows):
        yield LegendEntry(draw_deadlines(_ONE, _UPPER, _LOWER, are_missed=True), "missed deadline")
    if any(row.late for row in rows):
        yield LegendEntry(element("rect", class_="late", x=-9, y=-2, width=18, height=4), "late, after the deadline")
    if any(row.lost.places for row in rows):
        yield LegendEntry(draw_lost(_ONE, _UPPER, _LOWER), "lost activation")
    if any(row.runnables for row in rows):
        ground = element("rect", x=-9, y=-6, width=18, height=12, **state_look(State.RUNNING, 0))
        yield LegendEntry(Markup(ground + element("rect", class_="label", x=-6, y=-3, width=12, height=6, rx=2)), "runnable")
    if has_chains:
        line = element("path", class_="line", d="M-5 0H9", marker_end=ARROW_END)
        yield LegendEntry(
            Markup(line + element("circle", class_="line paper", cx=-6, cy=0, r=3)), "way of a chain, and its latency"
        )


def legend_notes(rows: Sequence[DrawnRow], axis: TimeAxis) -> list[str]:
    """What is left out for lack of room."""
    notes = []
    if any(box.count > 1 for row in rows for boxes in row.boxes.values() for box in boxes):
        notes.append(
            f"Boxes of less than {pixels_text(axis, NARROW)} ({NARROW} pixels) with no visible gap between them are merged, and pale."
        )
    if any(arrows.are_merged for row in rows for arrows in (row.activations, row.deadlines, row.missed, row.lost)):
        notes.append(f"Arrows less than {pixels_text(axis, NEAR)} ({NEAR:g} pixels) apart are drawn as one.")
    if any(row.omits_runnables for row in rows):
        notes.append(
            f"Runnables of less than {pixels_text(axis, NARROWEST_RUNNABLE)} ({NARROWEST_RUNNABLE:g} pixels) are not shown."
        )
    return notes


def pixels_text(axis: TimeAxis, pixels: float) -> str:
    """How much time so many pixels are, with two significant digits."""
    time: Time = round(axis.pixel * pixels)
    places = max(len(str(time)) - 2, 0)
    return time_text(round(time, -places))


#: Pixels.
_HEADER, _GAP_GANTT, _INDENT, _NARROWEST, _WIDEST, _RIGHT_GANTT = 26, 8, 12, 60, 230, 34


@dataclass(frozen=True, slots=True)
class GanttChart:
    """A Gantt chart.

    Attributes
    ----------
    start, end : of the window
    cores : with their processes, from top to bottom
    chains : whose ways are drawn above the jobs

    Raises
    ------
    InvalidArgumentError : the window does not end after it starts.
    """

    title: str
    start: Time
    end: Time
    cores: tuple[CoreRows, ...]
    chains: tuple[DrawnPath, ...] = ()

    def __post_init__(self) -> None:
        check_window(self.start, self.end)


def gantt(chart: GanttChart) -> str:
    """The chart as SVG."""
    axis = _axis(chart)
    lanes = TOP
    top = lanes + LANE * len(chart.chains)
    headers, rows, bottom = _lay_out_rows(chart, axis, top)
    has_tooltips = sum(row.number_of_boxes for row in rows) <= MOST_TOOLTIPS
    middles = {row.row.name: row.middle for row in reversed(rows)}
    legend, height = draw_legend(
        legend_entries(rows, has_chains=bool(chart.chains)), legend_notes(rows, axis), bottom + HEIGHT + _GAP_GANTT
    )
    body = (
        *(_band(row, axis) for row in rows[::2]),
        *headers,
        *(_label(row, axis) for row in rows),
        *drawn_times(
            axis,
            bottom,
            (
                draw_grid(axis, top, bottom),
                *(draw_row(row, axis, has_tooltips=has_tooltips) for row in rows),
                *(draw_path(way, index, axis, lanes + LANE * index, middles) for index, way in enumerate(chart.chains)),
            ),
        ),
        legend,
    )
    return document(chart.title, _subtitle(chart, axis), body, height + MARGIN, WIDTH, **zoom_attributes(axis, bottom))


def _axis(chart: GanttChart) -> TimeAxis:
    names = [row.name for core in chart.cores for row in core.rows]
    widest = max((text_width(name, TEXT_SIZE) for name in names), default=0)
    left = MARGIN + _INDENT + min(max(widest, _NARROWEST), _WIDEST) + _GAP_GANTT
    return TimeAxis(chart.start, chart.end, left, WIDTH - _RIGHT_GANTT - left)


def _lay_out_rows(chart: GanttChart, axis: TimeAxis, top: float) -> tuple[list[Markup], list[DrawnRow], float]:
    """The headers of the cores, the rows below them, and where they end."""
    headers: list[Markup] = []
    rows: list[DrawnRow] = []
    y = top
    for core in chart.cores:
        name = elided(core.name, TEXT_SIZE, WIDTH - 2 * MARGIN, is_bold=True)
        headers.append(element("text", tooltip(core.name), text(name), class_="header", x=MARGIN, y=y + _HEADER - 8))
        y += _HEADER
        for row in core.rows:
            rows.append(lay_out(row, len(rows), y, axis))
            y += ROW
    if not rows:
        message = element("text", text("no process in this window"), class_="muted", x=MARGIN, y=y + BASE)
        headers, y = [*headers, message], y + ROW
    return headers, rows, y + _GAP_GANTT


def _band(row: DrawnRow, axis: TimeAxis) -> Markup:
    return element("rect", class_="band", x=MARGIN, y=row.top, width=axis.right - MARGIN, height=ROW)


def _label(row: DrawnRow, axis: TimeAxis) -> Markup:
    name = row.row.name
    shown = elided(name, TEXT_SIZE, axis.left - MARGIN - _INDENT - _GAP_GANTT)
    return element("text", tooltip(name), text(shown), x=MARGIN + _INDENT, y=row.top + BASE - 6)


def _subtitle(chart: GanttChart, axis: TimeAxis) -> str:
    rows = [row for core in chart.cores for row in core.rows]
    jobs = [job for row in rows for job in row.jobs if job.is_in(chart.start, chart.end)]
    missed = sum(axis.has(job.deadline) and job.misses_deadline(axis.end) for job in jobs)
    parts = [
        f"{time_text(chart.start)} to {time_text(chart.end)}",
        counted(len(rows), "process"),
        counted(len(jobs), "job"),
        *([counted(missed, "missed deadline")] if missed else []),
    ]
    return ", ".join(parts)


#: Pixels.
_TIMELINE_LEFT, _TIMELINE_RIGHT, _ARROWS, _LINE, _BOX, _GAP = 110, 90, 24, 28, 16, 8


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
    axis = TimeAxis(timeline.start, timeline.end, _TIMELINE_LEFT, WIDTH - _TIMELINE_LEFT - _TIMELINE_RIGHT)
    row = replace(lay_out(timeline.process, 0, TOP, axis), late=(), runnables=(), omits_runnables=False)
    states = [state for state in reversed(State) if row.boxes[state]]
    tops = {state: TOP + _ARROWS + _LINE * index for index, state in enumerate(states)}
    bottom = TOP + _ARROWS + _LINE * max(len(states), 1) + _GAP
    has_tooltips = row.number_of_boxes <= MOST_TOOLTIPS
    legend, height = draw_legend(legend_entries([row], has_chains=False), legend_notes([row], axis), bottom + HEIGHT + _GAP)
    body = (
        draw_grid(axis, TOP + _ARROWS, bottom),
        _timeline_heading(axis) if states else _no_job(),
        draw_instants((row.activations, row.deadlines), TOP + _ARROWS, bottom),
        _transitions(timeline.process, axis, tops) if has_tooltips else Markup(""),
        *(_state_line(row, state, top, axis, has_tooltips) for state, top in tops.items()),
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


def _timeline_heading(axis: TimeAxis) -> Markup:
    x = axis.right + _TIMELINE_RIGHT - MARGIN
    return element("text", text("of window"), class_="small muted", x=x, y=TOP + _ARROWS - 6, text_anchor="end")


def _no_job() -> Markup:
    return element("text", text("no job in this window"), class_="muted", x=_TIMELINE_LEFT + _GAP, y=TOP + _ARROWS + 18)


def _state_line(row: DrawnRow, state: State, top: float, axis: TimeAxis, has_tooltips: bool) -> Markup:
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
