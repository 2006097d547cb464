"""A description that was written, and what to do with it."""

from __future__ import annotations

import shlex

from amalthea_uros.report.terminal import Terminal
from amalthea_uros.services.init import InitResult

#: Commands for a new description, with what they are good for.
_NEXT = (
    ("amuros check {}", "find mistakes"),
    ("amuros analyze {}", "compute response times, latencies and verdicts"),
    ("amuros report {} -o report.html", "show it to others"),
    ("amuros build {}", "make the AMALTHEA model"),
)


def write(result: InitResult, terminal: Terminal) -> None:
    """Write the name of the file, and the next commands."""
    write_closing(result, terminal)
    terminal.heading("Next:")
    commands = [(command.format(shlex.quote(str(result.path))), purpose) for command, purpose in _NEXT]
    width = max(len(command) for command, _ in commands)
    for command, purpose in commands:
        terminal.line(f"  {command.ljust(width)}  {terminal.style(f'# {purpose}', '2')}")


def write_closing(result: InitResult, terminal: Terminal) -> None:
    """Write the name of the file."""
    terminal.line(f"{terminal.style(str(result.path), '1')}: written from {result.origin}")
