"""The legend of Gantt charts and state timelines: only what they show."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros.report.pictures.arrows import NEAR, Arrows, draw_activations, draw_deadlines, draw_lost
from amalthea_uros.report.pictures.boxes import NARROW
from amalthea_uros.report.pictures.gantt_rows import DrawnRow
from amalthea_uros.report.pictures.jobs import State
from amalthea_uros.report.pictures.page import LegendEntry
from amalthea_uros.report.pictures.runnable_boxes import NARROWEST
from amalthea_uros.report.pictures.style import ARROW_END, state_look
from amalthea_uros.report.pictures.svg import Markup, element
from amalthea_uros.report.pictures.time_axis import TimeAxis
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
        notes.append(f"Runnables of less than {pixels_text(axis, NARROWEST)} ({NARROWEST:g} pixels) are not shown.")
    return notes


def pixels_text(axis: TimeAxis, pixels: float) -> str:
    """How much time so many pixels are, with two significant digits."""
    time: Time = round(axis.pixel * pixels)
    places = max(len(str(time)) - 2, 0)
    return time_text(round(time, -places))
