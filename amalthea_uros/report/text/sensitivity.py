"""For people: by how much execution times can increase."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.analyze.sensitivity import MAX_FACTOR, Sensitivity
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.units import Rounding, Time, rounded_time_text


def write(found: Sensitivity, terminal: Terminal) -> None:
    """Write a table of factors."""
    terminal.heading("Maximum factors on execution times")
    rows = [("all together", _factor(found.everything), "", "")]
    rows += [
        (name, _factor(factor), _time(found.execution_times[name]), _longest(found, name))
        for name, factor in found.processes.items()
    ]
    terminal.table(("process", "factor", "execution time", "may grow to"), rows, right=(1, 2, 3))


def _time(time: Time | None) -> str:
    return "unknown" if time is None else rounded_time_text(time, Rounding.DOWN)


def _longest(found: Sensitivity, name: str) -> str:
    factor = found.processes[name]
    if factor is None or factor >= MAX_FACTOR:
        return ""
    return _time(found.longest(name))


def _factor(factor: Fraction | None) -> str:
    if factor is None:
        return "none"
    return f"{float(factor):.3f}" if factor < MAX_FACTOR else f"{MAX_FACTOR} or more"
