"""What changes in files, for people and for `patch`."""

from __future__ import annotations

from difflib import unified_diff
from io import StringIO

from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.file_changes import FilesDiff

#: As the programs diff and patch mark the last line of a file that does not end with a line end.
_WITHOUT_END = "\n\\ No newline at end of file\n"


def write(diff: FilesDiff, terminal: Terminal) -> None:
    """Write a unified diff for each file: its own characters for programs, and escapes of the hidden ones for people."""
    shown = _shown if terminal.stream.isatty() else str
    for file in diff.files:
        names = visible(str(file.path)), visible(f"{file.path} ({diff.label})")
        for line in unified_diff(_lines(file.before), _lines(file.after), *names, n=1):
            text = line.removesuffix("\n")
            terminal.stream.write(shown(text) + ("\n" if text != line else _WITHOUT_END))


def _lines(text: str) -> list[str]:
    """The lines of a text as `patch` counts them: only a line feed ends one."""
    return StringIO(text, newline="\n").readlines()


def _shown(line: str) -> str:
    """A line for a terminal, which may have tabs."""
    return "\t".join(map(visible, line.split("\t")))
