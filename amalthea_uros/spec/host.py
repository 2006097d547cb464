"""The host: computers with ROS 2 beside the controller, with executors, nodes and topics."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.fields import Limits, entry, examines
from amalthea_uros.spec.section import DescriptionSection
from amalthea_uros.spec.transports import LatencySection
from amalthea_uros.spec.values import Count, CountOrNone, Duration, Name, Rate, described, problem

_RELEASES = described(
    foxy="Ready sets in the order of registration.",
    galactic="Ready sets in the order of registration within a callback group.",
    humble="Ready sets in the order of registration within a callback group.",
    iron="Ready sets in the order of registration within a callback group.",
    jazzy="Ready sets in an unknown order within a kind; the static executor calls one callback for each wait.",
    rolling="Like jazzy.",
)
_POLICIES = described(
    fifo="`SCHED_FIFO`: a fixed priority.",
    deadline="`SCHED_DEADLINE`: a budget in each period.",
    other="`SCHED_OTHER`: no bound of the time until it runs, unless it is the only such thread of an isolated core.",
)
_EXECUTORS = described(
    single_threaded="`SingleThreadedExecutor`: one thread, which works off a ready set.",
    static_single_threaded="`StaticSingleThreadedExecutor`: subscriptions before timers.",
    multi_threaded="`MultiThreadedExecutor`: several threads share a ready set.",
    events="`EventsExecutor`: a queue in the order of events.",
)
_GROUPS = described(
    mutually_exclusive="Its callbacks do not overlap.",
    reentrant="Its callbacks can overlap, each with itself, too.",
)


class ComputerSection(DescriptionSection):
    """A computer with ROS 2."""

    name: Name
    """Name by which executors refer to it."""
    cores: Count = 1
    """Number of its cores."""
    isolated: list[CountOrNone] = entry(default_factory=list)
    """Cores on which only threads of `executors` run, e.g. with `isolcpus`: none of the middleware or the kernel either."""


class ThreadSection(DescriptionSection):
    """The thread of an executor, or each of its threads."""

    policy: Annotated[Literal["fifo", "deadline", "other"], _POLICIES] = "other"
    """Its scheduling policy."""
    priority: Annotated[int, Limits(ge=1, le=99)] | None = None
    """Priority of `SCHED_FIFO`; a higher number is a higher priority."""
    core: CountOrNone | None = None
    """Core on which it runs, counted from 0."""
    cores: Annotated[list[CountOrNone], Limits(min_length=1)] | None = None
    """Cores on which it may run; default: all."""
    budget: Duration | None = None
    """Budget of `SCHED_DEADLINE` in each period."""
    period: Duration | None = None
    """Period of `SCHED_DEADLINE`."""

    @examines
    def _is_complete(self) -> Self:
        needed = {"fifo": ("priority",), "deadline": ("budget", "period"), "other": ()}[self.policy]
        for key in needed:
            if getattr(self, key) is None:
                raise problem(f"the policy {self.policy!r} needs {key!r}")
        for key, policy in (("priority", "fifo"), ("budget", "deadline"), ("period", "deadline")):
            if getattr(self, key) is not None and key not in needed:
                raise problem(f"the policy {self.policy!r} has no {key!r}; set 'policy: {policy}', or remove it")
        if self.core is not None and self.cores is not None:
            raise problem("'core' cannot be combined with 'cores'")
        if self.budget is not None and self.period is not None and self.budget > self.period:
            raise problem("'budget' is greater than 'period'")
        return self


class HostExecutorSection(DescriptionSection):
    """An executor of the host."""

    name: Name
    """Name by which nodes refer to it."""
    computer: Name | None = None
    """Computer on which it runs; default: the only one."""
    type: Annotated[Literal["single-threaded", "static-single-threaded", "multi-threaded", "events"], _EXECUTORS] = (
        "single-threaded"
    )
    """Class of rclcpp."""
    threads: Count | None = None
    """Number of threads of a multi-threaded executor."""
    thread: ThreadSection = entry(default_factory=ThreadSection)
    """How its thread is scheduled."""

    @examines
    def _has_threads(self) -> Self:
        if self.type == "multi-threaded" and self.threads is None:
            raise problem("a multi-threaded executor needs 'threads': the default of rclcpp depends on the computer")
        if self.type != "multi-threaded" and self.threads is not None:
            raise problem(f"an executor of type {self.type!r} has no 'threads'")
        return self


class HostCallbackSection(DescriptionSection):
    """Keys that all callbacks of the host have."""

    name: Name
    """Name of the callback."""
    execution_time: ExecutionTimeSection
    """Execution time of the callback, with taking its message and publishing."""
    reads: list[Name] = entry(default_factory=list)
    """Variables that it reads at its start."""
    writes: list[Name] = entry(default_factory=list)
    """Variables that it writes at its end."""
    publishes: list[Name] = entry(default_factory=list)
    """Topics that it publishes at its end."""
    calls: list[Name] = entry(default_factory=list)
    """Services of the host that it calls at its end, without waiting for the response."""
    group: Name | None = None
    """Callback group of its node; default: that of the node itself, which is mutually exclusive."""


class HostSubscription(HostCallbackSection):
    """A subscription of the host."""

    topic: Name
    """Topic that it subscribes to."""
    depth: Count = 10
    """Depth of its queue (KEEP_LAST); default: that of rclcpp."""


class HostTimer(HostCallbackSection):
    """A timer of the host."""

    period: Duration
    """Its period."""


class HostServiceCallback(HostCallbackSection):
    """Keys that services and clients of the host have."""

    service: Name
    """Name of the service."""
    depth: Count = 10
    """Depth of its queue (KEEP_LAST); default: that of rclcpp."""


class HostService(HostServiceCallback):
    """A service of the host; its response is sent at the end of the callback."""


class HostClient(HostServiceCallback):
    """A client of the host: the callback of its responses."""


class CallbackGroupSection(DescriptionSection):
    """A callback group."""

    name: Name
    """Name by which callbacks of the node refer to it."""
    type: Annotated[Literal["mutually-exclusive", "reentrant"], _GROUPS] = "mutually-exclusive"
    """Whether its callbacks can overlap in a multi-threaded executor."""


class HostNodeSection(DescriptionSection):
    """A node of the host; its callbacks are registered in the order of the file."""

    name: Name
    """Name of the node."""
    executor: Name
    """Executor that it was added to."""
    groups: list[CallbackGroupSection] = entry(default_factory=list)
    """Its callback groups, besides the default one."""
    subscriptions: list[HostSubscription] = entry(default_factory=list)
    """Its subscriptions."""
    timers: list[HostTimer] = entry(default_factory=list)
    """Its timers."""
    services: list[HostService] = entry(default_factory=list)
    """Its services."""
    clients: list[HostClient] = entry(default_factory=list)
    """Its clients."""


class HostTopicSection(DescriptionSection):
    """A topic of the host."""

    topic: Name
    """Name of the topic."""
    latency: LatencySection | None = None
    """From its publication, or from the agent, to the queue of a subscription or to the agent; default: `latency` of the host."""
    rate: Rate | None = None
    """Maximum rate of its messages, if nothing described publishes it."""
    jitter: Duration | None = None
    """Maximum delay of its messages in the queue of a subscription against their nominal times, for `rate`."""


class HostSection(DescriptionSection):
    """Computers with ROS 2 beside the controller."""

    ros: Annotated[Literal["foxy", "galactic", "humble", "iron", "jazzy", "rolling"], _RELEASES]
    """Distribution of ROS 2, which decides how executors work."""
    computers: list[ComputerSection] = entry(min_length=1)
    """The computers."""
    latency: LatencySection | None = None
    """Latency of all topics without their own."""
    executors: list[HostExecutorSection] = entry(default_factory=list)
    """The executors."""
    nodes: list[HostNodeSection] = entry(default_factory=list)
    """The nodes."""
    topics: list[HostTopicSection] = entry(default_factory=list)
    """Topics with a latency or a rate of their own."""
