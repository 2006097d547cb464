"""What canonical form changes, for people."""

from __future__ import annotations

from difflib import unified_diff

from amalthea_uros.report.terminal import Terminal
from amalthea_uros.services.format import FormatDiff


def write(diff: FormatDiff, terminal: Terminal) -> None:
    """Write a unified diff for each file."""
    for file in diff.result.changed:
        names = str(file.path), f"{file.path} (canonical)"
        for line in unified_diff(file.before.splitlines(), file.after.splitlines(), *names, lineterm="", n=1):
            terminal.stream.write(f"{line}\n")
