"""Documents as Markdown, for a wiki, the description of a change, or a comment of a CI system."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import IO

from amalthea_uros.report.basics.document import Block, ResultDocument, Sentences, Table, table
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.documents import document_of

#: Characters that may be markup; an underscore between letters never is.
_SPECIAL = re.compile(r"[\\|<>*`\[\]~&]|(?<![^\W_])_|_(?![^\W_])")

#: GitHub accepts 65,536 characters in a comment; names may be long.
_MOST_CHARACTERS = 60_000
_MOST_IN_CELL = 80


def write(result: object, stream: IO[str]) -> None:
    """Write the document of a result; the summary of a report is short enough for a comment."""
    is_summary = type(result).__name__ == "ReportContent"
    length = 0
    for line in lines(document_of(result), 2, _MOST_IN_CELL) if is_summary else lines(document_of(result)):
        length += len(line) + 1
        if is_summary and length > _MOST_CHARACTERS:
            stream.write("\nThe rest is left out, because comments have a limited length.\n")
            return
        stream.write(line + "\n")


def lines(document: ResultDocument, level: int = 1, most_characters: int | None = None) -> Iterator[str]:
    """The title, the outcome in bold, what it is about, and the sections; tables without columns in which there is nothing.

    Parameters
    ----------
    level : of the title
    most_characters : longer texts in cells are shortened
    """
    yield f"{'#' * level} {escaped(document.title)}"
    if document.closing:
        yield from ("", f"**{escaped(document.closing)}**")
    if document.opening:
        yield from ("", escaped(document.opening))
    for section in document.sections:
        yield from ("", f"{'#' * (level + 1)} {escaped(section.title)}")
        for block in section.blocks:
            yield from ("", *block_lines(block, most_characters))
    if document.findings:
        rows = [(str(each.location or ""), each.rule, each.grade, each.message) for each in document.findings]
        findings = table("", ("place", "id", "severity", "message"), rows)
        yield from ("", f"{'#' * (level + 1)} Findings", "", *block_lines(findings, most_characters))


def block_lines(block: Block, most_characters: int | None) -> Iterator[str]:
    """The lines of a block; what can only be shown on a page has none."""
    match block:
        case Table():
            yield from table_lines(block.compact, most_characters)
        case Sentences(sentences=(sentence,)):
            yield escaped(str(sentence))
        case Sentences(sentences=sentences):
            yield from (f"- {escaped(str(sentence))}" for sentence in sentences)


def table_lines(table: Table, most_characters: int | None) -> Iterator[str]:
    """The lines of a table."""
    rules = ["---:" if column.is_number else "---" for column in table.columns]
    for cells in ([column.title for column in table.columns], rules, *table.rows):
        texts = (shortened(str(cell), most_characters) for cell in cells)
        yield f"| {' | '.join(map(escaped, texts))} |"


def shortened(text: str, most: int | None) -> str:
    """The text, or its start if it is long: a name may be of any length."""
    return text if most is None or len(text) <= most else f"{text[:most]}\N{HORIZONTAL ELLIPSIS}"


def escaped(text: str) -> str:
    """Text that cannot end the cell, nor be taken for markup."""
    return visible(_SPECIAL.sub(r"\\\g<0>", text))
