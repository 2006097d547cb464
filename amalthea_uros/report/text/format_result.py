"""Which files were not in canonical form, for people."""

from __future__ import annotations

from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.format import FormatResult


def write(result: FormatResult, terminal: Terminal) -> None:
    """Write a line for each file."""
    done = "rewritten" if result.is_written else "would be rewritten"
    for file in result.changed:
        terminal.line(f"{file.path}: {done}")
