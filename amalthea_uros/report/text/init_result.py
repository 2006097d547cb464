"""A description that was written, and what to do with it."""

from __future__ import annotations

import shlex

from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.init import InitResult

#: Commands for a new description, with what they are good for.
_NEXT = (
    ("amuros check {}", "find mistakes"),
    ("amuros analyze {}", "compute response times, latencies and verdicts"),
    ("amuros report {} -o report.html", "show it to others"),
    ("amuros build {}", "make the AMALTHEA model"),
)
#: With a measurement, a log and its markers.
_NEXT_MEASURED = (
    ("amuros measure {1} --markers {2}", "show what was measured"),
    ("amuros calibrate {0} {1} --markers {2}", "put measured times into the description"),
)


def write(result: InitResult, terminal: Terminal) -> None:
    """Write the name of the file, and the next commands."""
    write_closing(result, terminal)
    terminal.heading("Next:")
    files = [shlex.quote(str(path)) for path in (result.path, *result.measurement)]
    following = (*_NEXT, *_NEXT_MEASURED) if result.measurement else _NEXT
    commands = [(command.format(*files), purpose) for command, purpose in following]
    width = max(len(command) for command, _ in commands)
    for command, purpose in commands:
        terminal.line(f"  {command.ljust(width)}  {terminal.style(f'# {purpose}', '2')}")


def write_closing(result: InitResult, terminal: Terminal) -> None:
    """Write the names of the files."""
    terminal.line(f"{terminal.style(str(result.path), '1')}: written from {result.origin}")
    if result.database is not None:
        terminal.line(f"{terminal.style(str(result.database), '1')}: the frames of others on its bus")
    if result.measurement:
        terminal.line(f"{', '.join(terminal.style(str(path), '1') for path in result.measurement)}: its measurement")
