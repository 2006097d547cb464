"""The application model: nodes with their subscriptions, publishers, timers, services and clients."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal

from amalthea_uros.spec.execution_time import ExecutionTimeSection
from amalthea_uros.spec.fields import Examples, Limits, entry
from amalthea_uros.spec.message_types import BoundsSection, TypedMessage, TypeName
from amalthea_uros.spec.os import OverheadSection
from amalthea_uros.spec.section import DescriptionSection
from amalthea_uros.spec.values import Count, Duration, Name, Offset, Priority, Rate, Size, described

Reliability = Annotated[
    Literal["reliable", "best-effort"],
    described(
        reliable="Messages are acknowledged, and sent again until they are.",
        best_effort="Messages are sent once, without acknowledgement.",
    ),
]


_INVOCATIONS = described(
    on_new_data="When a message has arrived.",
    always="In every iteration whose trigger condition is true, with or without a message.",
)
_HISTORIES = described(
    keep_last="Of more messages than `depth`, the oldest one is overwritten.",
    keep_all="Of more messages than `depth`, the new one is dropped.",
)
_CONDITIONS = described(
    activated="In every activation of its task.",
    due="Only in the activations of its task in which it is due.",
)


class CallbackSection(DescriptionSection):
    """Keys that all callbacks have."""

    name: Name
    """Name of the callback, and of its task."""
    execution_time: ExecutionTimeSection
    """Execution time of the callback."""
    reads: list[Name] = entry(default_factory=list)
    """Labels that it reads at its start."""
    writes: list[Name] = entry(default_factory=list)
    """Labels that it writes at its end."""
    publishes: list[Name] = entry(default_factory=list)
    """Topics that it publishes to: those of its node, or of another node if only one has a publisher for it."""
    requests: list[Name] = entry(default_factory=list)
    """Clients of its node that it sends requests with."""
    runs_in: Annotated[Name, Examples(["own-task", "executor"])] | None = None
    """Where it runs: `own-task`, a separate task; `executor`, the first executor; or the name of an executor; default: that of its
    node, else `callbacks` of the executor."""
    task_period: Duration | None = None
    """Period of its task; default: the longest available period that the rules allow."""
    runs_when: Annotated[Literal["activated", "due"], _CONDITIONS] | None = None
    """In which activations of its task it runs, if that is activated more often than the callback is due: in all of them, or only in
    every n-th; default: `activated` for callbacks of messages, which then use the latest message, and `due` for timers."""
    phase: Offset | None = None
    """Activation of the executor in which it is due for the first time, e.g. when the first message is taken; default: unknown, so that
    all phases are analysed."""
    offset: Offset = 0
    """Time of the first activation of its task."""
    priority: Priority | None = None
    """Priority of its task; default: rate monotonic."""
    core: Name | None = None
    """Core of its task; default: the core of its node."""
    deadline: Duration | None = None
    """Deadline relative to the activation of its task."""
    overhead: OverheadSection | None = None
    """Overhead of the operating system per job of its task; default: that of `os`."""
    stack: Size | None = None
    """Stack of its task; for tasks that share one stack: the most that it uses itself. In the executor it uses the stack of that."""


class MessageCallback(CallbackSection):
    """A callback that becomes ready when a message arrives."""

    rate: Rate | None = None
    """Maximum rate of messages."""
    interval: Duration | None = None
    """Minimum time between two messages; the reciprocal of `rate`."""
    buffer: Name | None = None
    """Label in which the executor passes the message on; default: the name followed by `_message`."""
    depth: Count | None = None
    """Depth of the history of its quality of service; default: 10 if reliable, 5 if best effort."""
    history: Annotated[Literal["keep-last", "keep-all"], _HISTORIES] = "keep-last"
    """What happens to messages beyond `depth`."""


class Subscription(TypedMessage, MessageCallback):
    """A subscription with its callback."""

    topic: Name
    """Topic that it subscribes to."""
    message_size: Size
    """Size of the longest message, without headers; default: that of the type, if it is a common one."""
    jitter: Duration | None = None
    """Maximum delay of a message against its nominal time, shorter than `interval`; default: messages arrive regularly."""
    invocation: Annotated[Literal["on-new-data", "always"], _INVOCATIONS] = "on-new-data"
    """When its callback is called."""
    reliability: Reliability = "reliable"
    """Quality of service."""


class GuardCondition(CallbackSection):
    """A guard condition that the application triggers, with its callback."""

    interval: Duration | None = None
    """Minimum time between two triggers."""
    rate: Rate | None = None
    """Maximum rate of triggers; the reciprocal of `interval`."""


class Timer(CallbackSection):
    """A timer with its callback."""

    period: Duration | None = None
    """Period of the timer."""
    rate: Rate | None = None
    """Rate of the timer; the reciprocal of `period`."""


class Publisher(TypedMessage):
    """A publisher that callbacks of the node send messages with."""

    topic: Name
    """Topic that it publishes to."""
    message_size: Size
    """Size of the longest message, without headers; default: that of the type, if it is a common one."""
    reliability: Reliability = "reliable"
    """Quality of service."""


class ServiceSection(TypedMessage, MessageCallback):
    """A service server; its callback answers requests."""

    sizes: ClassVar[Mapping[str, str]] = {"request_size": "Request", "response_size": "Response"}

    type: TypeName | None = None
    """Type of the service, e.g. `std_srvs/srv/SetBool`."""
    bounds: BoundsSection | None = None
    """Longest strings and sequences of requests and responses, where the type does not bound them."""
    request_size: Size
    """Size of a request, without headers."""
    response_size: Size
    """Size of a response, without headers."""


class Client(TypedMessage, MessageCallback):
    """A service client; its callback receives the responses."""

    sizes: ClassVar[Mapping[str, str]] = {"request_size": "Request", "response_size": "Response"}

    type: TypeName | None = None
    """Type of the service, e.g. `std_srvs/srv/SetBool`."""
    bounds: BoundsSection | None = None
    """Longest strings and sequences of requests and responses, where the type does not bound them."""
    service: Name
    """Service that it sends requests to."""
    request_size: Size
    """Size of a request, without headers."""
    response_size: Size
    """Size of a response, without headers."""


class ActionServer(TypedMessage, MessageCallback):
    """An action server: three services and a timer of the middleware behind one handle."""

    sizes: ClassVar[Mapping[str, str]] = {"goal_size": "Goal", "result_size": "Result", "feedback_size": "Feedback"}

    type: TypeName | None = None
    """Type of the action, e.g. `example_interfaces/action/Fibonacci`."""
    bounds: BoundsSection | None = None
    """Longest strings and sequences of its messages, where the type does not bound them."""
    goal_size: Size
    """Size of a goal, without headers."""
    result_size: Size
    """Size of a result, without headers."""
    feedback_size: Size
    """Size of a feedback message, without headers."""


class ActionClient(TypedMessage, MessageCallback):
    """An action client: three clients and two subscriptions of the middleware behind one handle."""

    sizes: ClassVar[Mapping[str, str]] = {"goal_size": "Goal", "result_size": "Result", "feedback_size": "Feedback"}

    type: TypeName | None = None
    """Type of the action, e.g. `example_interfaces/action/Fibonacci`."""
    bounds: BoundsSection | None = None
    """Longest strings and sequences of its messages, where the type does not bound them."""
    action: Name
    """Action that it sends goals to."""
    goal_size: Size
    """Size of a goal, without headers."""
    result_size: Size
    """Size of a result, without headers."""
    feedback_size: Size
    """Size of a feedback message, without headers."""


class ParameterServer(DescriptionSection):
    """The parameter server of a node: six services, and a publisher for changes."""

    execution_time: ExecutionTimeSection
    """Execution time of answering a request."""
    rate: Rate | None = None
    """Maximum rate of requests."""
    interval: Duration | None = None
    """Minimum time between two requests; the reciprocal of `rate`."""
    events: bool = True
    """Whether it publishes changes of parameters."""
    low_memory: bool = False
    """Whether it is built for little memory."""
    runs_in: Name | None = None
    """The executor that serves it; default: that of its node."""


class Lifecycle(DescriptionSection):
    """The services of a lifecycle node."""

    services: Annotated[int, Limits(ge=1, le=3)] = 3
    """Number of services that are added to the executor."""
    execution_time: ExecutionTimeSection
    """Execution time of answering a request."""
    rate: Rate | None = None
    """Maximum rate of requests."""
    interval: Duration | None = None
    """Minimum time between two requests; the reciprocal of `rate`."""
    runs_in: Name | None = None
    """The executor that serves them; default: that of its node."""


class NodeSection(DescriptionSection):
    """A node."""

    name: Name
    """Name of the node."""
    core: Name | None = None
    """Core of its callbacks; default: the first core."""
    runs_in: Annotated[Name, Examples(["own-task", "executor"])] | None = None
    """Where its callbacks run, unless they say otherwise: `own-task`, `executor`, or the name of an executor."""
    subscriptions: list[Subscription] = entry(default_factory=list)
    """Its subscriptions."""
    publishers: list[Publisher] = entry(default_factory=list)
    """Its publishers."""
    timers: list[Timer] = entry(default_factory=list)
    """Its timers."""
    services: list[ServiceSection] = entry(default_factory=list)
    """Its service servers."""
    clients: list[Client] = entry(default_factory=list)
    """Its service clients."""
    guard_conditions: list[GuardCondition] = entry(default_factory=list)
    """Its guard conditions."""
    action_servers: list[ActionServer] = entry(default_factory=list)
    """Its action servers."""
    action_clients: list[ActionClient] = entry(default_factory=list)
    """Its action clients."""
    parameter_server: ParameterServer | None = None
    """Its parameter server."""
    lifecycle: Lifecycle | None = None
    """Its lifecycle services."""


class Application(DescriptionSection):
    """The micro-ROS application."""

    nodes: list[NodeSection] = entry(default_factory=list)
    """Its nodes."""
