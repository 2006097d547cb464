"""The callbacks of executors that spin in loops, as results of callbacks and of the processes that execute the rounds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from amalthea_uros.analyze.executors.results import ExecutorResult, HandleResult
from amalthea_uros.analyze.executors.window import METHOD
from amalthea_uros.analyze.process_verdicts import worst_response
from amalthea_uros.analyze.results import CallbackResult, Claim, JobMetric, Metric, ProcessResult, Response
from amalthea_uros.analyze.verdicts import Failure, Verdict, decide, undecided
from amalthea_uros.units import Time

#: Others are about activations by stimuli.
METRICS_OF_ROUNDS = (JobMetric.RESPONSE_TIME, JobMetric.NET_EXECUTION_TIME)


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


def of_rounds(process: ProcessResult, executor: ExecutorResult, deadline: Time | None, gap: str) -> ProcessResult:
    """The result of the process that executes the rounds of an executor: its response time is that of a round, after its wait.

    Without a deadline, it is met if all callbacks have a bound, nothing is lost, and the core is left to others.

    Parameters
    ----------
    deadline : that is stated for it; it has no implicit one, because its rounds follow each other
    gap : why it is unknown how much its rounds execute, as when they follow each other without rest; "" if it is known
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
        verdict=None,
        failure=None,
        reason=executor.reason,
        min_interarrival=executor.loop.least or None,
        max_interarrival=executor.loop.most,
    )
    failing = _failing(executor)
    if failing is not None:
        verdict, failure, reason = failing
        return replace(found, verdict=verdict, failure=failure, reason=reason)
    if gap:
        return replace(found, verdict=Verdict.UNKNOWN, reason=gap)
    if deadline is None:
        return replace(found, verdict=Verdict.MET)
    verdict = decide(worst_response(found), deadline, is_upper=True)
    failure = Failure.MISSED if verdict is Verdict.MISSED else None
    reason = executor.reason or (undecided(worst_response(found), is_upper=True) if verdict is Verdict.UNKNOWN else "")
    return replace(found, verdict=verdict, failure=failure, reason=reason)


def _failing(executor: ExecutorResult) -> tuple[Verdict, Failure | None, str] | None:
    """The verdict on an executor of which a callback is not served, or may not be; None if all are."""
    for handle in executor.handles:
        if handle.response.is_overload:
            return Verdict.UNBOUNDED, Failure.OVERLOAD, handle.response.reason
    lost = [(handle, handle.lost) for handle in executor.handles if handle.lost is not None and not handle.lost.is_replaced]
    for handle, loss in sorted(lost, key=lambda pair: not pair[1].is_certain):
        certainly = "loses" if loss.is_certain else "can lose"
        reason = f"{handle.name!r} {certainly} {loss.what}"
        return (Verdict.MISSED, Failure.LOST, reason) if loss.is_certain else (Verdict.UNKNOWN, None, reason)
    unknown = next((handle for handle in executor.handles if handle.response.worst is None), None)
    return None if unknown is None else (Verdict.UNKNOWN, None, f"{unknown.name!r}: {unknown.response.reason}")


def without_doubtful_losses(process: ProcessResult) -> ProcessResult:
    """The result of a process that rounds of an executor activate: as it may be activated less often, losses are not certain."""
    if process.failure not in (Failure.LOST, Failure.OVERLOAD):
        return process
    return replace(process, verdict=Verdict.UNKNOWN, failure=None)
