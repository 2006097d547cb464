"""Cells of CSV files with text from models and traces, which may have been made to attack those who open the file.

Spreadsheets take a cell that begins with one of `= + - @`, a tab or a carriage return for a formula, also between quotes (OWASP, "CSV
Injection"), and runners of GitHub a line that begins with `::` for a command. An apostrophe before it prevents both.
"""

from __future__ import annotations

import re
from contextvars import ContextVar

#: Whether cells are written as they are.
RAW_NAMES: ContextVar[bool] = ContextVar("RAW_NAMES", default=False)

#: A cell that already has apostrophes gets another one, so that no two texts become the same.
_DANGEROUS = re.compile(r"'*(?:[=+\-@\t\r]|\s*::)")
_NEUTRALISED = re.compile(r"'+(?:[=+\-@\t\r]|\s*::)")


def safe_cell(text: str) -> str:
    """A text that no program takes for a formula or a command.

    >>> safe_cell("=1+1"), safe_cell("speed"), safe_cell("'=1")
    ("'=1+1", 'speed', "''=1")
    """
    return text if RAW_NAMES.get() or _DANGEROUS.match(text) is None else f"'{text}"


def original_text(cell: str) -> str:
    """The text of a cell that `safe_cell` gave."""
    return cell[1:] if _NEUTRALISED.match(cell) else cell
