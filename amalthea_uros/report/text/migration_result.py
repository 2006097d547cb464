"""What a migration did, for people."""

from __future__ import annotations

from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.report.migration import steps, summary
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.services.migrate import MigrationResult

#: Longer examples, such as a whole element as text, are cut.
_WIDTH = 60


def write(result: MigrationResult, terminal: Terminal) -> None:
    """Write the files, what each step did, and the sum of it."""
    for file in result.files:
        version = f"{spelled(file.version)}, " if file.version else ""
        where = f" to {file.target}" if file.target is not None else ""
        terminal.line(f"{terminal.style(str(file.path), '1')}: {version}{file.state}{where}")
    for step in steps(result):
        terminal.heading(step.title)
        rows = [
            (
                f"{group.count:,}",
                group.first.kind,
                group.first.message,
                _shortened(group.first.detail or group.first.object),
                group.place,
            )
            for group in step.groups
        ]
        terminal.table(("number", "", "what", "example", "first"), rows, right=(0,))
    if result.files:
        terminal.line()
    write_closing(result, terminal)


def write_closing(result: MigrationResult, terminal: Terminal) -> None:
    """Write the sum of what was done."""
    terminal.line(summary(result))


def _shortened(text: str) -> str:
    """Text for a cell: one line that is not too long."""
    line = " ".join(text.split())
    return line if len(line) <= _WIDTH else f"{line[: _WIDTH - 3]}..."
