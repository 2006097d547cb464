"""Tables that fit a width: footnotes for long remarks, folded text, and columns that are left out; numbers stay whole."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from textwrap import wrap

#: Columns between two cells, and before the first.
GAP = 2

#: Between several numbers of a cell, which may then be in several lines.
SEVERAL = " / "

#: What the columns of remarks are called.
_REMARKS = ("", "reason", "why", "how it is computed", "what gets worse")

#: Shorter remarks, such as claims, always stay in the table.
_SHORT = 24

#: A long remark of so many rows is written once, below.
_REPEATED = 3

#: Columns of text are folded to this width before others are left out, and not more narrowly than the second one.
_COMFORTABLE, _NARROWEST = 20, 12


class Footnotes:
    """Remarks that are written once, below the first table that has them."""

    def __init__(self) -> None:
        self._numbers: dict[str, int] = {}

    def mark(self, remark: str) -> str:
        """The number in the place of a remark."""
        return f"[{self._numbers.setdefault(remark, len(self._numbers) + 1)}]"

    def from_number(self, first: int) -> Iterator[str]:
        """The footnotes that are not written yet."""
        yield from (f"[{number}] {remark}" for remark, number in self._numbers.items() if number >= first)

    def __contains__(self, remark: str) -> bool:
        return remark in self._numbers

    def __len__(self) -> int:
        return len(self._numbers)


def column_widths(headings: Sequence[str], cells: Sequence[Sequence[str]]) -> list[int]:
    """The width of each column; cells may have several lines."""
    columns = zip(headings, *cells, strict=True)
    return [max(map(_longest, column)) for column in columns]


def table_width(headings: Sequence[str], cells: Sequence[Sequence[str]]) -> int:
    """The width of a whole table."""
    return sum(GAP + width for width in column_widths(headings, cells))


def with_footnotes(headings: Sequence[str], cells: Sequence[Sequence[str]], width: int, notes: Footnotes) -> list[list[str]]:
    """The cells with numbers in the place of remarks that make a table wider than a page, or that many rows have."""
    if not any(name in _REMARKS for name in headings):
        return [list(row) for row in cells]
    others = [
        GAP if name in _REMARKS else GAP + column for name, column in zip(headings, column_widths(headings, cells), strict=True)
    ]
    room = max(_SHORT, width - sum(others))
    remarks = Counter(cell for row in cells for heading, cell in zip(headings, row, strict=True) if heading in _REMARKS)

    def shown(heading: str, cell: str) -> str:
        is_long = len(cell) > _SHORT and (cell in notes or remarks[cell] >= _REPEATED)
        return notes.mark(cell) if heading in _REMARKS and (len(cell) > room or is_long) else cell

    return [[shown(heading, cell) for heading, cell in zip(headings, row, strict=True)] for row in cells]


def _longest(cell: str) -> int:
    """The length of the longest line of a cell."""
    return max(map(len, cell.split("\n"))) if "\n" in cell else len(cell)


def folded_headings(headings: Sequence[str], cells: Sequence[Sequence[str]], width: int) -> list[str]:
    """The headings of a table that is too wide in several lines, where they are longer than what is below them."""
    if table_width(headings, cells) <= width:
        return list(headings)
    below = column_widths([""] * len(headings), cells)
    return [_folded_cell(each, max(column, _NARROWEST)) for each, column in zip(headings, below, strict=True)]


def left_out(
    headings: Sequence[str], cells: Sequence[Sequence[str]], spare: Sequence[int], fixed: Collection[int], width: int
) -> list[int]:
    """The columns without which a table fits, in the order of `spare`; none if it fits when its text is folded."""
    widths = [
        column if index in fixed else min(column, max(_COMFORTABLE, _longest(headings[index])))
        for index, column in enumerate(column_widths(headings, cells))
    ]
    found: list[int] = []
    for column in spare:
        if sum(GAP + each for index, each in enumerate(widths) if index not in found) <= width:
            break
        found.append(column)
    return found


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
        narrower = max(widths[column] - excess, min(widths[column], _NARROWEST), _longest(headings[column]))
        excess -= widths[column] - narrower
        widths[column] = narrower
    return [[_folded_cell(cell, limit) for cell, limit in zip(row, widths, strict=True)] for row in cells]


#: Where a name can continue on the next line: after a sign between its parts, and before a capital letter.
_PARTS = re.compile(r"(?<=[_/:.-])(?=\w)|(?<=[a-z\d])(?=[A-Z])")


def _folded_cell(cell: str, width: int) -> str:
    if len(cell) <= width:
        return cell
    parts = wrap(glued(cell), width, break_long_words=False)
    return unglued("\n".join(line for part in parts for line in broken(part, width)))


#: Between a number and its unit: no line ends there.
_GLUE = "\ud801"
_BEFORE_UNIT = re.compile(r"(?<=\d) (?=(?:[pnum]?s|%|[kMG]?Hz|[KM]i?B|B|bytes?|ticks)\b|%)")


def glued(text: str) -> str:
    """A text whose numbers stay together with their units when it is split at spaces."""
    return _BEFORE_UNIT.sub(_GLUE, text)


def unglued(text: str) -> str:
    """The text again."""
    return text.replace(_GLUE, " ")


def broken(line: str, width: int) -> Iterator[str]:
    """A name without spaces in lines, if possible between its parts."""
    begun = ""
    for part in _PARTS.split(line):
        if begun and len(begun) + len(part) > width:
            yield begun
            begun = ""
        begun += part
        while len(begun) > width:
            yield begun[:width]
            begun = begun[width:]
    yield begun
