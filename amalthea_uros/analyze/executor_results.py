"""The callbacks of executors that spin in loops, as results of callbacks and of the processes that execute the iterations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from amalthea_uros.analyze.constraints.process_evidence import judged, worst_response
from amalthea_uros.analyze.results.processes import CallbackResult, Metric, ProcessResult
from amalthea_uros.executors.bounds.solved_system import METHOD
from amalthea_uros.executors.results import ExecutorResult, HandleResult
from amalthea_uros.judge.evidence import ProcessEvidence, ProvedLoss
from amalthea_uros.perf.software import Process
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

#: Others are about activations by stimuli.
METRICS_OF_ITERATIONS = (JobMetric.RESPONSE_TIME, JobMetric.NET_EXECUTION_TIME)


def callback_results(executor: ExecutorResult, limits: Mapping[str, Time | None]) -> Iterator[CallbackResult]:
    """The callbacks of an executor, in its order; several handles can have the same one.

    Parameters
    ----------
    limits : of response times, by the names of runnables
    """
    by_runnable: dict[str, list[HandleResult]] = {}
    for handle in executor.handles:
        by_runnable.setdefault(handle.runnable, []).append(handle)
    for runnable, handles in by_runnable.items():
        response = _worst_of(handles)
        intervals = [handle.interval for handle in handles if handle.interval]
        limit = limits.get(runnable)
        yield CallbackResult(
            name=runnable,
            process=executor.task,
            response=response,
            deadline=min(intervals, default=None) if limit is None else limit,
            reason=response.reason,
            metrics={JobMetric.RESPONSE_TIME: Metric(min=response.best, max=response.worst)},
        )


def _worst_of(handles: Sequence[HandleResult]) -> Response:
    """The response time of a callback that several handles call."""
    responses = [handle.response for handle in handles]
    unbounded = next((response for response in responses if response.worst is None), None)
    if unbounded is not None:
        return replace(unbounded, best=min(response.best for response in responses))
    longest = max(responses, key=lambda response: response.worst or 0)
    return replace(longest, best=min(response.best for response in responses))


def of_iterations(
    process: ProcessResult, model: Process, executor: ExecutorResult, deadline: Time | None, gap: str
) -> ProcessResult:
    """The result of the process that executes the iterations of an executor: its response time is that of an iteration, after its wait.

    Without a deadline, it is met if all callbacks have a bound, nothing is lost, and the core is left to others.

    Parameters
    ----------
    deadline : that is stated for it; it has no implicit one, because its iterations follow each other
    gap : why it is unknown how much its iterations execute, as when they follow each other without rest; "" if it is known
    """
    response = Response(
        worst=executor.round.most,
        best=executor.round.least,
        method=METHOD,
        source="ros2/rclc executor.c",
        claim=Claim.BOUND,
        reason=executor.reason,
    )
    found = replace(
        process,
        response=response,
        least_wcet=None,
        deadline=deadline,
        is_implicit=False,
        reason=executor.reason,
        min_interarrival=executor.loop.least or None,
        max_interarrival=executor.loop.most,
    )
    overload = next((handle.response.reason for handle in executor.handles if handle.response.is_overload), None)
    loss = _loss(executor)
    possible = loss.reason if loss is not None and not loss.is_certain else None
    evidence = ProcessEvidence(
        response=worst_response(found),
        overload=overload,
        loss=loss,
        gap=possible or _unserved(executor) or gap or None,
        is_served=True,
    )
    return judged(found, model, evidence)


def _loss(executor: ExecutorResult) -> ProvedLoss | None:
    """What callbacks lose for certain, or may lose; values that newer ones replace are not lost."""
    lost = [
        (handle.name, handle.lost) for handle in executor.handles if handle.lost is not None and not handle.lost.is_replaced
    ]
    for name, loss in sorted(lost, key=lambda pair: not pair[1].is_certain):
        return ProvedLoss(f"{name!r} {'loses' if loss.is_certain else 'can lose'} {loss.what}", loss.is_certain)
    return None


def _unserved(executor: ExecutorResult) -> str | None:
    """Why it is unknown whether all callbacks are called in time; None if all have a bound."""
    unknown = next((handle for handle in executor.handles if handle.response.worst is None), None)
    return None if unknown is None else f"{unknown.name!r}: {unknown.response.reason}"
