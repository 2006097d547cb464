"""What sections of a page consist of; `templates/report/blocks.jinja` writes them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import TypeAlias

from markupsafe import Markup

from amalthea_uros.report.pictures.embedding import embedded

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
    """A verdict or a severity."""

    word: str
    tone: Tone


Cell: TypeAlias = str | Badge


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table; numbers are aligned to the right."""

    title: str
    is_number: bool = False


@dataclass(frozen=True, slots=True)
class Table:
    """A table; the first cell of a row is its heading."""

    caption: str
    columns: Sequence[Column]
    rows: Sequence[Sequence[Cell]]
    kind: str = "table"

    @property
    def shown(self) -> Sequence[Sequence[Cell]]:
        """The rows that are seen at once."""
        return self.rows if len(self.rows) <= _MOST_ROWS else self.rows[:_ROWS_OF_LONG]

    @property
    def folded(self) -> Sequence[Sequence[Cell]]:
        """The rows that are seen when they are asked for."""
        return self.rows[len(self.shown) :]


def table(caption: str, titles: Sequence[str], rows: Sequence[Sequence[Cell]]) -> Table:
    """A table without the columns in which there is nothing; titles that begin with `>` are those of numbers."""
    kept = [number for number in range(len(titles)) if any(row[number] not in _NOTHING for row in rows)]
    columns = [Column(titles[number].removeprefix(">"), titles[number].startswith(">")) for number in kept]
    return Table(caption, columns, [[row[number] for number in kept] for row in rows])


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

    @property
    def markup(self) -> Markup:
        """The picture as a part of a page; its text is escaped already."""
        return Markup(embedded(self.picture, self.name))


@dataclass(frozen=True, slots=True)
class Sentences:
    """Sentences, as a list if there are several."""

    sentences: Sequence[str]
    kind: str = "sentences"


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


Block: TypeAlias = Table | Figure | Sentences | Heading | Listing | Folded


@dataclass(frozen=True, slots=True)
class Section:
    """A section with its anchor, and a sentence that says how to read it."""

    anchor: str
    title: str
    lead: str
    blocks: Sequence[Block]
