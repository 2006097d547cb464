"""What `--set` changed."""

from __future__ import annotations

from amalthea_uros.report.closing_line import closing_line
from amalthea_uros.report.html.blocks import Section, Sentences, table
from amalthea_uros.services.report import ReportContent


def section(content: ReportContent) -> Section | None:
    """The values before and after, and the verdict without the changes."""
    if content.before is None:
        return None
    rows = [(each.target, each.before, each.after) for each in content.differences]
    return Section(
        "changes",
        "What was changed",
        "This report is about the system with these changes; the files are as they were.",
        (
            table("Changed values", ("value", "before", "after"), rows),
            Sentences([f"Before the changes: {closing_line(content.before.summary)}"]),
        ),
    )
