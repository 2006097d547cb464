"""The differences of two systems in words of timing."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.design.changes.timing_changes import Happening, TimingChange
from amalthea_uros.report.writers.terminal import Terminal

#: The mark and the colour of what is added and removed.
_MARKS = {Happening.ADDED: ("+", "32"), Happening.REMOVED: ("-", "31")}
#: The values that say what an object is, with the words before them.
_TELLING = {"period": "every ", "execution_time": "", "priority": "priority ", "core": "", "frequency": ""}


def write(changes: Sequence[TimingChange], terminal: Terminal) -> None:
    """Write a line for each object; nothing if there is none."""
    if not changes:
        return
    terminal.line(terminal.style("Timing", "1"))
    for change in changes:
        terminal.line(f"  {_text(change, terminal)}")
    terminal.line()
    terminal.line(terminal.style("Objects", "1"))


def _text(change: TimingChange, terminal: Terminal) -> str:
    if change.happening is Happening.CHANGED:
        return f"{change.object}: {', '.join(map(_difference, change.differences))}"
    mark, colour = _MARKS[change.happening]
    stated = {each.key: each.after if change.happening is Happening.ADDED else each.before for each in change.differences}
    values = ", ".join(f"{word}{stated[key]}" for key, word in _TELLING.items() if key in stated)
    return terminal.style(f"{mark} {change.kind} {change.object}", colour) + (f" ({values})" if values else "")


def _difference(difference: Difference) -> str:
    return f"{difference.key.replace('_', ' ')} {difference.before} -> {difference.after}"
