"""A measurement for people."""

from __future__ import annotations

from amalthea_uros.measure.series import Measurement
from amalthea_uros.report import measured
from amalthea_uros.report.terminal import Terminal


def write(measurement: Measurement, terminal: Terminal) -> None:
    """Write a table of the times, and of what was subtracted or could not be used."""
    resolution = measured.resolution_text(measurement.resolution)
    trace = f"{measurement.source} ({measurement.format}, clock steps of {resolution})"
    terminal.line(f"{terminal.style('Measurement', '1')} of {trace}")
    terminal.heading("Measured times")
    terminal.table(measured.COLUMNS, map(measured.row, measurement.series), right=measured.RIGHT)
    _table(
        terminal,
        "Baselines (their means are subtracted above; single net times are within the last two columns)",
        NET,
        list(measured.net_rows(measurement)),
    )
    _table(terminal, "Deviation from the standard period", PERIODS, list(measured.period_rows(measurement)))
    _table(terminal, "Events that gave no value", COUNTS, list(measured.count_rows(measurement)))
    methods = list(measured.methods(measurement))
    if methods:
        terminal.heading("How")
        for sentence in methods:
            terminal.line(f"  {sentence}")
    terminal.heading(measured.closing_line(measurement))


NET = ("object", "quantity", "empty (min / mean / max)", "at least", "at most")
PERIODS = ("object", "quantity", "period", "largest deviation")
COUNTS = ("object", "incomplete", "lost", "duplicated", "reordered")


def write_closing(measurement: Measurement, terminal: Terminal) -> None:
    """Write what was measured, in one line."""
    terminal.line(measured.closing_line(measurement))


def _table(terminal: Terminal, heading: str, columns: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
    if rows:
        terminal.heading(heading)
        terminal.table(columns, rows, right=range(2, len(columns)) if columns is not COUNTS else range(1, len(columns)))
