"""How tables are made to fit a width: remarks become footnotes, and columns of text are folded."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from textwrap import wrap

#: Columns between two cells, and before the first.
GAP = 2

#: What the columns of remarks are called.
_REMARKS = ("", "reason")

#: Shorter remarks, such as claims, always stay in the table.
_SHORT = 24

#: Columns are not folded more narrowly than this.
_NARROWEST = 12


def column_widths(headings: Sequence[str], cells: Sequence[Sequence[str]]) -> list[int]:
    """The width of each column; cells may have several lines."""
    columns = zip(headings, *cells, strict=True)
    return [max(len(line) for cell in column for line in cell.split("\n")) for column in columns]


def table_width(headings: Sequence[str], cells: Sequence[Sequence[str]]) -> int:
    """The width of a whole table."""
    return sum(GAP + width for width in column_widths(headings, cells))


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
    return [[_folded(cell, limit) for cell, limit in zip(row, widths, strict=True)] for row in cells]


def _folded(cell: str, width: int) -> str:
    return cell if len(cell) <= width else "\n".join(wrap(cell, width))
