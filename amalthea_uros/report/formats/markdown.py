"""Markdown, for a wiki or the description of a change."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from typing import IO, TYPE_CHECKING

from amalthea_uros.report.escape import visible

if TYPE_CHECKING:
    from amalthea_uros.services.migrate import MigrationResult

RENDERS = ("MigrationResult",)

#: Characters that may be markup; an underscore between letters never is.
_SPECIAL = re.compile(r"[\\|<>*`\[\]~&]|(?<![^\W_])_|_(?![^\W_])")


def write(result: MigrationResult, stream: IO[str]) -> None:
    """Write the files, everything that was lost, and what each step did."""
    stream.write("\n".join(_lines(result)) + "\n")


def _lines(result: MigrationResult) -> Iterator[str]:
    from amalthea_uros.metamodel.versions import spelled
    from amalthea_uros.report.migration import steps, summary

    yield from (f"# Migration to {spelled(result.version)}", "", summary(result), "", "## Files", "")
    files = [(file.path, file.version or "unknown", file.state, file.target or "") for file in result.files]
    yield from _table(("file", "version", "", "result"), files)
    if result.lost:
        yield from ("", "## Lost", "")
        lost = [(c.object, c.location or "", c.message, c.detail) for c in result.lost]
        yield from _table(("object", "place", "what", "detail"), lost)
    for step in steps(result):
        yield from ("", f"## {step.title}", "")
        rows = [
            (group.first.kind, f"{group.count:,}", group.first.message, group.place, group.first.detail)
            for group in step.groups
        ]
        yield from _table(("", "number", "what", "first", "example"), rows)
    if result.findings:
        yield from ("", "## Findings", "")
        findings = [(f.location or "", f.rule, f.severity, f.message) for f in result.findings]
        yield from _table(("place", "id", "severity", "message"), findings)


def _table(headings: Sequence[str], rows: Iterable[Sequence[object]]) -> Iterator[str]:
    for cells in (headings, ["---"] * len(headings), *rows):
        yield f"| {' | '.join(_escaped(str(cell)) for cell in cells)} |"


def _escaped(text: str) -> str:
    """Text that cannot end the cell, nor be taken for markup."""
    return visible(_SPECIAL.sub(r"\\\g<0>", text))
