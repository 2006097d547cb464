"""The objects of ROS 2 that a recording of ros2_tracing names: nodes, publishers, subscriptions, timers, services and their callbacks.

Events refer to objects by addresses. These are unique in their process only, and used again after an object is gone, so that each
creation is an object of its own.
"""

from __future__ import annotations

from array import array
from collections import Counter
from collections.abc import Callable, Iterator
from enum import StrEnum
from typing import ClassVar, TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.trace.ctf.streams import CtfEvent

_PERIOD_UNITS = ((10**9, "s"), (10**6, "ms"), (10**3, "us"), (1, "ns"))

#: Process, address.
RosAddress: TypeAlias = tuple[int, int]


class RosCallbackKind(StrEnum):
    """The kind of object that a callback belongs to."""

    TIMER = "timer"
    SUBSCRIPTION = "subscription"
    SERVICE = "service"
    UNKNOWN = "callback"


@dataclass(slots=True, eq=False)
class RosSubscription:
    """A subscription.

    Attributes
    ----------
    depth : of its queue; 0 if the recording does not say it
    chain : index of the entity, -1 until a message is published
    published : source stamp -> number of the publication; those that are not known to have arrived
    stamps : the source stamps of the messages that were taken
    foreign : number of messages that nothing in the recording has published, if publications are recorded with their stamps
    """

    topic: str
    node: str
    depth: int = 0
    chain: int = -1
    count: int = 0
    published: dict[int, int] = field(default_factory=dict)
    stamps: array[int] = field(default_factory=lambda: array("q"))
    foreign: int = 0


@dataclass(slots=True, eq=False)
class RosCallback:
    """A callback, and its recorded behaviour.

    Attributes
    ----------
    address : where it is
    of : the name of the service, or the period of the timer in ns
    symbol : the function
    name : in the events of the trace, "" until it is called
    threads : the threads that called it
    published : topic -> the most messages that it published in one call
    is_within_process : whether it was called with a message within the process
    busy : what each call took its thread, in picoseconds; without those of which that is not known
    """

    address: RosAddress
    kind: RosCallbackKind = RosCallbackKind.UNKNOWN
    node: str = ""
    of: str | int = ""
    symbol: str = ""
    subscription: RosSubscription | None = None
    name: str = ""
    threads: Counter[int] = field(default_factory=Counter)
    published: Counter[str] = field(default_factory=Counter)
    is_within_process: bool = False
    busy: array[int] = field(default_factory=lambda: array("q"))

    @property
    def label(self) -> str:
        """Its name for people; several can have the same label."""
        match self.kind:
            case RosCallbackKind.UNKNOWN:
                return self.symbol
            case RosCallbackKind.TIMER:
                what = f"timer {_period(self.of)}"
                return f"{self.node} {what}" if self.node else what
            case RosCallbackKind.SUBSCRIPTION if self.subscription is not None:
                return f"{self.node} subscription {self.subscription.topic}"
        return f"{self.node} {self.kind} {self.of}"


