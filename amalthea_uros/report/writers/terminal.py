"""Text for a terminal: findings with their source line, tables that fit the width."""

from __future__ import annotations

import os
import re
from collections.abc import Collection, Iterable, Sequence
from itertools import groupby, islice, zip_longest
from pathlib import Path
from textwrap import wrap
from typing import IO

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.report.basics.display import is_coloured
from amalthea_uros.report.basics.escape import output_line, visible

#: Columns between two cells, and before the first.
GAP = 2

#: What the columns of remarks are called.
_REMARKS = ("", "reason", "how it is computed")

#: Shorter remarks, such as claims, always stay in the table.
_SHORT = 24

#: Columns are not folded more narrowly than this.
_NARROWEST = 12


def column_widths(headings: Sequence[str], cells: Sequence[Sequence[str]]) -> list[int]:
    """The width of each column; cells may have several lines."""
    columns = zip(headings, *cells, strict=True)
    return [max(map(_cell_width, column)) for column in columns]


def _cell_width(cell: str) -> int:
    return max(map(len, cell.split("\n"))) if "\n" in cell else len(cell)


def with_footnotes(headings: Sequence[str], cells: Sequence[Sequence[str]], width: int) -> tuple[list[list[str]], list[str]]:
    """The cells with numbers in the place of remarks that make a table wider than a page, and the footnotes with these numbers.

    Equal remarks have one footnote.
    """
    notes: dict[str, int] = {}
    others = [
        GAP if name in _REMARKS else GAP + column for name, column in zip(headings, column_widths(headings, cells), strict=True)
    ]
    room = max(_SHORT, width - sum(others))

    def shown(heading: str, cell: str) -> str:
        if heading not in _REMARKS or len(cell) <= room:
            return cell
        return f"[{notes.setdefault(cell, len(notes) + 1)}]"

    found = [[shown(heading, cell) for heading, cell in zip(headings, row, strict=True)] for row in cells]
    return found, list(notes)


def folded(headings: Sequence[str], cells: Sequence[Sequence[str]], fixed: Collection[int], width: int) -> list[list[str]]:
    """The cells in several lines where a table would be wider than a page; as wide as needed if even that is not enough.

    Parameters
    ----------
    fixed : columns that are not folded, since they have numbers
    """
    widths = column_widths(headings, cells)
    excess = sum(GAP + column for column in widths) - width
    for column in sorted(set(range(len(widths))) - set(fixed), key=lambda column: -widths[column]):
        if excess <= 0:
            break
        narrower = max(widths[column] - excess, min(widths[column], _NARROWEST), len(headings[column]))
        excess -= widths[column] - narrower
        widths[column] = narrower
    return [[_folded_cell(cell, limit) for cell, limit in zip(row, widths, strict=True)] for row in cells]


def _folded_cell(cell: str, width: int) -> str:
    return cell if len(cell) <= width else "\n".join(wrap(cell, width))


#: Of so many findings of a kind in a row each is written; of more, the first ones.
_WHOLE = 3
#: Of the others so many places.
_PLACES = 8
#: The parts that differ between messages of a kind: names in quotes, and numbers.
_VARIABLE = re.compile(r"""'[^']*'|"[^"]*"|\d[\d,.]*""")


def kind_of_message(finding: Finding) -> tuple[str, Severity, str, str, Path | None]:
    """The properties that findings of a kind in a file share."""
    path = finding.location.path if finding.location else None
    # Gaps of a description need another remedy each.
    return finding.rule, finding.severity, _VARIABLE.sub("", finding.message), _VARIABLE.sub("", finding.help), path


def _more(findings: Sequence[Finding]) -> str:
    """How many more findings of a kind there are, and where."""
    places = dict.fromkeys(finding.location.line for finding in findings if finding.location and finding.location.line)
    lines = ", ".join([*map(str, islice(places, _PLACES)), *(["..."] if len(places) > _PLACES else [])])
    where = f", in line{'s' if len(places) > 1 else ''} {lines}" if places else ""
    return f"and {len(findings):,} more {findings[0].rule} of this kind{where}"


#: Longer source lines are shown in part; scheduler descriptions have a thousand characters.
SNIPPET_WIDTH = 100

#: Wider tables have footnotes where the width of the page is not known.
WIDTH_ELSEWHERE = 120

_COLOURS = {Severity.ERROR: "31", Severity.WARNING: "33", Severity.INFO: "36"}


#: Begins a style until the line is written: a lone surrogate, which no text of a file has.
_STYLE = "\ud800["


