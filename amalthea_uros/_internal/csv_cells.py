"""Cells of CSV files with text from models and traces, which may have been made to attack those who open the file.

Spreadsheets take a cell that begins with one of `= + - @`, a tab or a carriage return for a formula, also between quotes (OWASP, "CSV
Injection"), and runners of GitHub a line that begins with `::` for a command. An apostrophe before it prevents both.
"""

from __future__ import annotations

from contextvars import ContextVar

#: Whether cells are written as they are.
RAW_NAMES: ContextVar[bool] = ContextVar("RAW_NAMES", default=False)

_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def safe_cell(text: str) -> str:
    """A text that no program takes for a formula or a command.

    >>> safe_cell("=1+1"), safe_cell("speed"), safe_cell("'=1")
    ("'=1+1", 'speed', "''=1")
    """
    return f"'{text}" if _is_dangerous(text) and not RAW_NAMES.get() else text


def original_text(cell: str) -> str:
    """The text of a cell that `safe_cell` gave."""
    return cell[1:] if cell.startswith("'") and _is_dangerous(cell) else cell


def _is_dangerous(text: str) -> bool:
    """Whether a text is a formula or a command; one that already has apostrophes gets another one, so that no two become the same."""
    rest = text.lstrip("'")
    return rest.startswith(_FORMULA) or rest.lstrip().startswith("::")
