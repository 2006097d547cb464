"""Results in scripts and notebooks: as records, text, and HTML."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from io import StringIO
from pathlib import Path

from amalthea_uros._internal.shown import Cell, Record
from amalthea_uros.analyze.impact import Impact
from amalthea_uros.analyze.priorities.assignment import Proposal
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.design.changes.apply import Difference
from amalthea_uros.diagnostics import Finding
from amalthea_uros.report.basics.document import document
from amalthea_uros.report.basics.escape import visible
from amalthea_uros.report.documents.analysis import impact_section, priorities_section
from amalthea_uros.report.documents.simulation import simulation_document
from amalthea_uros.report.formats.text import RENDERS, write_text
from amalthea_uros.report.records import all_records, lean_records
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.report.writers.text import write_document
from amalthea_uros.services import analyze as services_analyze
from amalthea_uros.services.what_if import WhatIf
from amalthea_uros.simulate.results import Simulation
from amalthea_uros.units import time_text

#: More rows are not displayed; the data frame has them all.
_ROWS = 100

_TIME = "_ps"
_TABLE = '<table class="amuros" style="border-collapse:collapse">'
_CELL = "padding:2px 12px 2px 0;vertical-align:top;min-width:4em"


def records(result: object, full: bool) -> list[Record]:
    """The rows of a result, with the most important columns or all."""
    return all_records(result) if full else lean_records(result)


def text(result: object) -> str:
    """What the command line prints of a result; of others, what `repr` gives."""
    stream = StringIO()
    return stream.getvalue().strip("\n") if _write(result, Terminal(stream)) else repr(result)


def html(result: object) -> str:
    """The tables that the command line prints of a result; of others, a table of its records."""
    page = _Page()
    return page.content if _write(result, page) else _table(lean_records(result))


def _write(result: object, terminal: Terminal) -> bool:
    """Write what the command line prints of a result; False if it prints nothing of its kind."""
    match result:
        case Analysis():
            terminal.findings(result.findings)
            write_text(services_analyze.analysis_result(result), terminal)
        case Simulation():
            terminal.findings(result.findings)
            write_document(simulation_document(_SimulationAlone(result)), terminal)
        case WhatIf():
            for change in result.differences:
                terminal.line(str(change))
            write_document(document([impact_section(result.impact)]), terminal)
        case Proposal():
            write_document(document([priorities_section(result)]), terminal)
        case _ if type(result).__name__ in RENDERS:
            write_text(result, terminal)
        case _:
            return False
    return True


@dataclass(frozen=True, slots=True)
class _SimulationAlone:
    """A simulation of something that is not in files."""

    simulation: Simulation
    paths: tuple[Path, ...] = ()
    with_metrics: bool = False
    differences: tuple[Difference, ...] = ()
    impact: Impact | None = None

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What the simulation does not take into account."""
        return self.simulation.findings


class _Page(Terminal):
    """Takes what is written for a terminal as HTML."""

    def __init__(self) -> None:
        super().__init__(StringIO())

    @property
    def content(self) -> str:
        """What was written."""
        return f'<div class="amuros">{self.stream.getvalue()}</div>'  # type: ignore[attr-defined]

    def line(self, text: str = "") -> None:
        """Write a line of text."""
        if text.strip():
            self.stream.write(f'<div style="white-space:pre-wrap">{escape(visible(text.rstrip()))}</div>')

    def heading(self, text: str) -> None:
        """Write a heading."""
        self.stream.write(f"<p><b>{escape(visible(text))}</b></p>")

    def table(self, headings: Sequence[str], rows: Iterable[Sequence[object]], right: Sequence[int] = ()) -> None:
        """Write a table, with the columns of numbers aligned to the right."""
        self.stream.write(_table_html(headings, ([str(cell) for cell in row] for row in rows), right))


def _table_html(headings: Sequence[str], rows: Iterable[Sequence[str]], right: Sequence[int]) -> str:
    def row(cells: Sequence[str], tag: str) -> str:
        sides = ("right;white-space:nowrap" if index in right else "left" for index in range(len(cells)))
        made = (
            f'<{tag} style="{_CELL};text-align:{side}">{escape(visible(cell))}</{tag}>'
            for cell, side in zip(cells, sides, strict=True)
        )
        return f"<tr>{''.join(made)}</tr>"

    body = "".join(row(cells, "td") for cells in rows)
    return f"{_TABLE}<thead>{row(headings, 'th')}</thead><tbody>{body}</tbody></table>"


def _table(rows: Sequence[Record]) -> str:
    """Records as a table without empty columns; times are texts with units."""
    stated = dict.fromkeys(name for row in rows for name, value in row.items() if value not in (None, ""))
    names = list(stated)
    shown = rows[:_ROWS]
    cells = [[_cell(name, row.get(name)) for name in names] for row in shown]
    right = [index for index, name in enumerate(names) if all(not isinstance(row.get(name), str) for row in shown)]
    more = f"<div>{len(rows) - _ROWS} more rows</div>" if len(rows) > _ROWS else ""
    return _table_html([name.removesuffix(_TIME) for name in names], cells, right) + more


def _cell(name: str, value: Cell) -> str:
    if value is None:
        return ""
    if name.endswith(_TIME) and isinstance(value, int | float) and not isinstance(value, bool):
        return time_text(round(value))
    return f"{value:.4g}" if isinstance(value, float) else str(value)