class Terminal:
    """Writes to a stream, in colour where the user wants that, by default on terminals."""

    def __init__(self, stream: IO[str]) -> None:
        self.stream = stream
        self.width = _width(stream)
        self.coloured = is_coloured(stream)

    def line(self, text: str = "") -> None:
        """Write one line; of what is not ours in it, hidden characters are shown as escapes."""
        text = text.rstrip()
        # Colours may be wanted in the log of a CI system, too, and a line may begin with text that has none.
        self.stream.write(("\x1b[".join(map(output_line, text.split(_STYLE))) if self.coloured else output_line(text)) + "\n")

    def style(self, text: str, code: str) -> str:
        """The text in an ANSI style ("1" bold, "2" dim, "31" red ...), if colours are on."""
        return f"{_STYLE}{code}m{text}{_STYLE}0m" if self.coloured and text else text

    def heading(self, text: str) -> None:
        """Write a heading with an empty line before it."""
        self.line()
        self.line(self.style(text, "1"))

    def findings(self, findings: Iterable[Finding]) -> None:
        """Write findings: place, rule and message, the source line with a caret, what to do.

        Of many of a kind in a row, the first ones are written, and the places of the others.
        """
        for _, run in groupby(findings, kind_of_message):
            alike = list(run)
            shown = _WHOLE if len(alike) > _WHOLE + 1 else len(alike)
            for finding in alike[:shown]:
                self.finding(finding)
            if others := alike[shown:]:
                self.line(f"  {self.style(_more(others), '2')}")

    def finding(self, finding: Finding) -> None:
        """Write one finding."""
        where = f"{self.style(str(finding.location), '1')}: " if finding.location else ""
        severity = self.style(f"{finding.rule} {finding.severity}", _COLOURS[finding.severity])
        self.line(f"{where}{severity}: {finding.message}")
        if finding.location:
            self.snippet(finding.location)
        if finding.help:
            self.line(f"  {self.style('help:', '36')} {finding.help}")

    def snippet(self, location: Location) -> None:
        """Write the source line of a place and a caret below."""
        if location.text is None or location.line is None or location.column is None:
            return
        text, column = _excerpt(location.text, location.column - 1)
        number = str(location.line)
        tabless = text.replace("\t", " ")
        column = len(visible(tabless[:column]))
        self.line(f"  {self.style(f'{number} |', '34')} {tabless}")
        self.line(f"  {self.style(' ' * len(number) + ' |', '34')} {' ' * column}{self.style('^', '31')}")

    def table(self, headings: Sequence[str], rows: Iterable[Sequence[object]], right: Sequence[int] = ()) -> None:
        """Write rows in columns that are as wide as needed.

        Where a table is wider than the terminal, or than 120 characters elsewhere, long remarks become footnotes. Columns of text
        that are still too wide for a terminal are folded; elsewhere they are not, so that programs find names in one piece.

        Parameters
        ----------
        right : columns that are aligned to the right
        """
        cells = [[visible(str(cell)) for cell in row] for row in rows]
        notes: list[str] = []
        width = self.width or WIDTH_ELSEWHERE
        widths = column_widths(headings, cells)
        if sum(GAP + each for each in widths) > width:
            cells, notes = with_footnotes(headings, cells, width)
            if self.width is not None:
                cells = folded(headings, cells, right, self.width)
            widths = column_widths(headings, cells)
        for is_heading, row in [(True, list(headings)), *((False, row) for row in cells)]:
            for line in zip_longest(*(cell.split("\n") for cell in row), fillvalue="") if self.width is not None else [row]:
                padded = [
                    cell.rjust(width) if i in right else cell.ljust(width)
                    for i, (cell, width) in enumerate(zip(line, widths, strict=True))
                ]
                text = (" " * GAP).join(padded).rstrip()
                self.line(" " * GAP + (self.style(text, "2") if is_heading else text))
        for number, note in enumerate(notes, start=1):
            self.line(f"{' ' * GAP}[{number}] {note}")


def _width(stream: IO[str]) -> int | None:
    """The columns of a terminal, which the user can state in `COLUMNS`; None elsewhere.

    For pipes and files, `COLUMNS` says nothing: Python's `readline` states it for all processes that a program starts.
    """
    if not stream.isatty():
        return None
    stated = os.environ.get("COLUMNS", "")
    if stated.isascii() and stated.isdecimal() and int(stated) > 0:
        return int(stated)
    try:
        return os.get_terminal_size(stream.fileno()).columns or None
    except (OSError, ValueError):  # a terminal that does not know its size
        return None


def _excerpt(text: str, column: int) -> tuple[str, int]:
    """The part of a line around a column that fits, and the column in it."""
    if len(text) <= SNIPPET_WIDTH:
        return text, column
    start = max(0, min(column - SNIPPET_WIDTH // 3, len(text) - SNIPPET_WIDTH))
    end = start + SNIPPET_WIDTH
    before, after = ("..." if start else ""), ("..." if end < len(text) else "")
    return f"{before}{text[start:end]}{after}", column - start + len(before)
