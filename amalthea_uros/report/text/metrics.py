"""The metrics of the jobs of processes, and the response times of callbacks, in tables."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from amalthea_uros.analyze.results.processes import CallbackResult, Metric, ProcessResult
from amalthea_uros.report.terminal import Terminal
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import Rounding, Time, rounded_time_text, time_text


def write_metrics(terminal: Terminal, processes: Sequence[ProcessResult]) -> None:
    """Write a table for each process: minimum, mean and maximum of each metric."""
    for process in processes:
        terminal.heading(f"Metrics of {process.name}")
        rows = [_row(name, metric) for name, metric in process.metrics.items()]
        terminal.table(("metric", "min", "mean", "max", ""), rows or [("none", *[""] * 4)], right=(1, 2, 3))


def _row(name: JobMetric, metric: Metric) -> tuple[str, ...]:
    ends = _time(metric.min, Rounding.DOWN), _mean(metric.mean), _time(metric.max, Rounding.UP)
    return (name.replace("_", " "), *ends, str(metric.claim))


def write_callbacks(terminal: Terminal, callbacks: Sequence[CallbackResult]) -> None:
    """Write a row for each callback."""
    if not callbacks:
        return
    terminal.heading("Callbacks (from the activation of the process to the end of the callback)")
    rows = [
        (
            callback.name,
            callback.process,
            _time(callback.response.best if callback.response else None, Rounding.DOWN),
            _mean(callback.metrics[JobMetric.RESPONSE_TIME].mean if callback.response else None),
            _time(callback.response.worst if callback.response else None, Rounding.UP, callback.deadline),
            "-" if callback.deadline is None else time_text(callback.deadline),
            callback.reason or (str(callback.response.claim) if callback.response else ""),
        )
        for callback in callbacks
    ]
    terminal.table(("callback", "process", "best", "mean", "worst", "deadline", ""), rows, right=(2, 3, 4, 5))


def _time(value: Time | None, rounding: Rounding, limit: Time | None = None) -> str:
    return "?" if value is None else rounded_time_text(value, rounding, limit)


def _mean(value: Fraction | None) -> str:
    return "-" if value is None else rounded_time_text(round(value), Rounding.NEAREST)
