"""A description that was written from source code."""

from __future__ import annotations

from amalthea_uros._internal.plural import counted
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.import_code import ImportResult


def write(result: ImportResult, terminal: Terminal) -> None:
    """Write the name of the file, and how many gaps are to be filled."""
    name = "a description" if result.path is None else str(result.path)
    written = "made" if result.path is None else "written"
    terminal.line(f"{name}: {written}, with {counted(result.gaps, 'gap')} to fill (TODO)")
