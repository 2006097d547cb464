"""What `--set` changed."""

from __future__ import annotations

from amalthea_uros.analyze.impact import Effect, impact
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.report.closing_line import closing_line
from amalthea_uros.report.html.blocks import Badge, Block, Cell, Section, Sentences, Tone, table
from amalthea_uros.services.impact_text import cells, unchanged_text
from amalthea_uros.services.report import ReportContent

_TONES = {Effect.BETTER: Tone.GOOD, Effect.WORSE: Tone.BAD, Effect.UNKNOWN: Tone.UNKNOWN}


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
            *_impact(content.before, content.analysis),
            Sentences([f"Before the changes: {closing_line(content.before.summary)}"]),
        ),
    )


def _impact(before: Analysis, after: Analysis) -> list[Block]:
    """The results that changed."""
    found = impact(before, after)
    rows: list[tuple[Cell, ...]] = [
        (*cell[:-2], Badge(cell[-2], _TONES.get(row.effect, Tone.NEUTRAL)), cell[-1])
        for row, cell in zip(found.rows, cells(found), strict=True)
    ]
    titles = ("object", "quantity", ">before", ">after", "effect", "claim or reason")
    unchanged = Sentences([f"{unchanged_text(found)}."])
    return [table("Results before and after the changes", titles, rows), unchanged] if rows else [unchanged]
