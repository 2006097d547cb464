"""A migration as Markdown."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.report.markdown_text import table
from amalthea_uros.report.migration import steps, summary
from amalthea_uros.services.migrate import MigrationResult


def lines(result: MigrationResult) -> Iterator[str]:
    """The files, everything that was lost, and what each step did."""
    yield from (f"# Migration to {spelled(result.version)}", "", summary(result), "", "## Files", "")
    files = [(file.path, file.version or "unknown", file.state, file.target or "") for file in result.files]
    yield from table(("file", "version", "", "result"), files)
    if result.lost:
        yield from ("", "## Lost", "")
        lost = [(c.object, c.location or "", c.message, c.detail) for c in result.lost]
        yield from table(("object", "place", "what", "detail"), lost)
    for step in steps(result):
        yield from ("", f"## {step.title}", "")
        rows = [
            (group.first.kind, f"{group.count:,}", group.first.message, group.place, group.first.detail)
            for group in step.groups
        ]
        yield from table(("", "number", "what", "first", "example"), rows)
    if result.findings:
        yield from ("", "## Findings", "")
        findings = [(f.location or "", f.rule, f.severity, f.message) for f in result.findings]
        yield from table(("place", "id", "severity", "message"), findings)
