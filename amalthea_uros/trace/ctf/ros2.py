"""The events of ros2_tracing: callbacks as runnables of their threads, and messages from publication to callback as chains.

A chain is there for each subscription: step 0 is the publication, step 1 the begin of the callback that takes the message. The two
are matched by the topic and the source stamp of the message; occurrences are numbered by publication, so lost ones show.
"""

from __future__ import annotations

from typing import ClassVar, TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.ctf.interpreters import Handler, Interpreter
from amalthea_uros.trace.ctf.streams import CtfEvent
from amalthea_uros.trace.files import TracePlace, TraceProblems
from amalthea_uros.trace.reading import EventRows
from amalthea_uros.trace.schedulers.thread_log import UniqueNames
from amalthea_uros.trace.schedulers.thread_states import ThreadStates
from amalthea_uros.trace.table import EntityKind, EventKind

#: So many publications of a topic wait for their callbacks at most.
_MOST_PENDING = 1 << 16
_PERIOD_UNITS = ((10**9, "s"), (10**6, "ms"), (10**3, "us"), (1, "ns"))

#: Addresses are unique in their process only: process, address.
_Address: TypeAlias = tuple[int, int]


@dataclass(slots=True)
class _RosSubscription:
    """A subscription.

    Attributes
    ----------
    chain : index of the entity, -1 until a message is published
    published : source stamp -> number of the publication; those that are not known to have arrived
    """

    topic: str
    node: str
    chain: int = -1
    count: int = 0
    published: dict[int, int] = field(default_factory=dict)


