"""Markdown, for a wiki, the description of a change, or a comment of a CI system."""

from __future__ import annotations

from typing import IO

from amalthea_uros.report.documents import document_of

RENDERS = ("Comparison", "Measurement", "MigrationResult", "ReportContent")

#: GitHub accepts 65,536 characters in a comment; names may be long.
_MOST_CHARACTERS = 60_000
_MOST_IN_CELL = 80


def write(result: object, stream: IO[str]) -> None:
    """Write the document of a result; the summary of a report is short enough for a comment."""
    from amalthea_uros.report.writers.markdown import lines

    is_summary = type(result).__name__ == "ReportContent"
    length = 0
    for line in lines(document_of(result), 2, _MOST_IN_CELL) if is_summary else lines(document_of(result)):
        length += len(line) + 1
        if is_summary and length > _MOST_CHARACTERS:
            stream.write("\nThe rest is left out, because comments have a limited length.\n")
            return
        stream.write(line + "\n")
