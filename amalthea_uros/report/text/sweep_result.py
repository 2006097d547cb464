"""A sweep for people."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros.design.campaign.run import RunOutcome, Value
from amalthea_uros.design.campaign.sweeps import GROWTH, SCHEDULABLE
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.report.writers.terminal import Terminal
from amalthea_uros.services.sweep import SweepResult
from amalthea_uros.units import Rounding, number_text, rounded_time_text

#: More variants are for a table in a file, and more quantities, too.
_SHOWN, _COLUMNS = 50, 4
#: What is stated or follows from others is not shown unless somebody asks for it.
_DEFAULTS_WITHOUT = (".verdict", ".deadline_ps", ".limit_ps", ".margin_ps", SCHEDULABLE)


def write(result: SweepResult, terminal: Terminal) -> None:
    """Write the variants with what is computed for them, and for how many everything is met."""
    columns = _columns(result)
    shown = result.outcomes[:_SHOWN]
    targets = [f"{sweep.object}.{sweep.key}" for sweep in result.plan.sweeps]
    rows = [_row(outcome, columns) for outcome in shown]
    headings = (*targets, *map(_heading, columns), SCHEDULABLE)
    terminal.table(headings, rows, right=range(len(targets) + len(columns)))
    if more := len(result.outcomes) - len(shown):
        terminal.line(f"  {counted(more, 'more variant')} not shown; write all to a file with --table FILE")
    hidden = [name for name in result.changing if name not in (*columns, SCHEDULABLE)]
    if hidden and not result.shown:
        others = counted(len(hidden), "other result")
        terminal.line(f"  {others} that change not shown; choose with --quantity, or write all with --table FILE")
    terminal.heading(closing_line(result))


def write_closing(result: SweepResult, terminal: Terminal) -> None:
    """Write for how many variants everything is met, in one line."""
    terminal.line(closing_line(result))


def closing_line(result: SweepResult) -> str:
    """For how many variants everything is met for certain, and for how many not."""
    planned = len(result.plan.runs)
    of = counted(planned, "variant")
    parts = [f"yes in {len(result.schedulable):,} of {of}"]
    parts += [f"no in {number:,}"] if (number := len(result.with_verdict(Schedulable.NO))) else []
    parts += [f"unknown in {number:,}"] if (number := len(result.with_verdict(Schedulable.UNKNOWN))) else []
    parts += [f"{len(result.failed):,} failed"] if result.failed else []
    parts += [f"{planned - len(result.outcomes):,} not finished"] if not result.is_complete else []
    sample = f"; a random sample of {result.plan.total:,} combinations" if planned < result.plan.total else ""
    return f"Schedulable: {', '.join(parts)}{sample}"


def _columns(result: SweepResult) -> Sequence[str]:
    """The chosen quantities, or the first ones that change."""
    growth = [GROWTH] if GROWTH in result.quantities else []
    if result.shown:
        return [*(result.column(name) for name in result.shown), *growth]
    numbers = [name for name in result.changing if not name.endswith(_DEFAULTS_WITHOUT)]
    return [*(name for name in numbers if name != GROWTH)][:_COLUMNS] + growth


def _heading(column: str) -> str:
    """The name of the object as it is, and the quantity in words."""
    name, _, quantity = column.removesuffix("_ps").rpartition(".")
    return f"{name} {quantity.replace('_', ' ')}".strip()


def _row(outcome: RunOutcome, columns: Sequence[str]) -> tuple[str, ...]:
    values = (change.value for change in outcome.run.changes)
    verdict = f"failed: {outcome.error}" if outcome.error else str(outcome.record.get(SCHEDULABLE, ""))
    return (*values, *_cells(outcome, columns), verdict)


def _cells(outcome: RunOutcome, columns: Sequence[str]) -> Iterator[str]:
    for name in columns:
        value = outcome.record.get(name)
        yield "" if outcome.error else _text(name, value)


def _text(column: str, value: Value) -> str:
    if value is None:
        return "unknown"
    if isinstance(value, str):
        return value
    if column.endswith("_ps"):
        return rounded_time_text(Fraction(value), Rounding.UP)
    return number_text(Fraction(value).limit_denominator(10**6))
