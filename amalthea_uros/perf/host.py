"""The host: computers with ROS 2, whose executors call callbacks in threads, and topics between them.

Its executors differ from those of `perf.executors`: they work off a ready set or a queue, and each distribution of ROS 2 has rules
of its own. Kinds of handles and bounds of times are the same.
"""

from __future__ import annotations

from enum import StrEnum

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.named import Brief, Named
from amalthea_uros.perf.network import Span
from amalthea_uros.units import Time

#: The kind of the custom events that stand for callbacks of the host in chains.
HOST_EVENT = "callback of the host"


class RosRelease(StrEnum):
    """A distribution of ROS 2, in the order of release; the values are those of files."""

    FOXY = "foxy"
    GALACTIC = "galactic"
    HUMBLE = "humble"
    IRON = "iron"
    JAZZY = "jazzy"
    ROLLING = "rolling"

    @property
    def keeps_batches(self) -> bool:
        """Whether static executors call the whole ready set before the next wait (rclcpp before ros2/rclcpp#2142)."""
        return self not in (RosRelease.JAZZY, RosRelease.ROLLING)


class HostExecutorKind(StrEnum):
    """The class of an executor in rclcpp; the values are those of files."""

    SINGLE_THREADED = "single-threaded"
    STATIC = "static-single-threaded"
    MULTI_THREADED = "multi-threaded"
    EVENTS = "events"


class HostPolicy(StrEnum):
    """The scheduling policy of a thread; the values are those of files."""

    FIFO = "fifo"
    DEADLINE = "deadline"
    OTHER = "other"


@dataclass(frozen=True, slots=True, kw_only=True)
class HostThread(Brief):
    """The thread of an executor, or each of its threads.

    Attributes
    ----------
    priority : of SCHED_FIFO; the larger one is served first
    cores : on which it may run, counted from 0; empty for all
    budget, period : of SCHED_DEADLINE
    """

    policy: HostPolicy = HostPolicy.OTHER
    priority: int = 0
    cores: tuple[int, ...] = ()
    budget: Time = 0
    period: Time = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class HostCallback(Named):
    """A callback.

    Attributes
    ----------
    kind : a timer, a subscription, a service or a client
    execution : bounds of its execution time, without preemption
    period : of a timer
    topic, depth : whose messages call it, and how many of them its queue keeps (KEEP_LAST); requests and responses are messages
    publishes : topics, at its end
    reads, writes : variables, at its start and at its end
    group : the callback group, unique in the host
    is_reentrant : whether the callbacks of the group may overlap
    """

    kind: HandleKind
    execution: Span
    period: Time | None = None
    topic: str | None = None
    depth: int = 10
    publishes: tuple[str, ...] = ()
    reads: tuple[str, ...] = ()
    writes: tuple[str, ...] = ()
    group: str = ""
    is_reentrant: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class HostExecutor(Named):
    """An executor.

    Attributes
    ----------
    threads : their number, of a multi-threaded one
    callbacks : in the order of registration
    """

    computer: str
    kind: HostExecutorKind = HostExecutorKind.SINGLE_THREADED
    thread: HostThread = field(default_factory=HostThread)
    threads: int = 1
    callbacks: tuple[HostCallback, ...] = ()

    def works_off_ready_sets(self, release: RosRelease) -> bool:
        """Whether one thread calls all that a poll has found before it polls again."""
        is_static = self.kind is HostExecutorKind.STATIC
        return self.kind is HostExecutorKind.SINGLE_THREADED or (is_static and release.keeps_batches)

    def rank(self, callback: HostCallback, release: RosRelease) -> int:
        """The place of the kind of a callback in a ready set (rclcpp `allocator_memory_strategy.hpp`, `wait_result.hpp`).

        Static executors call subscriptions first; from jazzy on, they call clients before services.
        """
        first, second = HandleKind.TIMER, HandleKind.SUBSCRIPTION
        third, fourth = HandleKind.SERVICE, HandleKind.CLIENT
        if self.kind is HostExecutorKind.STATIC:
            first, second = second, first
            if not release.keeps_batches:
                third, fourth = fourth, third
        return (first, second, third, fourth).index(callback.kind)


@dataclass(frozen=True, slots=True, kw_only=True)
class HostComputer(Named):
    """A computer.

    Attributes
    ----------
    isolated : cores on which no thread runs that is not described
    """

    cores: int
    isolated: tuple[int, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class HostTopic(Named):
    """A topic of the host.

    Attributes
    ----------
    latency : from a publication, or its arrival from the agent, until it is in the queue of a subscription
    interval, jitter : of messages that nothing described publishes; None if that is unknown
    """

    latency: Span = field(default_factory=Span)
    interval: Time | None = None
    jitter: Time = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Host(Brief):
    """The computers with ROS 2 beside the controller."""

    release: RosRelease = RosRelease.FOXY
    computers: tuple[HostComputer, ...] = ()
    executors: tuple[HostExecutor, ...] = ()
    topics: tuple[HostTopic, ...] = ()

    def computer_of(self, executor: HostExecutor) -> HostComputer:
        """The computer of an executor."""
        return next(computer for computer in self.computers if computer.name == executor.computer)

    def is_fairly_shared(self, executor: HostExecutor) -> bool:
        """Whether threads of SCHED_OTHER can delay an executor: it is one, and not the only one of an isolated core."""
        if executor.thread.policy is not HostPolicy.OTHER:
            return False
        cores, isolated = executor.thread.cores, self.computer_of(executor).isolated
        rivals = [
            other
            for other in self.executors
            if other.computer == executor.computer
            and other.thread.policy is HostPolicy.OTHER
            and (not other.thread.cores or set(other.thread.cores).intersection(cores))
        ]
        is_one_thread = executor.kind is not HostExecutorKind.MULTI_THREADED
        return len(cores) != 1 or cores[0] not in isolated or len(rivals) > 1 or not is_one_thread

    @property
    def callbacks(self) -> tuple[HostCallback, ...]:
        """The callbacks of all executors."""
        return tuple(callback for executor in self.executors for callback in executor.callbacks)

    @property
    def callback_names(self) -> frozenset[str]:
        """The names of the callbacks."""
        return frozenset(callback.name for callback in self.callbacks)
