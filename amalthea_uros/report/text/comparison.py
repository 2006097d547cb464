"""A comparison with a measurement for people."""

from __future__ import annotations

from amalthea_uros.compare.results import Comparison
from amalthea_uros.report.compared import (
    BOUNDS,
    DISTRIBUTIONS,
    LIMITS,
    MISSING,
    PREDICTIONS,
    bound_cells,
    bound_tests,
    closing_line,
    distribution_rows,
    hidden,
    hidden_missing,
    limit_cells,
    missing_cells,
    missing_rows,
    prediction_cells,
    prediction_groups,
    subject_line,
)
from amalthea_uros.report.terminal import Terminal


def write(result: Comparison, terminal: Terminal) -> None:
    """Write tables of predictions, bounds, distributions and limits, what was not compared, and whether the model holds."""
    terminal.line(subject_line(result))
    predictions, bounds = [*map(prediction_cells, prediction_groups(result))], [*map(bound_cells, bound_tests(result))]
    if predictions:
        terminal.heading(
            "Predictions (min / mean / max; deviation: of the measurement, positive if more was measured than predicted)"
        )
        terminal.table(PREDICTIONS, predictions, right=(2, 3, 4, 6, 7))
    if bounds:
        terminal.heading("Bounds of the analysis (nothing may be measured beyond them, without tolerance)")
        terminal.table(BOUNDS, bounds, right=range(2, 7))
    if hidden(result):
        terminal.line(f"  {hidden(result)}")
    distributions = list(distribution_rows(result))
    if distributions:
        terminal.heading("Distributions (Kolmogorov-Smirnov distance from the simulated values, and its critical value at 5 %)")
        terminal.table(DISTRIBUTIONS, distributions, right=range(2, 8))
    if result.limits:
        terminal.heading("Limits, as measured")
        terminal.table(LIMITS, map(limit_cells, result.limits), right=(3, 4))
    if result.not_compared:
        terminal.heading("Not compared")
        terminal.table(MISSING, map(missing_cells, missing_rows(result)))
        if hidden_missing(result):
            terminal.line(f"  {hidden_missing(result)}")
    if result.assumptions:
        terminal.heading("Assumptions")
        for sentence in result.assumptions:
            terminal.line(f"  {sentence}")
    terminal.heading(closing_line(result))


def write_closing(result: Comparison, terminal: Terminal) -> None:
    """Write whether the model holds."""
    terminal.line(closing_line(result))
