"""What changes in files, for people and for `patch`."""

from __future__ import annotations

from difflib import unified_diff

from amalthea_uros.report.terminal import Terminal
from amalthea_uros.services.file_changes import FilesDiff


def write(diff: FilesDiff, terminal: Terminal) -> None:
    """Write a unified diff for each file."""
    for file in diff.files:
        names = str(file.path), f"{file.path} ({diff.label})"
        for line in unified_diff(file.before.splitlines(), file.after.splitlines(), *names, lineterm="", n=1):
            terminal.stream.write(f"{line}\n")
