"""Text for a terminal: findings with their source line, tables that fit the width."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby, islice, zip_longest
from pathlib import Path
from typing import IO

from amalthea_uros._internal.records import replace
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.report.basics.display import is_coloured, is_standard
from amalthea_uros.report.basics.escape import output_line, visible, visible_cells
from amalthea_uros.report.writers.table_layout import (
    GAP,
    SEVERAL,
    Footnotes,
    broken,
    column_widths,
    folded,
    folded_headings,
    glued,
    left_out,
    unglued,
    with_footnotes,
)

#: Of so many findings of a kind in a row each is written; of more, the first ones.
_WHOLE = 3
#: Longer reasons are not repeated.
_LONG_REASON = 40
#: Of the others so many places.
_PLACES = 8
#: The parts that differ between messages of a kind: names in quotes, and numbers.
_VARIABLE = re.compile(r"""'[^']*'|"[^"]*"|\d[\d,.]*""")


def kind_of_message(finding: Finding) -> tuple[str, Severity, str, str, Path | None]:
    """The properties that findings of a kind in a file share."""
    path = finding.location.path if finding.location else None
    # Gaps of a description need another remedy each.
    return finding.rule, finding.severity, _VARIABLE.sub("", finding.message), _VARIABLE.sub("", finding.help), path


def _without_reason_of(before: Finding, finding: Finding) -> Finding:
    """A finding with a word in place of a long reason that the one before it has, too."""
    what, _, reason = finding.message.partition(": ")
    # A colon in a quoted value is none of the message.
    is_whole = what.count("'") % 2 == 0
    is_repeated = is_whole and len(reason) > _LONG_REASON and before.message.partition(": ")[2] == reason
    return replace(finding, message=f"{what}: for the same reason") if is_repeated else finding


def _more(findings: Sequence[Finding]) -> str:
    """How many more findings of a kind there are, and where."""
    places = dict.fromkeys(finding.location.line for finding in findings if finding.location and finding.location.line)
    lines = ", ".join([*map(str, islice(places, _PLACES)), *(["..."] if len(places) > _PLACES else [])])
    where = f", in line{'s' if len(places) > 1 else ''} {lines}" if places else ""
    return f"and {len(findings):,} more {findings[0].rule} of this kind{where}"


#: Longer source lines are shown in part; scheduler descriptions have a thousand characters.
SNIPPET_WIDTH, _NARROWEST_SNIPPET = 100, 20

#: Wider tables have footnotes where the width of the page is not known.
WIDTH_ELSEWHERE = 120

_COLOURS = {Severity.ERROR: "31", Severity.WARNING: "33", Severity.INFO: "36"}


#: Begins a style until the line is written: a lone surrogate, which no text of a file has.
_STYLE = "\ud800["
_STYLES = re.compile("\ud800\\[\\d+m")


class Terminal:
    """Writes to a stream, in colour where the user wants that, by default on terminals."""

    def __init__(self, stream: IO[str]) -> None:
        self.stream = stream
        self.width = _width(stream)
        self.coloured = is_coloured(stream)
        self.notes = Footnotes()

    def line(self, text: str = "") -> None:
        """Write one line, or several where the terminal is not as wide; hidden characters in it are shown as escapes."""
        text = text.rstrip()
        for part in [text] if self.width is None else wrapped(text, self.width):
            self._write(part)

    def _write(self, text: str) -> None:
        """Write one line as it is."""
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
            for before, finding in zip([None, *alike], alike[:shown], strict=False):
                self.finding(finding if before is None else _without_reason_of(before, finding))
            if others := alike[shown:]:
                self.line(f"  {self.style(_more(others), '2')}")

    def finding(self, finding: Finding) -> None:
        """Write one finding."""
        where = f"{self.style(str(finding.location), '1')}: " if finding.location else ""
        severity = self.style(f"{finding.rule} {finding.grade}", _COLOURS[finding.severity])
        self.line(f"{where}{severity}: {finding.message}")
        if finding.location:
            self.snippet(finding.location)
        if finding.help:
            self.line(f"  {self.style('help:', '36')} {finding.help}")

    def snippet(self, location: Location) -> None:
        """Write the source line of a place and a caret below."""
        if location.text is None or location.line is None or location.column is None:
            return
        number = str(location.line)
        room = (
            SNIPPET_WIDTH if self.width is None else max(_NARROWEST_SNIPPET, min(SNIPPET_WIDTH, self.width - len(number) - 11))
        )
        text, column = _excerpt(location.text, location.column - 1, room)
        tabless = text.replace("\t", " ")
        column = len(visible(tabless[:column]))
        self._write(f"  {self.style(f'{number} |', '34')} {tabless}")
        self._write(f"  {self.style(' ' * len(number) + ' |', '34')} {' ' * column}{self.style('^', '31')}")

    def table(
        self,
        headings: Sequence[str],
        rows: Iterable[Sequence[object]],
        right: Sequence[int] = (),
        spare: Sequence[int] = (),
    ) -> None:
        """Write rows in columns that are as wide as needed.

        Where a table is wider than the terminal, or than 120 characters elsewhere, long remarks become footnotes; one that many rows
        have does so everywhere. Columns of text that are still too wide for a terminal are folded, and spare ones left out; elsewhere
        they are not, so that programs find names in one piece.

        Parameters
        ----------
        right : columns that are aligned to the right
        spare : columns that are left out where there is no room for them
        """
        cells = [visible_cells(map(str, row)) for row in rows]
        before, missing = len(self.notes), list[str]()
        cells = with_footnotes(headings, cells, self.width or WIDTH_ELSEWHERE, self.notes)
        if self.width is not None:
            titles, headings = headings, folded_headings(headings, cells, self.width)
            whole = [index for index in right if not any(SEVERAL in row[index] for row in cells)]
            without = left_out(headings, cells, spare, whole, self.width)
            kept = [index for index in range(len(headings)) if index not in without]
            missing = [titles[index] for index in sorted(without) if titles[index]]
            headings = [headings[index] for index in kept]
            right, whole = ([number for number, index in enumerate(kept) if index in some] for some in (right, whole))
            cells = folded(headings, [[row[index] for index in kept] for row in cells], whole, self.width)
        widths = column_widths(headings, cells)
        layout = (" " * GAP).join(f"%{'' if i in right else '-'}{width or ''}s" for i, width in enumerate(widths))
        for is_heading, row in [(True, list(headings)), *((False, row) for row in cells)]:
            lines = (
                zip_longest(*(cell.split("\n") for cell in row), fillvalue="") if any("\n" in cell for cell in row) else [row]
            )
            for line in lines:
                text = (layout % tuple(line)).rstrip()
                self._write((" " * GAP + (self.style(text, "2") if is_heading else text)).rstrip())
        if missing:
            self.line(f"{' ' * GAP}(no room for: {', '.join(missing)})")
        for note in self.notes.from_number(before + 1):
            self.line(" " * GAP + note)


