"""Gantt charts: which job is in which state when, by core and process."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros._internal.plural import counted
from amalthea_uros.report.pictures.boxes import MOST_TOOLTIPS
from amalthea_uros.report.pictures.chain_paths import LANE, DrawnPath, draw_path
from amalthea_uros.report.pictures.gantt_legend import legend_entries, legend_notes
from amalthea_uros.report.pictures.gantt_rows import BASE, ROW, DrawnRow, draw_row, lay_out
from amalthea_uros.report.pictures.jobs import CoreRows
from amalthea_uros.report.pictures.page import MARGIN, TOP, WIDTH, document, draw_legend
from amalthea_uros.report.pictures.style import TEXT_SIZE
from amalthea_uros.report.pictures.svg import Markup, element, text, tooltip
from amalthea_uros.report.pictures.text_widths import elided, text_width
from amalthea_uros.report.pictures.time_axis import HEIGHT, TimeAxis, draw_grid
from amalthea_uros.report.pictures.windows import check_window
from amalthea_uros.report.pictures.zoom import drawn_times, zoom_attributes
from amalthea_uros.units import Time, time_text

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
    lanes = TOP
    top = lanes + LANE * len(chart.chains)
    headers, rows, bottom = _lay_out_rows(chart, axis, top)
    has_tooltips = sum(row.number_of_boxes for row in rows) <= MOST_TOOLTIPS
    middles = {row.row.name: row.middle for row in reversed(rows)}
    legend, height = draw_legend(
        legend_entries(rows, has_chains=bool(chart.chains)), legend_notes(rows, axis), bottom + HEIGHT + _GAP
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
    left = MARGIN + _INDENT + min(max(widest, _NARROWEST), _WIDEST) + _GAP
    return TimeAxis(chart.start, chart.end, left, WIDTH - _RIGHT - left)


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
    return headers, rows, y + _GAP


def _band(row: DrawnRow, axis: TimeAxis) -> Markup:
    return element("rect", class_="band", x=MARGIN, y=row.top, width=axis.right - MARGIN, height=ROW)


def _label(row: DrawnRow, axis: TimeAxis) -> Markup:
    name = row.row.name
    shown = elided(name, TEXT_SIZE, axis.left - MARGIN - _INDENT - _GAP)
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
