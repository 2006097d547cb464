"""A recorded host -> the text of an app.yaml; a value that is not recorded is `TODO`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from amalthea_uros._internal.plural import counted
from amalthea_uros.compare.recorded.arrivals import RecordedArrivals, arrivals_of
from amalthea_uros.compare.recorded.host import RecordedCallback, RecordedExecutor, RecordedHost, RecordedThread
from amalthea_uros.measure.series import TimeStatistics
from amalthea_uros.source.description import GAP, item_lines, quoted, remark
from amalthea_uros.trace.ctf.ros2_objects import RosCallbackKind
from amalthea_uros.units import NANOSECOND, frequency_text, time_text

#: The field of LTTng is -1 - p for a real-time priority p of a thread (lttng-modules, events/sched.h; the kernel has 99 - p).
_REAL_TIME = range(-100, -1)
_HEAD = (
    "# Imported from a recording of ros2_tracing. Each TODO is a value that is not recorded: replace all, then run amuros check.",
    "# Execution times and rates are those of the recording, and no bounds: results are bounds as far as these are never exceeded.",
    "# An execution time is what a call took its thread since the end of the call before, with polling and taking the message.",
    "# Callback groups, and variables that callbacks share (reads, writes), are not recorded.",
)


def recorded_text(host: RecordedHost, name: str) -> str:
    """The description.

    Parameters
    ----------
    name : of the application
    """
    lines = [
        *_HEAD,
        "amuros: 1",
        f"name: {quoted(name)}",
        "hardware: {platform: host} # no controller; instead, state the one at the other end of the agent",
        "host:",
        *(f"  {line}" for line in _host(host)),
    ]
    return "\n".join(lines) + "\n"


def _host(host: RecordedHost) -> Iterator[str]:
    tracer = f"recorded with ros2_tracing {host.tracer}" if host.tracer else ""
    yield f"ros: {GAP}{remark('; '.join(filter(None, ('the distribution', tracer))))}"
    yield "computers:"
    cores = remark(_cores([thread for executor in host.executors for thread in executor.threads]))
    yield from item_lines(iter((f"name: {quoted(host.computer or 'pc')}", f"cores: {GAP}{cores}")), "  ")
    yield f"latency: {GAP} # from a publication to the queue of a subscription: {{min: ..., max: ...}}"
    yield "executors:"
    for executor in host.executors:
        yield from item_lines(_executor(executor), "  ")
    yield "nodes:"
    for node, callbacks in host.callbacks.items():
        yield from item_lines(_node(node, callbacks, host.executor_of(node)), "  ")
    topics = list(_topics(host))
    if topics:
        yield "topics:"
        yield from topics


def _cores(threads: Sequence[RecordedThread]) -> str:
    used = sorted({core for each in threads if each.scheduled is not None for core in each.scheduled.cores})
    return f"seen on {', '.join(map(str, used))}" if used else ""


def _executor(executor: RecordedExecutor) -> Iterator[str]:
    yield f"name: {quoted(executor.name)}"
    threads = len(executor.threads)
    several = f"; callbacks were called in {threads} threads: multi-threaded, or several executors" if threads > 1 else ""
    yield f"type: {GAP}{remark(f'its class in rclcpp{several}')}"
    for other in executor.others:
        called = counted(other.callback.threads.total(), "call")
        yield f"# Results leave out {quoted(other.name)}, which it calls, too: {called}, {_range(other.durations)}."
    if threads > 1:
        yield f"threads: {GAP} # at least {threads}, if it is multi-threaded; otherwise remove this line"
    yield from _scheduling(executor)


def _scheduling(executor: RecordedExecutor) -> Iterator[str]:
    seen = [each.scheduled for each in executor.threads if each.scheduled is not None]
    priorities = {priority for each in seen for priority in each.priorities}
    if len(seen) < len(executor.threads) or not priorities:
        yield f"thread: {GAP} # the scheduler was not recorded; for example {{policy: fifo, priority: 80, core: 0}}"
    elif all(priority >= 0 for priority in priorities):
        yield "thread: {policy: other}"
    elif len(priorities) == 1 and priorities <= set(_REAL_TIME):
        yield "thread:"
        yield f"  policy: {GAP} # fifo, if it is SCHED_FIFO; SCHED_RR was recorded in the same way"
        yield f"  priority: {-1 - priorities.pop()}"
        yield f"  core: {GAP}{remark(_cores(executor.threads))}"
    else:
        yield f"thread: {GAP} # recorded priorities of the kernel, less 100: {', '.join(map(str, sorted(priorities)))}"


def _node(node: str, callbacks: Sequence[RecordedCallback], executor: RecordedExecutor | None) -> Iterator[str]:
    yield f"name: {quoted(node)}"
    yield f"executor: {quoted(executor.name)}" if executor is not None else f"executor: {GAP} # no callback was called"
    for key, kind in (("subscriptions", RosCallbackKind.SUBSCRIPTION), ("timers", RosCallbackKind.TIMER)):
        of_kind = [each for each in callbacks if each.callback.kind is kind]
        if of_kind:
            yield f"{key}:"
        for each in of_kind:
            yield from item_lines(_callback(each), "  ")


def _callback(recorded: RecordedCallback) -> Iterator[str]:
    callback, subscription = recorded.callback, recorded.callback.subscription
    yield f"name: {quoted(recorded.name)}{remark(callback.symbol)}"
    if subscription is not None:
        yield f"topic: {quoted(subscription.topic)}" if subscription.topic else f"topic: {GAP}"
        yield f"depth: {subscription.depth or GAP}"
    else:
        known = isinstance(callback.of, int) and callback.of > 0
        yield f"period: {time_text(int(callback.of) * NANOSECOND) if known else GAP}"
    yield f"execution_time: {_execution_time(recorded)}"
    if callback.published:
        most = max(callback.published.values())
        topics = ", ".join(quoted(topic) for topic in callback.published)
        yield f"publishes: [{topics}]" if most == 1 else f"publishes: {GAP} # {_burst(recorded)}"


def _burst(recorded: RecordedCallback) -> str:
    counts = ", ".join(f"{quoted(topic)} up to {most} times" for topic, most in recorded.callback.published.items())
    return f"in one call {counts}; a description has one message of each topic in a call"


def _execution_time(recorded: RecordedCallback) -> str:
    busy, durations = recorded.callback.busy, recorded.durations
    if busy:
        calls = counted(len(busy), "call")
        return f"{{min: {time_text(min(busy))}, max: {time_text(max(busy))}}} # measured in {calls}; no bound"
    if durations is None:
        return f"{GAP} # no call of it was recorded; remove it if it is never called"
    calls = counted(durations.count, "call")
    return f"{GAP} # {_range(durations)} in {calls}, with preemption, and without what the executor does before"


def _range(durations: TimeStatistics | None) -> str:
    return "none of them complete" if durations is None else f"{time_text(durations.min)} to {time_text(durations.max)}"


def _topics(host: RecordedHost) -> Iterator[str]:
    """The topics that other things than described callbacks publish."""
    for topic, subscriptions in host.subscriptions().items():
        if host.publishers(topic):
            others = [
                *(["outside callbacks"] if topic in host.outside else []),
                *(["outside the recording"] if any(each.foreign for each in subscriptions) else []),
            ]
            if others:
                also = f"also published {' and '.join(others)}: give that a topic of its own"
                yield from item_lines(iter((f"topic: {quoted(topic)}", f"rate: {GAP} # {also}")), "  ")
            continue
        yield from item_lines(_topic(topic, arrivals_of(subscriptions)), "  ")


def _topic(topic: str, arrivals: RecordedArrivals | None) -> Iterator[str]:
    yield f"topic: {quoted(topic)}"
    if arrivals is None:
        yield f"rate: {GAP} # fewer than two messages with a source stamp were taken; at most so often are they published"
        yield f"jitter: {GAP} # of their arrival"
        return
    messages = counted(arrivals.count, "message")
    yield f"rate: {frequency_text(arrivals.rate)} # mean of {messages} that were taken; no bound"
    yield f"jitter: {GAP} # of their arrival: {time_text(arrivals.jitter)} at the publication, and how much the latency varies"
