"""Text of Markdown: tables, and text that is no markup."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros.report.escape import visible

#: Characters that may be markup; an underscore between letters never is.
_SPECIAL = re.compile(r"[\\|<>*`\[\]~&]|(?<![^\W_])_|_(?![^\W_])")


def table(headings: Sequence[str], rows: Iterable[Sequence[object]], right: Iterable[int] = ()) -> Iterator[str]:
    """The lines of a table.

    Parameters
    ----------
    right : columns that are aligned to the right
    """
    numbers = set(right)
    rules = ["---:" if number in numbers else "---" for number in range(len(headings))]
    for cells in (headings, rules, *rows):
        yield f"| {' | '.join(escaped(str(cell)) for cell in cells)} |"


def escaped(text: str) -> str:
    """Text that cannot end the cell, nor be taken for markup."""
    return visible(_SPECIAL.sub(r"\\\g<0>", text))