class RosObjects:
    """Takes the events of creations.

    Attributes
    ----------
    callbacks : those that are at an address now
    subscriptions : by their handles in rcl; `by_middleware` has them by those in rmw
    topics : of publishers, by their handles in rcl and in rmw
    tracer : the version of ros2_tracing
    """

    def __init__(self) -> None:
        self.callbacks: dict[RosAddress, RosCallback] = {}
        self.subscriptions: dict[RosAddress, RosSubscription] = {}
        self.by_middleware: dict[RosAddress, RosSubscription] = {}
        self.topics: dict[RosAddress, str] = {}
        self.topics_of_middleware: dict[RosAddress, str] = {}
        self.tracer = ""
        self._gone: list[RosCallback] = []
        self._nodes: dict[RosAddress, str] = {}
        self._by_object: dict[RosAddress, RosSubscription] = {}
        self._periods: dict[RosAddress, int] = {}
        self._services: dict[RosAddress, tuple[str, str]] = {}
        self._of_timer: dict[RosAddress, RosCallback] = {}

    def add(self, event: CtfEvent) -> None:
        """Take an event."""
        self.handlers[event.name](self, event)

    def known(self) -> Iterator[RosCallback]:
        """Every callback that is or was there, in the order of creation as far as addresses were not used again."""
        yield from (*self._gone, *self.callbacks.values())

    def callback(self, event: CtfEvent) -> RosCallback:
        """The callback of an event; one that was not created in the recording is known by its address."""
        address = address_of(event, "callback")
        return self.callbacks.setdefault(address, RosCallback(address))

    def _node(self, event: CtfEvent) -> str:
        return self._nodes.get(address_of(event, "node_handle"), "")

    def _create(self, callback: RosCallback) -> None:
        """A callback has been created; the one that was at its address before is gone."""
        before = self.callbacks.pop(callback.address, None)
        if before is not None:
            self._gone.append(before)
        self.callbacks[callback.address] = callback

    def _init(self, event: CtfEvent) -> None:
        self.tracer = str(event.fields.get("version", ""))

    def _node_init(self, event: CtfEvent) -> None:
        fields = event.fields
        namespace = str(fields.get("namespace", "/")).rstrip("/")
        self._nodes[address_of(event, "node_handle")] = f"{namespace}/{fields.get('node_name', '')}".lstrip("/")

    def _publisher_init(self, event: CtfEvent) -> None:
        topic = str(event.fields.get("topic_name", ""))
        self.topics[address_of(event, "publisher_handle")] = topic
        self.topics_of_middleware[address_of(event, "rmw_publisher_handle")] = topic

    def _subscription_init(self, event: CtfEvent) -> None:
        depth = event.fields.get("queue_depth", 0)
        subscription = RosSubscription(
            str(event.fields.get("topic_name", "")), self._node(event), depth if isinstance(depth, int) else 0
        )
        self.subscriptions[address_of(event, "subscription_handle")] = subscription
        self.by_middleware[address_of(event, "rmw_subscription_handle")] = subscription

    def _subscription_object(self, event: CtfEvent) -> None:
        subscription = self.subscriptions.get(address_of(event, "subscription_handle"))
        if subscription is not None:
            self._by_object[address_of(event, "subscription")] = subscription

    def _subscription_callback(self, event: CtfEvent) -> None:
        subscription = self._by_object.get(address_of(event, "subscription"))
        if subscription is not None:
            kind = RosCallbackKind.SUBSCRIPTION
            self._create(RosCallback(address_of(event, "callback"), kind, subscription.node, subscription=subscription))

    def _service_init(self, event: CtfEvent) -> None:
        handle = address_of(event, "service_handle")
        self._services[handle] = self._node(event), str(event.fields.get("service_name", ""))

    def _service_callback(self, event: CtfEvent) -> None:
        service = self._services.get(address_of(event, "service_handle"))
        if service is not None:
            self._create(RosCallback(address_of(event, "callback"), RosCallbackKind.SERVICE, *service))

    def _timer_init(self, event: CtfEvent) -> None:
        period = event.fields.get("period", 0)
        self._periods[address_of(event, "timer_handle")] = period if isinstance(period, int) else 0

    def _timer_callback(self, event: CtfEvent) -> None:
        timer = address_of(event, "timer_handle")
        callback = RosCallback(address_of(event, "callback"), RosCallbackKind.TIMER, node="", of=self._periods.get(timer, 0))
        self._create(callback)
        self._of_timer[timer] = callback

    def _timer_node(self, event: CtfEvent) -> None:
        callback, node = self._of_timer.get(address_of(event, "timer_handle")), self._node(event)
        if callback is not None and node:
            callback.node = node

    def _callback_register(self, event: CtfEvent) -> None:
        self.callback(event).symbol = str(event.fields.get("symbol", ""))

    handlers: ClassVar[dict[str, Callable[[RosObjects, CtfEvent], None]]] = {
        "ros2:rcl_init": _init,
        "ros2:rcl_node_init": _node_init,
        "ros2:rcl_publisher_init": _publisher_init,
        "ros2:rcl_subscription_init": _subscription_init,
        "ros2:rclcpp_subscription_init": _subscription_object,
        "ros2:rclcpp_subscription_callback_added": _subscription_callback,
        "ros2:rcl_service_init": _service_init,
        "ros2:rclcpp_service_callback_added": _service_callback,
        "ros2:rcl_timer_init": _timer_init,
        "ros2:rclcpp_timer_callback_added": _timer_callback,
        "ros2:rclcpp_timer_link_node": _timer_node,
        "ros2:rclcpp_callback_register": _callback_register,
    }


def address_of(event: CtfEvent, name: str) -> RosAddress:
    """The address in a field, with the process of the event."""
    address = event.fields.get(name, 0)
    return event.context.get("vpid", 0), address if isinstance(address, int) else 0


def _period(nanoseconds: object) -> str:
    if not isinstance(nanoseconds, int) or nanoseconds <= 0:
        return ""
    size, unit = next((size, unit) for size, unit in _PERIOD_UNITS if nanoseconds % size == 0)
    return f"{nanoseconds // size} {unit}"
