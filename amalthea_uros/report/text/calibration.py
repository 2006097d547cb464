"""What a calibration wrote into a description, for people."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.compare.calibration.values import CalibratedValue, Outcome
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.calibrate import Calibration
from amalthea_uros.units import Rounding, rounded_time_text, time_text

_COLUMNS = ("value", "samples", "min", "mean", "max", "described", "now", "")
_RIGHT = (1, 2, 3, 4)
#: A longer value, such as a histogram, is shown by its beginning.
_LONGEST = 32


def write(calibration: Calibration, terminal: Terminal) -> None:
    """Write a row for each measured value, and how many are written."""
    terminal.heading("Measured values and the description")
    terminal.table(_COLUMNS, map(_row, calibration.values), right=_RIGHT)
    terminal.line()
    write_closing(calibration, terminal)


def write_closing(calibration: Calibration, terminal: Terminal) -> None:
    """Write how many values are written, and how many the measurement refutes."""
    terminal.line(closing_line(calibration))


def closing_line(calibration: Calibration) -> str:
    """How many values are written, and how many the measurement refutes."""
    values = calibration.values
    numbers = {outcome: sum(value.outcome is outcome for value in values) for outcome in Outcome}
    parts = [f"{number} {outcome}" for outcome, number in numbers.items() if number]
    refuted = sum(bool(value.refuted) for value in values)
    doubt = f"; the measurement refutes {counted(refuted, 'value')} of the description" if refuted else ""
    return f"{counted(len(values), 'measured value')}: {', '.join(parts) or 'none'}{doubt}"


def _row(value: CalibratedValue) -> tuple[str, ...]:
    statistics = value.statistics
    return (
        value.target,
        f"{statistics.count:,}",
        time_text(statistics.min),
        rounded_time_text(statistics.mean, Rounding.NEAREST),
        time_text(statistics.max),
        _shortened(value.before),
        _shortened(value.after),
        f"{value.outcome}, refuted" if value.refuted else str(value.outcome),
    )


def _shortened(text: str | None) -> str:
    """A value on one line."""
    line = " ".join((text or "").split())
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 3]}..."
