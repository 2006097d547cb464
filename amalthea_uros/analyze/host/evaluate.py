"""The results for the executors of a host: each method where it holds, and the least of the valid bounds."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.host import busy_window_aware, fifo, polled, polling_points
from amalthea_uros.analyze.host.findings import add_findings
from amalthea_uros.analyze.host.multi_threaded import in_groups
from amalthea_uros.analyze.host.releases import HostReleases
from amalthea_uros.analyze.host.results import HostResults
from amalthea_uros.analyze.host.starvation_free import ReadySet, improved
from amalthea_uros.analyze.host.topics import HostTopics
from amalthea_uros.analyze.host.windows import MOST_PENDING
from amalthea_uros.analyze.response_times import non_preemptive
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask
from amalthea_uros.executors.bounds.solved_system import SolvedSystem
from amalthea_uros.executors.results import ExecutorResult, HandleResult, Loss, TimePart
from amalthea_uros.perf.host import Host, HostCallback, HostExecutor, HostExecutorKind, RosRelease
from amalthea_uros.perf.network import Span
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time, time_text


def evaluate_host(solved: SolvedSystem) -> HostResults:
    """The results of the host of a system; problems become findings."""
    host = solved.context.system.host
    releases = HostReleases(HostTopics(host, solved)).solve()
    results = HostResults(releases, Results(_result(executor, host, releases) for executor in host.executors))
    add_findings(results, solved.context.notes)
    return results


def _result(executor: HostExecutor, host: Host, releases: HostReleases) -> ExecutorResult:
    reason = releases.reasons.get(executor.name, "")
    responses = _responses(executor, host, releases) if executor.callbacks and not reason else {}
    return ExecutorResult(
        name=executor.name,
        task=executor.name,
        round=Span(),
        loop=Span(),
        handles=Results(_handle(callback, executor, responses.get(callback.name), releases) for callback in executor.callbacks),
        reason=reason,
    )


def _responses(executor: HostExecutor, host: Host, releases: HostReleases) -> dict[str, Response]:
    """The response times of all callbacks, from their own release."""
    known = {callback.name: _from_release(callback, releases) for callback in executor.callbacks}
    for responses in _improved(executor, host, releases, known):
        for name, response in responses.items():
            if response.worst is not None and response.worst < (known[name].worst or 0):
                known[name] = replace(response, claim=Claim.BOUND)
    return known


def _from_release(callback: HostCallback, releases: HostReleases) -> Response:
    """The response time that follows from the latency since the first callback of the route was released."""
    latency = releases.latencies[callback.name]
    before = releases.best(callback) - callback.execution.least
    response = replace(latency, worst=(latency.worst or 0) - before, best=callback.execution.least)
    windows = releases.windows.get(releases.topics.executor_of[callback.name].name)
    return response if windows is None else windows.improved_response(response, releases.topics.route(callback))


def _improved(
    executor: HostExecutor, host: Host, releases: HostReleases, known: Mapping[str, Response]
) -> Iterator[Mapping[str, Response]]:
    """The results of the methods that hold for the kind of the executor and the distribution.

    Parameters
    ----------
    known : the best results so far, on which later methods rely
    """
    if executor.kind is HostExecutorKind.MULTI_THREADED:
        if releases.has_thread_for_each_group(executor):
            yield in_groups(executor, releases.released(executor))
        return
    supply, higher = releases.processors[executor.name].supply, releases.preempting(executor)
    tasks = _in_ready_set(executor, host.release, releases)
    yield polled.response_times(tasks, higher, supply)
    if executor.works_off_ready_sets(host.release) and not higher:
        ready = ReadySet(tasks, _is_order_known(executor, host.release), supply)
        yield improved(polling_points, ready, known)
        if reason := busy_window_aware.why_not_used(ready):
            releases.topics.solved.context.notes.assume(f"bounds in {executor.name!r} can be larger than necessary: {reason}")
        yield improved(busy_window_aware, ready, known)
    elif executor.kind is HostExecutorKind.STATIC and not higher and supply is FULL:
        yield _non_preemptive(tasks, {each.name: executor.rank(each, host.release) for each in executor.callbacks})
    elif executor.kind is HostExecutorKind.EVENTS:
        yield fifo.response_times(tasks, higher, supply)


def _non_preemptive(tasks: list[AnalysedTask], ranks: dict[str, int]) -> dict[str, Response]:
    """The static executor since jazzy: one callback for each wait by kind, in an order of addresses that is not known."""
    responses = {}
    for task in tasks:
        others = [other for other in tasks if other is not task]
        higher = [other for other in others if ranks[other.name] <= ranks[task.name]]
        blocking = max((other.demand.worst - 1 for other in others if other not in higher), default=0)
        responses[task.name] = non_preemptive.response_time(task, higher, blocking)
    return responses


def _in_ready_set(executor: HostExecutor, release: RosRelease, releases: HostReleases) -> list[AnalysedTask]:
    """The callbacks in the order of the ready set: by kind, then in that of registration."""
    by_name = {task.name: task for task in releases.released(executor)}
    ordered = sorted(executor.callbacks, key=lambda callback: executor.rank(callback, release))
    return [by_name[callback.name] for callback in ordered]


def _is_order_known(executor: HostExecutor, release: RosRelease) -> bool:
    """Whether the ready set is in the order of registration (rclcpp#1218, rclcpp#2142)."""
    has_one_group = len({callback.group for callback in executor.callbacks}) == 1
    return release is RosRelease.FOXY or (release.keeps_batches and has_one_group)


def _handle(callback: HostCallback, executor: HostExecutor, response: Response | None, releases: HostReleases) -> HandleResult:
    reason = releases.reasons.get(executor.name, "")
    topic = releases.topics.described.get(callback.topic or "")
    unknown = Response(worst=None, best=callback.execution.least, method="", source="", claim=Claim.BOUND, reason=reason)
    return HandleResult(
        name=callback.name,
        kind=callback.kind,
        runnable=callback.name,
        interval=callback.period if topic is None else topic.interval,
        response=response or unknown,
        lateness=None if callback.period is None else Span(most=_lateness(callback, response)),
        terms=_terms(callback, response),
        lost=None if response is None or response.worst is None else _loss(callback, executor, response.worst, releases),
    )


def _lateness(callback: HostCallback, response: Response | None) -> Time | None:
    """The maximum time from when a timer is due to the start of its call: it takes its least execution time after that."""
    return None if response is None or response.worst is None else response.worst - callback.execution.least


def _terms(callback: HostCallback, response: Response | None) -> tuple[TimePart, ...]:
    own = callback.execution.most
    if response is None or response.worst is None or own is None:
        return ()
    why = "callbacks of its executor and of threads of higher priority, and times without supply"
    waiting = TimePart(name="others before it and meanwhile", most=response.worst - own, why=why)
    return (waiting, TimePart(name="its execution", least=callback.execution.least, most=own))


def _loss(callback: HostCallback, executor: HostExecutor, worst: Time, releases: HostReleases) -> Loss | None:
    """Periods or messages that no call serves."""
    if callback.period is not None:
        # The events executor queues them (rclcpp experimental timers_manager.cpp).
        if worst <= callback.period or executor.kind is HostExecutorKind.EVENTS:
            return None
        sequence = f"it can end {time_text(worst)} after it is due, and periods that pass before its call are skipped"
        return Loss(what="periods", is_certain=False, most=None, sequence=sequence)
    pending = releases.events(callback).eta_plus(worst)
    if executor.name in releases.windows:
        pending = min(pending, MOST_PENDING)
    if pending <= callback.depth:
        return None
    sequence = f"{pending} messages can wait, and the queue keeps {callback.depth}"
    return Loss(what="messages", is_certain=False, most=pending - callback.depth, sequence=sequence, is_replaced=False)
