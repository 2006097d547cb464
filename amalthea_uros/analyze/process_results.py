"""The results of all processes, with their metrics, the order that is unknown, and their demand on each kind of core."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.needs import Needs
from amalthea_uros.analyze.processes import process_result
from amalthea_uros.analyze.response_times.metrics import MetricEvaluator
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.processes import Metric, ProcessResult
from amalthea_uros.executors.results import ExecutorResult
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.executors import Executor
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import Rounding, rounded_time_text

#: Others are about activations by stimuli.
METRICS_OF_ITERATIONS = (JobMetric.RESPONSE_TIME, JobMetric.NET_EXECUTION_TIME)


def process_results(
    solution: Solution, executors: Results[ExecutorResult], known: Mapping[str, ProcessResult]
) -> Iterator[ProcessResult]:
    """The results of all processes.

    Parameters
    ----------
    known : those that need not be found again
    """
    system = solution.context.system
    metrics, needs = MetricEvaluator(solution), Needs(solution.context)
    by_task = {executor.task: executor for executor in executors}
    for name in system.processes:
        if name in known:
            yield known[name]
            continue
        result = _with_order(process_result(name, solution, by_task.get(name)), solution)
        if name in by_task:
            kept = _of_iterations(metrics.of(result), by_task[name], system.executor_of_task[name])
            yield replace(result, metrics=kept)
        else:
            has_needs = result.wcet is None and name not in system.transmissions
            yield replace(result, metrics=metrics.lazily(result), needs=needs.of(name) if has_needs else ())


def _of_iterations(known: Mapping[JobMetric, Metric], result: ExecutorResult, executor: Executor) -> Mapping[JobMetric, Metric]:
    """The metrics that the iterations of an executor have."""
    kept = {kind: known[kind] for kind in METRICS_OF_ITERATIONS if kind in known}
    if _can_wait(executor) and JobMetric.NET_EXECUTION_TIME in kept:
        net = kept[JobMetric.NET_EXECUTION_TIME]
        kept[JobMetric.NET_EXECUTION_TIME] = Metric(min=net.min, max=result.round.most)
    return kept


def _can_wait(executor: Executor) -> bool:
    """Whether an iteration can wait for the wire or the session after it has begun, which is net execution time, too."""
    return executor.session is not None or any(handle.publications for handle in executor.handles)


def _with_order(result: ProcessResult, solution: Solution) -> ProcessResult:
    """The result, which says so if an order of priorities could decide what is unknown."""
    item = solution.context.scheduled.get(result.name)
    if item is None or item.order_gap is None or result.verdict is not Verdict.UNKNOWN:
        return result
    if result.response is None or result.response.worst is None:
        return replace(result, reason=f"{item.order_gap}; {result.reason}")
    needed = rounded_time_text(result.response.worst, Rounding.UP)
    where = "as the lowest" if item.place is None else "in the worst order"
    return replace(result, reason=f"{item.order_gap}; {where} it needs up to {needed}")
