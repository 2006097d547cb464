"""The changes that shorten a latency of a chain, for people."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

from amalthea_uros._internal.plural import counted
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.units import time_text

if TYPE_CHECKING:
    from amalthea_uros.design.improvements import Improvement, Improvements

#: Further changes shorten the latency less.
_MOST = 5
#: Further drawbacks of a change are only counted.
_MOST_DRAWBACKS = 3


def write_best(found: Improvements, terminal: Terminal) -> None:
    """Write the change with the greatest effect that breaks nothing, with the options that show all its effects."""
    recommended = next((each for each in found.found if each.is_safe), None)
    if recommended is not None:
        result = f"{time_text(recommended.after)} ({recommended.claim})"
        terminal.line(f"  what helps: {recommended.change.text}, which gives {result}")
        terminal.line(f"  to see all its effects: {shlex.join(recommended.change.options)}")
    elif found.found:
        terminal.line("  what helps: only changes that break something else; the last table shows them")
    else:
        terminal.line(f"  what helps: no single change shortens it: {_tried(found)}")


def write(found: Improvements, terminal: Terminal) -> None:
    """Write the changes with the greatest effect, and what they make worse."""
    best = found.best(_MOST)
    if not best:
        return
    rows = [(each.change.text, _before(each), _after(each), _drawbacks(each)) for each in best]
    headings = ("what would shorten it", "latency", "", "what gets worse" if any(row[-1] for row in rows) else "")
    terminal.table(headings, rows, right=(1,))
    terminal.line(f"  {_tried(found)}")


def _tried(found: Improvements) -> str:
    tried = f"{counted(found.tried, 'change')} analysed, one at a time"
    return f"{tried}; {found.untried:,} more were not tried" if found.untried else tried


def _before(improvement: Improvement) -> str:
    return "unknown" if improvement.before is None else time_text(improvement.before)


def _after(improvement: Improvement) -> str:
    return f"-> {time_text(improvement.after)} ({improvement.claim})"


def _drawbacks(improvement: Improvement) -> str:
    """What gets worse, verdicts first, as they are in an improvement."""
    texts = [f"{each.name}: {each.before} -> {each.after}" for each in improvement.drawbacks]
    more = len(texts) - _MOST_DRAWBACKS
    return "; ".join(texts[:_MOST_DRAWBACKS]) + (f"; {more:,} more" if more > 0 else "")
