"""Which job is in which state when: Gantt charts of cores and processes, and the timeline of one process."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, replace
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
from amalthea_uros.report.pictures.page import ARROW_END, MARGIN, TOP, WIDTH, Entry, nothing, picture_of, state_look, swatch
from amalthea_uros.report.pictures.svg import (
    TEXT_SIZE,
    Markup,
    element,
    horizontal,
    joined,
    path_of,
    rect_at,
    text_at,
    text_width,
    tipped,
    vertical,
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


def _legend(rows: Sequence[DrawnRow], has_chains: bool = False) -> Iterator[Entry]:
    """Entries of what the rows show."""
    for state, meaning in _MEANINGS.items():
        height = _HEIGHTS.get(state, 9)
        key = element("rect", x=-9, y=6 - height, width=18, height=height, **state_look(state, 0))
        yield any(row.boxes[state] for row in rows), key, meaning
    yield any(row.activations.places for row in rows), draw_activations(_ONE, _UPPER, _LOWER), "activation"
    yield any(row.deadlines.places for row in rows), draw_deadlines(_ONE, _UPPER, _LOWER, are_missed=False), "deadline"
    yield any(row.missed.places for row in rows), draw_deadlines(_ONE, _UPPER, _LOWER, are_missed=True), "missed deadline"
    yield any(row.late for row in rows), swatch("late", 4), "late, after the deadline"
    yield any(row.lost.places for row in rows), draw_lost(_ONE, _UPPER, _LOWER), "lost activation"
    runnable = element("rect", x=-9, y=-6, width=18, height=12, **state_look(State.RUNNING, 0))
    yield any(row.runnables for row in rows), Markup(runnable + rect_at("label", -6, -3, 12, 6, rx=2)), "runnable"
    path = path_of("line", "M-5 0H9", marker_end=ARROW_END) + element("circle", class_="line paper", cx=-6, cy=0, r=3)
    yield has_chains, Markup(path), "path of a chain, and its latency"


def _notes(rows: Sequence[DrawnRow], axis: TimeAxis) -> list[str]:
    """What is left out for lack of room."""
    notes = []
    if any(box.count > 1 for row in rows for boxes in row.boxes.values() for box in boxes):
        narrow = f"{pixels_text(axis, NARROW)} ({NARROW} pixels)"
        notes.append(f"Boxes of less than {narrow} with no visible gap between them are merged, and pale.")
    if any(arrows.are_merged for row in rows for arrows in (row.activations, row.deadlines, row.missed, row.lost)):
        notes.append(f"Arrows less than {pixels_text(axis, NEAR)} ({NEAR:g} pixels) apart are drawn as one.")
    if any(row.omits_runnables for row in rows):
        narrow = f"{pixels_text(axis, NARROWEST_RUNNABLE)} ({NARROWEST_RUNNABLE:g} pixels)"
        notes.append(f"Runnables of less than {narrow} are not shown.")
    return notes


def pixels_text(axis: TimeAxis, pixels: float) -> str:
    """How much time so many pixels are, with two significant digits."""
    time: Time = round(axis.pixel * pixels)
    places = max(len(str(time)) - 2, 0)
    return time_text(round(time, -places))


#: Pixels.
_HEADER, _GAP, _INDENT, _NARROWEST, _WIDEST, _RIGHT = 26, 8, 12, 60, 230, 34


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
    top = TOP + LANE * len(chart.chains)
    headers, rows, bottom = _lay_out_rows(chart, axis, top)
    has_tooltips = sum(row.number_of_boxes for row in rows) <= MOST_TOOLTIPS
    middles = {row.row.name: row.middle for row in reversed(rows)}
    times = (
        draw_grid(axis, top, bottom),
        *(draw_row(row, axis, has_tooltips=has_tooltips) for row in rows),
        *(draw_path(path, index, axis, TOP + LANE * index, middles) for index, path in enumerate(chart.chains)),
    )
    body = (
        *(rect_at("band", MARGIN, row.top, axis.right - MARGIN, ROW) for row in rows[::2]),
        *headers,
        *(_label(row, axis) for row in rows),
        *drawn_times(axis, bottom, times),
    )
    return picture_of(
        chart.title,
        _subtitle(chart, axis),
        body,
        bottom + HEIGHT + _GAP,
        _legend(rows, bool(chart.chains)),
        _notes(rows, axis),
        WIDTH,
        **zoom_attributes(axis, bottom),
    )


def _axis(chart: GanttChart) -> TimeAxis:
    names = [row.name for core in chart.cores for row in core.rows]
    widest = max((text_width(name, TEXT_SIZE) for name in names), default=0)
    left = MARGIN + _INDENT + min(max(widest, _NARROWEST), _WIDEST) + _GAP
    return TimeAxis(chart.start, chart.end, left, WIDTH - _RIGHT - left)


def _lay_out_rows(chart: GanttChart, axis: TimeAxis, top: float) -> tuple[list[Markup], list[DrawnRow], float]:
    """The headers of the cores, the rows below them, and where they end."""
    headers: list[Markup] = []
    rows: list[DrawnRow] = []
    y = top
    for core in chart.cores:
        header = text_at(core.name, MARGIN, y + _HEADER - 8, "header", room=WIDTH - 2 * MARGIN)
        headers.append(tipped(core.name, header))
        y += _HEADER
        for row in core.rows:
            rows.append(lay_out(row, len(rows), y, axis))
            y += ROW
    if not rows:
        headers, y = [*headers, nothing("no process in this window", y + BASE)], y + ROW
    return headers, rows, y + _GAP


def _label(row: DrawnRow, axis: TimeAxis) -> Markup:
    name = row.row.name
    room = axis.left - MARGIN - _INDENT - _GAP
    return tipped(name, text_at(name, MARGIN + _INDENT, row.top + BASE - 6, room=room))


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
_TIMELINE_LEFT, _TIMELINE_RIGHT, _ARROWS, _LINE, _BOX = 110, 90, 24, 28, 16


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
    arrows = TOP, TOP + _ARROWS - 4
    none = text_at("no job in this window", _TIMELINE_LEFT + _GAP, TOP + _ARROWS + 18, "muted")
    body = (
        draw_grid(axis, TOP + _ARROWS, bottom),
        text_at("of window", WIDTH - MARGIN, TOP + _ARROWS - 6, "small muted", anchor="end") if states else none,
        draw_instants((row.activations, row.deadlines), TOP + _ARROWS, bottom),
        _transitions(timeline.process, axis, tops) if has_tooltips else Markup(""),
        *(_state_line(row, state, top, axis, has_tooltips) for state, top in tops.items()),
        draw_deadlines(row.deadlines, *arrows, are_missed=False),
        draw_activations(row.activations, *arrows),
        draw_deadlines(row.missed, *arrows, are_missed=True),
        draw_lost(row.lost, *arrows),
        draw_time_axis(axis, bottom, "time"),
    )
    jobs = counted(sum(job.is_in(axis.start, axis.end) for job in timeline.process.jobs), "job")
    subtitle = f"{timeline.process.name}: {time_text(timeline.start)} to {time_text(timeline.end)}, {jobs}"
    return picture_of(timeline.title, subtitle, body, bottom + HEIGHT + _GAP, _legend([row]), _notes([row], axis))


def _state_line(row: DrawnRow, state: State, top: float, axis: TimeAxis, has_tooltips: bool) -> Markup:
    base = top + (_LINE + _BOX) / 2
    spans = (span for job in row.row.jobs for span in job.spans if span.state is state)
    share = sum(axis.clipped(span.end) - axis.clipped(span.start) for span in spans) / (axis.end - axis.start)
    return joined(
        (
            path_of("grid", horizontal(axis.left, axis.right, base)),
            text_at(state, MARGIN, base - 4),
            draw_boxes(row.boxes[state], row.row.name, row.colour, base - _BOX, _BOX, has_tooltips=has_tooltips),
            draw_borders(row.boxes[state], base - _BOX, _BOX) if state is State.RUNNING else Markup(""),
            text_at(f"{100 * share:.2f} %", WIDTH - MARGIN, base - 4, "small", anchor="end"),
        )
    )


def _transitions(process: ProcessRow, axis: TimeAxis, tops: Mapping[State, float]) -> Markup:
    """Vertical lines from each state of a job to the next."""
    path = "".join(
        vertical(axis.x(after.start), tops[before.state] + _LINE / 2, tops[after.state] + _LINE / 2)
        for job in process.jobs
        for before, after in pairwise(job.spans)
        if before.end == after.start and axis.has(after.start) and before.state in tops and after.state in tops
    )
    return path_of("rule", path)
