"""For people: by how much execution times can increase."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.analyze.sensitivity import MAX_FACTOR, Sensitivity
from amalthea_uros.report.terminal import Terminal


def write(found: Sensitivity, terminal: Terminal) -> None:
    """Write a table of factors."""
    terminal.heading("Maximum factors on execution times")
    rows = [("all together", _factor(found.everything)), *((name, _factor(f)) for name, f in found.processes.items())]
    terminal.table(("process", "factor"), rows, right=(1,))


def _factor(factor: Fraction | None) -> str:
    if factor is None:
        return "none"
    return f"{float(factor):.3f}" if factor < MAX_FACTOR else f"{MAX_FACTOR} or more"
