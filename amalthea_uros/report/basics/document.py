"""A document: what a result shows, for all writers: text for terminals, HTML, and Markdown.

The modules in `documents` build it from results, and do not know the writers.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from enum import StrEnum
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding

#: Longer tables are folded after so many rows.
_MOST_ROWS, _ROWS_OF_LONG = 30, 15


#: What a cell shows if there is nothing to show.
_NOTHING = ("", "-")


class Tone(StrEnum):
    """How something is marked: by an icon, a word and a colour."""

    GOOD = "good"
    BAD = "bad"
    UNKNOWN = "unknown"
    NEUTRAL = "neutral"

    @property
    def icon(self) -> str:
        """A sign that needs no colour."""
        return {Tone.GOOD: "✓", Tone.BAD: "✗", Tone.UNKNOWN: "?", Tone.NEUTRAL: "-"}[self]


@dataclass(frozen=True, slots=True)
class Badge:
    """A verdict or a severity: a word that may be marked."""

    word: str
    tone: Tone

    def __str__(self) -> str:
        return self.word


Cell: TypeAlias = str | Badge


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table; numbers are aligned to the right.

    Attributes
    ----------
    spare : the columns with the highest number are left out first where there is no room for all; 0: never
    """

    title: str
    is_number: bool = False
    spare: int = 0


@dataclass(frozen=True, slots=True)
class Table:
    """A table; the first cell of a row is its heading."""

    caption: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[Cell]]
    kind: str = "table"

    def __bool__(self) -> bool:
        return bool(self.rows)

    @property
    def right(self) -> tuple[int, ...]:
        """The columns that are aligned to the right."""
        return tuple(number for number, column in enumerate(self.columns) if column.is_number)

    @property
    def spare(self) -> tuple[int, ...]:
        """The columns that can be left out, the first ones first."""
        found = (number for number, column in enumerate(self.columns) if column.spare)
        return tuple(sorted(found, key=lambda number: -self.columns[number].spare))

    @property
    def compact(self) -> Table:
        """The table without the columns in which there is nothing."""
        kept = [number for number in range(len(self.columns)) if any(row[number] not in _NOTHING for row in self.rows)]
        columns = [self.columns[number] for number in kept]
        return Table(self.caption, columns, [[row[number] for number in kept] for row in self.rows])

    def first(self, most: int) -> Table:
        """The table with at most so many rows."""
        return Table(self.caption, self.columns, self.rows[:most])

    @property
    def shown(self) -> Sequence[Sequence[Cell]]:
        """The rows that are seen at once."""
        return self.rows if len(self.rows) <= _MOST_ROWS else self.rows[:_ROWS_OF_LONG]

    @property
    def folded(self) -> Sequence[Sequence[Cell]]:
        """The rows that are seen when they are asked for."""
        return self.rows[len(self.shown) :]


def _column(title: str) -> Column:
    rest = title.lstrip("~")
    return Column(rest.removeprefix(">"), rest.startswith(">"), len(title) - len(rest))


def table(caption: str, titles: Sequence[str], rows: Iterable[Sequence[Cell]]) -> Table:
    """A table; titles that begin with `>` are those of numbers, those with more `~` before them are left out earlier."""
    columns = [_column(title) for title in titles]
    return Table(caption, columns, list(rows))


@dataclass(frozen=True, slots=True)
class Figure:
    """A picture of ours; its name tells its ids from those of the others of the page."""

    name: str
    picture: str
    kind: str = "figure"

    @property
    def is_zoomable(self) -> bool:
        """Whether the script of the page can zoom into its times; then the picture itself takes the keys."""
        return " data-zoom=" in self.picture


@dataclass(frozen=True, slots=True)
class Lead:
    """A line that begins with a marked term: the name of a file or object, or what was added or removed."""

    term: str
    rest: str = ""
    tone: Tone = Tone.NEUTRAL

    def __str__(self) -> str:
        return self.term + self.rest


Line: TypeAlias = str | Lead


@dataclass(frozen=True, slots=True)
class Sentences:
    """Sentences, as a list if there are several; `indent` is their distance from the margin of a terminal."""

    sentences: Sequence[Line]
    indent: int = 2
    kind: str = "sentences"

    def __bool__(self) -> bool:
        return bool(self.sentences)


@dataclass(frozen=True, slots=True)
class Heading:
    """A heading within a section."""

    text: str
    kind: str = "heading"


@dataclass(frozen=True, slots=True)
class Listing:
    """The content of a file, to be copied."""

    name: str
    lines: Sequence[str]
    kind: str = "listing"


@dataclass(frozen=True, slots=True)
class Folded:
    """Blocks that are seen when they are asked for."""

    summary: str
    blocks: Sequence[Block]
    badge: Badge | None = None
    kind: str = "folded"


@dataclass(frozen=True, slots=True)
class ShownFinding:
    """A finding with its source line, and notes below it, each with its name."""

    finding: Finding
    notes: Mapping[str, str]
    kind: str = "flaw"


Block: TypeAlias = Table | Figure | Sentences | Heading | Listing | Folded | ShownFinding


def lines(*sentences: Line) -> Sentences:
    """Lines at the margin, without those in which there is nothing."""
    return Sentences([each for each in sentences if each], indent=0)


@dataclass(frozen=True, slots=True)
class Section:
    """A section.

    Attributes
    ----------
    anchor : its address in a page
    lead : a sentence that says how to read it
    blocks : those in which there is something
    is_detail : whether it is left out on terminals, as it can have a row for each object
    """

    anchor: str
    title: str
    lead: str
    blocks: Sequence[Block]
    is_detail: bool = False


def flaws(findings: Iterable[Finding]) -> Section:
    """Findings above what they are about."""
    return section("", *(ShownFinding(finding, {}) for finding in findings))


def section(title: str, *blocks: Block, lead: str = "", anchor: str = "", is_detail: bool = False) -> Section:
    """A section with the blocks in which there is something."""
    return Section(anchor, title, lead, [block for block in blocks if block], is_detail)


@dataclass(frozen=True, slots=True)
class ResultDocument:
    """A whole document.

    Attributes
    ----------
    closing : the outcome in one line
    title, opening : what the document is about: a few words, and a line
    findings : what is wrong with the input; commands show it on their own
    kept : what is shown before the closing line where the user wants no more than the outcome
    """

    sections: Sequence[Section]
    closing: str = ""
    title: str = ""
    opening: str = ""
    findings: Sequence[Finding] = ()
    kept: Sequence[Block] = ()


def document(
    sections: Iterable[Section],
    closing: str = "",
    title: str = "",
    opening: str = "",
    findings: Sequence[Finding] = (),
    kept: Sequence[Block] = (),
) -> ResultDocument:
    """A document with the sections in which there is something."""
    return ResultDocument([each for each in sections if each.blocks], closing, title, opening, findings, kept)