class Ros2(Interpreter):
    """Takes the events of ROS 2; what was created before the recording has no name but its address."""

    def __init__(self, rows: EventRows, states: ThreadStates, problems: TraceProblems, names: UniqueNames) -> None:
        super().__init__(rows, states, problems, names)
        self._nodes: dict[_Address, str] = {}
        self._topics: dict[_Address, str] = {}
        self._subscriptions: dict[_Address, _RosSubscription] = {}
        self._by_middleware: dict[_Address, _RosSubscription] = {}
        self._by_object: dict[_Address, _RosSubscription] = {}
        #: The names of timers and services by their handles, and the callbacks of timers.
        self._timers: dict[_Address, str] = {}
        self._of_timer: dict[_Address, _Address] = {}
        self._chains: dict[str, int] = {}
        self._callbacks: dict[_Address, str] = {}
        self._registered: dict[_Address, int] = {}
        self._of_callback: dict[_Address, _RosSubscription] = {}
        self._executing: dict[tuple[int, _Address], list[int]] = {}
        #: Of each thread the message that it has taken last, of which the callback has not begun.
        self._taken: dict[int, tuple[_RosSubscription, int]] = {}

    def _node_init(self, event: CtfEvent) -> None:
        fields = event.fields
        namespace = str(fields.get("namespace", "/")).rstrip("/")
        self._nodes[_address(event, "node_handle")] = f"{namespace}/{fields.get('node_name', '')}".lstrip("/")

    def _publisher_init(self, event: CtfEvent) -> None:
        topic = str(event.fields.get("topic_name", ""))
        self._topics[_address(event, "rmw_publisher_handle")] = topic

    def _subscription_init(self, event: CtfEvent) -> None:
        handle = _address(event, "subscription_handle")
        found = self._subscriptions[handle] = _RosSubscription(str(event.fields.get("topic_name", "")), self._node(event))
        self._by_middleware[_address(event, "rmw_subscription_handle")] = found

    def _subscription_object(self, event: CtfEvent) -> None:
        found = self._subscriptions.get(_address(event, "subscription_handle"))
        if found is not None:
            self._by_object[_address(event, "subscription")] = found

    def _subscription_callback(self, event: CtfEvent) -> None:
        callback, found = _address(event, "callback"), self._by_object.get(_address(event, "subscription"))
        if found is not None:
            self._name(callback, f"{found.node} subscription {found.topic}")
            self._of_callback[callback] = found

    def _service_init(self, event: CtfEvent) -> None:
        self._timers[_address(event, "service_handle")] = f"{self._node(event)} service {event.fields.get('service_name', '')}"

    def _service_callback(self, event: CtfEvent) -> None:
        name = self._timers.get(_address(event, "service_handle"))
        if name is not None:
            self._name(_address(event, "callback"), name)

    def _timer_init(self, event: CtfEvent) -> None:
        self._timers[_address(event, "timer_handle")] = f"timer {_period(event.fields.get('period', 0))}"

    def _timer_callback(self, event: CtfEvent) -> None:
        timer, callback = _address(event, "timer_handle"), _address(event, "callback")
        self._name(callback, self._timers.get(timer, "timer"))
        self._of_timer[timer] = callback

    def _timer_node(self, event: CtfEvent) -> None:
        timer, node = _address(event, "timer_handle"), self._node(event)
        callback = self._of_timer.get(timer)
        if callback is not None and node:
            self._callbacks[callback] = f"{node} {self._callbacks[callback]}"

    def _callback_register(self, event: CtfEvent) -> None:
        callback = _address(event, "callback")
        self._callbacks.setdefault(callback, str(event.fields.get("symbol", "")))

    def _callback_start(self, event: CtfEvent) -> None:
        callback, thread = _address(event, "callback"), self._thread(event)
        taken = self._taken.pop(_thread_number(event), None)
        if event.fields.get("is_intra_process"):
            self._inform("messages within a process have no publication in the trace, so their latencies are not known")
        elif taken is not None and self._of_callback.get(callback) is taken[0]:
            subscription, number = taken
            self._rows.add(EventKind.CHAIN_STEP, thread, self._states.job(thread), subscription.chain, number, 1)
        runnable = self._runnable(callback)
        self._executing.setdefault((_thread_number(event), callback), []).append(runnable)
        self._states.start_runnable(thread, runnable)

    def _callback_end(self, event: CtfEvent) -> None:
        started = self._executing.get((_thread_number(event), _address(event, "callback")))
        runnable = started.pop() if started else self._runnable(_address(event, "callback"))
        self._states.end_runnable(self._thread(event), runnable)

    def _publish(self, event: CtfEvent) -> None:
        topic, stamp = self._topics.get(_address(event, "rmw_publisher_handle")), event.fields.get("timestamp")
        if topic is None or not isinstance(stamp, int) or not stamp:
            self._inform(
                "publications without a source stamp, or by publishers that are older than the trace, are not followed"
            )
            return
        thread = self._thread(event)
        for subscription in self._subscriptions.values():
            if subscription.topic == topic:
                self._follow(subscription, stamp, thread)

    def _follow(self, subscription: _RosSubscription, stamp: int, thread: int) -> None:
        if subscription.chain < 0:
            name = f"{subscription.topic} -> {subscription.node}"
            number = self._chains[name] = self._chains.get(name, 0) + 1
            subscription.chain = self._entity(EntityKind.CHAIN, name if number == 1 else f"{name} ({number})")
        occurrence, subscription.count = subscription.count, subscription.count + 1
        self._rows.add(EventKind.CHAIN_STEP, thread, self._states.job(thread), subscription.chain, occurrence, 0)
        if stamp in subscription.published:
            self._inform("two publications on a topic have the same source stamp; neither is matched with a callback")
            subscription.published[stamp] = -1
            return
        subscription.published[stamp] = occurrence
        if len(subscription.published) > _MOST_PENDING:
            del subscription.published[next(iter(subscription.published))]

    def _take(self, event: CtfEvent) -> None:
        fields, thread = event.fields, _thread_number(event)
        self._taken.pop(thread, None)
        if not fields.get("taken", 1):
            return
        subscription = self._by_middleware.get(_address(event, "rmw_subscription_handle"))
        number = subscription.published.get(fields.get("source_timestamp", 0), -1) if subscription is not None else -1
        if subscription is not None and number >= 0:
            self._taken[thread] = subscription, number
        else:
            self._inform("messages of publishers outside the trace are taken; their latencies are not known")

    def _inform(self, message: str) -> None:
        self._problems.add("TRC025", Severity.INFO, message, TracePlace())

    def _node(self, event: CtfEvent) -> str:
        return self._nodes.get(_address(event, "node_handle"), "")

    def _name(self, callback: _Address, name: str) -> None:
        """A callback has been created; the one that was at its address before is gone."""
        self._callbacks[callback] = name
        self._registered[callback] = self._registered.get(callback, 0) + 1
        self._of_callback.pop(callback, None)

    def _runnable(self, callback: _Address) -> int:
        key = "callback", callback, self._registered.get(callback, 0)
        name = self._names.name(key, self._callbacks.get(callback, ""), f"{callback[1]:#x}", "callback")
        return self._entity(EntityKind.RUNNABLE, name)

    def _thread(self, event: CtfEvent) -> int:
        return self._thread_of(_thread_number(event), str(event.context.get("procname", "")))

    handlers: ClassVar[dict[str, Handler]] = {
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
        "ros2:callback_start": _callback_start,
        "ros2:callback_end": _callback_end,
        "ros2:rmw_publish": _publish,
        "ros2:rmw_take": _take,
    }
    characteristic = frozenset({"ros2:callback_start"})


def _address(event: CtfEvent, name: str) -> _Address:
    address = event.fields.get(name, 0)
    return event.context.get("vpid", 0), address if isinstance(address, int) else 0


def _thread_number(event: CtfEvent) -> int:
    number = event.context.get("vtid", 0)
    return number if isinstance(number, int) else 0


def _period(nanoseconds: object) -> str:
    if not isinstance(nanoseconds, int) or nanoseconds <= 0:
        return ""
    size, unit = next((size, unit) for size, unit in _PERIOD_UNITS if nanoseconds % size == 0)
    return f"{nanoseconds // size} {unit}"
