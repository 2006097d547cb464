"""What a change does to the results, as a table."""

from __future__ import annotations

from amalthea_uros.analyze.impact import Impact
from amalthea_uros.report.basics.document import document
from amalthea_uros.report.documents.analysis import impact_section
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.report.writers.text import write_document


def write(impact: Impact, terminal: Terminal) -> None:
    """Write a row for each figure that changed, and how many others there are."""
    terminal.line()
    write_document(document([impact_section(impact)]), terminal)
