"""What a change does to the results, as a table."""

from __future__ import annotations

from amalthea_uros.analyze.impact import Impact
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.services.impact_text import HEADINGS, RIGHT, cells, unchanged_text


def write(impact: Impact, terminal: Terminal, remark: str = "") -> None:
    """Write a row for each figure that changed, and how many others there are."""
    terminal.heading("Before and after the change" + (f" ({remark})" if remark else ""))
    if impact:
        terminal.table((*HEADINGS[:-1], ""), cells(impact), right=RIGHT)
    terminal.line(f"  {unchanged_text(impact)}")