def _width(stream: IO[str]) -> int | None:
    """The columns of a terminal, which the user can state in `COLUMNS`; of pipes and files only if that is stated.

    Python's `readline` states it for all processes that a program starts, though, together with `LINES`: this says nothing of pipes.
    """
    stated = os.environ.get("COLUMNS", "")
    if stated.isascii() and stated.isdecimal() and int(stated) > 0 and (stream.isatty() or _is_for_pipes(stream)):
        return int(stated)
    if not stream.isatty():
        return None
    try:
        return os.get_terminal_size(stream.fileno()).columns or None
    except (OSError, ValueError):  # a terminal that does not know its size
        return None


def _is_for_pipes(stream: IO[str]) -> bool:
    """Whether `COLUMNS` is meant for what is no terminal: a standard stream, and no number of lines beside it."""
    return is_standard(stream) and "LINES" not in os.environ


def wrapped(text: str, width: int) -> list[str]:
    """A text in lines; those after the first are indented more, and a style ends and begins again with each line.

    Names stay whole unless they are longer than a line.
    """
    if _shown_length(text) <= width:
        return [text]
    indent = len(text) - len(text.lstrip())
    found, length = [" " * indent], indent - 1
    for word in map(unglued, glued(text).split()):
        for number, part in enumerate(_parts(word, width - indent - GAP)):
            blank = " " if number == 0 and found[-1].strip() else ""
            size = _shown_length(part)
            if size and length + 1 + size > width and found[-1].strip():
                found.append(" " * (indent + GAP))
                length, blank = indent + GAP - 1, ""
            found[-1] += blank + part
            length += size + (number == 0)
    return list(_each_styled(found))


def _shown_length(text: str) -> int:
    """The length without styles."""
    return len(_STYLES.sub("", text))


def _parts(word: str, room: int) -> Iterator[str]:
    """A word, or the styles and parts of one that is too long."""
    if _shown_length(word) <= room:
        yield word
        return
    plain = _STYLES.split(word)
    for text, style in zip_longest(plain, _STYLES.findall(word), fillvalue=""):
        yield from broken(text, room)
        yield style


def _each_styled(lines: Iterable[str]) -> Iterator[str]:
    """The lines of a text, of which each has the style that is on: logs and pictures have lines, not the state of a terminal."""
    style, end = "", f"{_STYLE}0m"
    for line in lines:
        body = line.lstrip()
        styles = _STYLES.findall(line)
        before, style = style, (styles[-1] if styles else style)
        style = "" if style == end else style
        yield f"{line[: len(line) - len(body)]}{before}{body}{end if style else ''}"


def _excerpt(text: str, column: int, room: int) -> tuple[str, int]:
    """The part of a line around a column that fits, and the column in it."""
    if len(text) <= room:
        return text, column
    start = max(0, min(column - room // 3, len(text) - room))
    end = start + room
    before, after = ("..." if start else ""), ("..." if end < len(text) else "")
    return f"{before}{text[start:end]}{after}", column - start + len(before)
