"""Files that were generated for the build of the firmware, for people."""

from __future__ import annotations

from amalthea_uros.report.memory_text import memory_rows
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.generate import GenerateResult
from amalthea_uros.uros.generated_options import values_of


def write(result: GenerateResult, terminal: Terminal) -> None:
    """Write the names of the files, the options in them, the memory of the description, and what to do next."""
    write_closing(result, terminal)
    rows = [
        (option.name, option.text(value), option.unit, option.text(option.available), option.counts)
        for option, value in values_of(result.assembly.options)
    ]
    terminal.heading("Build options" if rows else "Build options: the defaults of the middleware hold")
    if rows:
        terminal.table(("option", "generated", "", "described", "what it counts"), rows, right=(1, 3))
    saved = result.assembly.memory.total - result.memory.total
    compared = f" ({saved} B less than described)" if saved > 0 else ""
    terminal.heading(f"Memory with these options{compared}")
    terminal.table(("part", "size", ""), memory_rows(result.memory), right=(1,))
    if result.folder is not None:
        terminal.line("")
        terminal.line("The values are compiled into the library of the middleware: rebuild it from clean, or nothing changes.")


def write_closing(result: GenerateResult, terminal: Terminal) -> None:
    """Write the names of the files."""
    for name in result.texts:
        path = name if result.folder is None else str(result.folder / name)
        terminal.line(f"{terminal.style(path, '1')}: generated from {result.description}")
