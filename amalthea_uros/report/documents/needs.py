"""Execution times on each kind of core, where no single core with a known clock is stated."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from fractions import Fraction

from amalthea_uros.analyze.results.needs import ExecutionOnCores
from amalthea_uros.analyze.results.processes import ProcessResult
from amalthea_uros.report.basics.document import Cell, Table, table
from amalthea_uros.report.wording.cells import UNKNOWN, about, at_least, at_most, clock_text, load_text
from amalthea_uros.units import Rounding, frequency_text, number_text, rounded

NEEDS_HEADING = (
    "Execution times on each kind of core (of processes without a single core with a known clock, and of those that wait)"
)


def needs_table(processes: Iterable[ProcessResult]) -> Table:
    """The execution times and loads of processes on each kind of core."""
    rows = [
        _row(process.name, each)
        for process in processes
        for each in process.needs
        # The reason is in the table of response times already.
        if each.worst is not None or each.reason not in process.reason
    ]
    columns = ("process", "type of core", ">cores", ">clock", ">best", ">mean", ">worst", ">load of one core", "")
    return table("Execution times on each kind of core", columns, [*rows, *_sum_rows(processes)])


def _row(process: str, need: ExecutionOnCores) -> tuple[Cell, ...]:
    return (
        process,
        *_kind(need),
        *(_ticks_cells(need) if need.in_ticks else (at_least(need.best), _mean(need), at_most(need.worst))),
        _load(need.load, need.least_frequency),
        need.reason,
    )


def _kind(need: ExecutionOnCores) -> tuple[str, str, str]:
    clock = frequency_text(need.frequency) if need.frequency is not None else UNKNOWN
    return need.core_type or "any", str(len(need.cores) or "-"), clock


def _ticks_cells(need: ExecutionOnCores) -> tuple[str, str, str]:
    mean = "-" if need.mean is None else f"{number_text(rounded(need.mean, Rounding.NEAREST))} ticks"
    return _ticks(need.best), mean, _ticks(need.worst)


def _ticks(number: int | None) -> str:
    return UNKNOWN if number is None else f"{number_text(number)} ticks"


def _mean(need: ExecutionOnCores) -> str:
    return "-" if need.mean is None else about(need.mean)


def _load(load: Fraction | None, frequency: Fraction | None) -> str:
    """A load in percent, or the clock at which it is 100 %."""
    if frequency is not None:
        return f"100 % at {clock_text(frequency)}"
    return load_text(load, Rounding.UP)


def _sum_rows(processes: Iterable[ProcessResult]) -> Iterator[tuple[Cell, ...]]:
    """The load of all of them on one core of a kind, if the load of each one is known there."""
    of_all = [process.needs for process in processes if process.needs]
    for need in of_all[0] if len(of_all) > 1 else ():
        alike = [each for needs in of_all for each in needs if _kind(each) == _kind(need)]
        loads = [each.load for each in alike if each.load is not None]
        clocks = [each.least_frequency for each in alike if each.least_frequency is not None]
        if len(of_all) in (len(loads), len(clocks)):
            total = (sum(loads, Fraction(0)), None) if loads else (None, sum(clocks, Fraction(0)))
            yield ("together", *_kind(need), "", "", "", _load(*total), "")
