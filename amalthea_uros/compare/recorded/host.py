"""A recording of ros2_tracing -> the executors, nodes and callbacks of a host, with what was measured of them.

A recording has no executors. The threads that call callbacks of the same node belong together, and so do the nodes whose callbacks the
same thread calls: these are taken as one executor, as nodes are added to one in most applications.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from amalthea_uros._internal.graphs import reached
from amalthea_uros._internal.records import dataclass
from amalthea_uros.compare.measured.events import measured_by
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.begins import ModelBegins
from amalthea_uros.measure.series import MeasuredKind, Measurement, TimeStatistics
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.trace.ctf.interpreters import LinuxThread
from amalthea_uros.trace.ctf.reader import CtfReader
from amalthea_uros.trace.ctf.ros2_objects import RosCallback, RosCallbackKind, RosSubscription

DESCRIBED = (RosCallbackKind.TIMER, RosCallbackKind.SUBSCRIPTION)


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedCallback:
    """A callback.

    Attributes
    ----------
    durations : from begin to end, with preemption; None if there is no complete execution
    """

    callback: RosCallback
    durations: TimeStatistics | None

    @property
    def name(self) -> str:
        """The name in the events of the trace."""
        return self.callback.name

    @property
    def is_described(self) -> bool:
        """Whether a description can have it."""
        return self.callback.kind in DESCRIBED and bool(self.callback.node)


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedThread:
    """A thread that calls callbacks; `scheduled` is None if its scheduling was not recorded."""

    number: int
    name: str
    scheduled: LinuxThread | None


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedExecutor:
    """An executor.

    Attributes
    ----------
    others : callbacks that a description cannot have
    """

    name: str
    threads: tuple[RecordedThread, ...]
    nodes: tuple[str, ...]
    others: tuple[RecordedCallback, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedHost:
    """The content of a recording.

    Attributes
    ----------
    computer : its name, "" if it is not recorded
    tracer : the version of ros2_tracing, "" if it is not recorded
    callbacks : those that a description can have, by their nodes
    outside : the topics that are also published outside callbacks
    unnamed : number of messages of publishers that are not known
    findings : of reading and measuring
    """

    computer: str
    tracer: str
    executors: tuple[RecordedExecutor, ...]
    callbacks: Mapping[str, tuple[RecordedCallback, ...]]
    outside: frozenset[str]
    unnamed: int
    findings: tuple[Finding, ...]

    def executor_of(self, node: str) -> RecordedExecutor | None:
        """The executor of a node, None if no callback of it was called."""
        return next((each for each in self.executors if node in each.nodes), None)

    def publishers(self, topic: str) -> list[RecordedCallback]:
        """The callbacks that a description has and that publish a topic."""
        return [each for of in self.callbacks.values() for each in of if topic in each.callback.published]

    def subscriptions(self) -> Mapping[str, list[RosSubscription]]:
        """The subscriptions of callbacks, by topic."""
        by_topic: dict[str, list[RosSubscription]] = {}
        for each in (each for of in self.callbacks.values() for each in of):
            if each.callback.subscription is not None:
                by_topic.setdefault(each.callback.subscription.topic, []).append(each.callback.subscription)
        return by_topic


def read_recording(path: Path) -> RecordedHost:
    """Read the recording in a folder.

    Raises
    ------
    ReadError : no metadata can be read.
    InvalidArgumentError : no callback of ROS 2 was recorded, or several computers were.
    """
    reader = CtfReader(path)
    measurement = measured_by(reader, path, MeasurementWindow(), ModelBegins())
    computers = [name for name in reader.computers if name]
    if len(computers) > 1:
        names = ", ".join(map(repr, computers))
        raise InvalidArgumentError(f"{str(path)!r} has recordings of several computers, {names}; import each of them alone")
    ros2 = reader.ros2
    callbacks = () if ros2 is None else ros2.callbacks()
    if ros2 is None or not any(each.threads for each in callbacks):
        raise InvalidArgumentError(
            f"{str(path)!r} has no callbacks of ROS 2; record the events 'ros2:*' with 'ros2 trace' before the nodes are started"
        )
    scheduled = {} if reader.scheduler is None else reader.scheduler.threads
    recorded = [_measured(each, measurement) for each in callbacks]
    threads = {
        number: RecordedThread(number=number, name=ros2.thread_name(number), scheduled=scheduled.get(number))
        for each in callbacks
        for number in each.threads
    }
    nodes: dict[str, list[RecordedCallback]] = {}
    for each in recorded:
        if each.is_described:
            nodes.setdefault(each.callback.node, []).append(each)
    return RecordedHost(
        computer=next(iter(computers), ""),
        tracer=ros2.objects.tracer,
        executors=tuple(_executors(recorded, threads)),
        callbacks={node: tuple(of) for node, of in nodes.items()},
        outside=frozenset(ros2.outside),
        unnamed=ros2.unnamed,
        findings=measurement.findings,
    )


def _measured(callback: RosCallback, measurement: Measurement) -> RecordedCallback:
    wanted = MeasuredKind.RUNNABLE, callback.name, JobMetric.GROSS_EXECUTION_TIME
    series = (each for each in measurement.series if (each.kind, each.name, each.quantity) == wanted)
    return RecordedCallback(callback=callback, durations=next((each.statistics for each in series), None))


def _executors(callbacks: Iterable[RecordedCallback], threads: Mapping[int, RecordedThread]) -> list[RecordedExecutor]:
    """The executors, in the order of their first callbacks."""
    called = {each.callback: each for each in callbacks if each.callback.threads}
    # Callbacks by what they have in common: the numbers of threads, and the names of nodes.
    sharing: dict[int | str, list[RosCallback]] = {}
    for callback in called:
        for common in _in_common(callback):
            sharing.setdefault(common, []).append(callback)

    def following(each: RosCallback | int | str) -> Iterable[RosCallback | int | str]:
        return _in_common(each) if isinstance(each, RosCallback) else sharing[each]

    executors: list[RecordedExecutor] = []
    seen: set[RosCallback] = set()
    for first in called:
        if first in seen:
            continue
        start: RosCallback | int | str = first
        connected = reached([start], following)
        group = [called[each] for each in connected if isinstance(each, RosCallback)]
        seen.update(each.callback for each in group)
        own = [threads[each] for each in connected if isinstance(each, int)]
        executors.append(
            RecordedExecutor(
                name=own[0].name,
                threads=tuple(own),
                nodes=tuple(dict.fromkeys(each.callback.node for each in group if each.is_described)),
                others=tuple(each for each in group if not each.is_described),
            )
        )
    return executors


def _in_common(callback: RosCallback) -> list[int | str]:
    return [*callback.threads, *([callback.node] if callback.node else [])]
