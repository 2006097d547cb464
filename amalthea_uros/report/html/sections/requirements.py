"""All requirements."""

from __future__ import annotations

from amalthea_uros.report.html.badges import verdict_badge
from amalthea_uros.report.html.blocks import Section, table
from amalthea_uros.report.judged import judged_rows, why
from amalthea_uros.services.report import ReportContent


def section(content: ReportContent) -> Section | None:
    """Every deadline, requirement and constraint, the worst first."""
    rows = judged_rows(content.analysis)
    if not rows:
        return None
    titles = ("requirement", "what", ">value", ">limit", ">margin", ">used", "claim", "verdict", "why")
    cells = [
        (row.item.name, row.what, row.value, row.limit, row.margin, row.used, row.claim, verdict_badge(row.item), why(row.item))
        for row in rows
    ]
    lead = "“Met” and “missed” are certain; a limit between the known ends of a value is unknown, with its cause."
    return Section("requirements", "All requirements", lead, [table("Deadlines, requirements and constraints", titles, cells)])
