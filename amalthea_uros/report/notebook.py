"""Results in scripts and notebooks: as records, text, and HTML."""

from __future__ import annotations

from collections.abc import Sequence
from io import StringIO

from amalthea_uros._internal.shown import Cell, Record
from amalthea_uros.report.documents import DOCUMENTS, document_of
from amalthea_uros.report.records import all_records, lean_records
from amalthea_uros.report.writers.fragment import html_of, table_html
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.report.writers.text import write_document
from amalthea_uros.units import time_text

#: More rows are not displayed; the data frame has them all.
_ROWS = 100

_TIME = "_ps"


def records(result: object, full: bool) -> list[Record]:
    """The rows of a result, with the most important columns or all."""
    return all_records(result) if full else lean_records(result)


def text(result: object) -> str:
    """The text that the command line prints of a result; of other objects, their `repr`."""
    if type(result).__name__ not in DOCUMENTS:
        return repr(result)
    stream = StringIO()
    write_document(document_of(result), Terminal(stream))
    return stream.getvalue().strip("\n")


def html(result: object) -> str:
    """The tables that the command line prints of a result; of other objects, a table of their records."""
    return html_of(document_of(result)) if type(result).__name__ in DOCUMENTS else _table(lean_records(result))


def _table(rows: Sequence[Record]) -> str:
    """Records as a table without empty columns; times are texts with units."""
    stated = dict.fromkeys(name for row in rows for name, value in row.items() if value not in (None, ""))
    names = list(stated)
    shown = rows[:_ROWS]
    cells = [[_cell(name, row.get(name)) for name in names] for row in shown]
    right = [index for index, name in enumerate(names) if all(not isinstance(row.get(name), str) for row in shown)]
    more = f"<div>{len(rows) - _ROWS} more rows</div>" if len(rows) > _ROWS else ""
    return table_html([name.removesuffix(_TIME) for name in names], cells, right) + more


def _cell(name: str, value: Cell) -> str:
    if value is None:
        return ""
    if name.endswith(_TIME) and isinstance(value, int | float) and not isinstance(value, bool):
        return time_text(round(value))
    return f"{value:.4g}" if isinstance(value, float) else str(value)
