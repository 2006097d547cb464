"""The events of ros2_tracing: callbacks as runnables of their threads, and messages from publication to callback as chains.

A chain is there for each subscription: step 0 is the publication, step 1 the begin of the callback that takes the message. The two
are matched by the topic and the source stamp of the message; occurrences are numbered by publication, so lost ones show.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import ClassVar

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.ctf.interpreters import Handler, Interpreter, LinuxThread
from amalthea_uros.trace.ctf.ros2_objects import RosCallback, RosObjects, RosSubscription, address_of
from amalthea_uros.trace.ctf.streams import CtfEvent
from amalthea_uros.trace.files import TracePlace, TraceProblems
from amalthea_uros.trace.reading import EventRows
from amalthea_uros.trace.schedulers.thread_log import UniqueNames
from amalthea_uros.trace.schedulers.thread_states import ThreadStates
from amalthea_uros.trace.table import EntityKind, EventKind

#: So many publications of a topic wait for their callbacks at most.
_MOST_PENDING = 1 << 16
#: Where a publication of a topic is recorded; each message passes some of them, once.
_LAYERS = ("ros2:rclcpp_intra_publish", "ros2:rcl_publish", "ros2:rmw_publish")


@dataclass(slots=True, eq=False)
class _RosCall:
    """A callback that executes.

    Attributes
    ----------
    runnable : the entity
    after : how long its thread had run at the end of the call before, or at its own begin; None if neither is known
    published : topic -> number of messages, for each layer that records them
    """

    callback: RosCallback
    runnable: int
    after: int | None
    published: dict[str, Counter[str]] = field(default_factory=dict)

    def end(self) -> None:
        """Note what was published; a layer that is not recorded, or through which messages do not pass, has none."""
        for topics in self.published.values():
            self.callback.published |= topics


class Ros2(Interpreter):
    """Takes the events of ROS 2; what was created before the recording has no name but its address.

    Attributes
    ----------
    objects : what was created and called
    outside : the topics of which messages were published outside callbacks
    unnamed : number of messages of publishers that are older than the trace
    threads : the threads of the kernel by their numbers
    """

    def __init__(self, rows: EventRows, states: ThreadStates, problems: TraceProblems, names: UniqueNames) -> None:
        super().__init__(rows, states, problems, names)
        self.objects = RosObjects()
        self.outside: set[str] = set()
        self.unnamed = 0
        self.threads: Mapping[int, LinuxThread] = {}
        self._chains: dict[str, int] = {}
        self._calls: dict[int, list[_RosCall]] = {}
        #: Of each thread the message that it has taken last, of which the callback has not begun.
        self._taken: dict[int, tuple[RosSubscription, int]] = {}
        #: How long each thread had run at the end of its last call.
        self._ends: dict[int, int | None] = {}

    def callbacks(self) -> tuple[RosCallback, ...]:
        """All callbacks, each with a name of its own; what still executes is counted, too."""
        self.lose()
        callbacks = tuple(self.objects.known())
        for callback in callbacks:
            self._name(callback)
        return callbacks

    def lose(self) -> None:
        """Forget which callbacks execute, and which messages they have taken."""
        for calls in self._calls.values():
            for call in calls:
                call.end()
        self._calls.clear()
        self._taken.clear()
        self._ends.clear()

    def thread_name(self, thread: int) -> str:
        """The name of a thread by its number."""
        return self._names.name(("thread", thread), "", str(thread), "thread")

    def _object(self, event: CtfEvent) -> None:
        self.objects.add(event)

    def _callback_start(self, event: CtfEvent) -> None:
        callback, thread, number = self.objects.callback(event), self._thread(event), _thread_number(event)
        taken = self._taken.pop(number, None)
        if event.fields.get("is_intra_process"):
            callback.is_within_process = True
            self._inform("messages within a process have no publication in the trace, so their latencies are not known")
        elif taken is not None and callback.subscription is taken[0]:
            subscription, count = taken
            self._rows.add(EventKind.CHAIN_STEP, thread, self._states.job(thread), subscription.chain, count, 1)
        runnable = self._runnable(callback)
        callback.threads[number] += 1
        after = self._ends.get(number)
        if after is None and number in self.threads:
            after = self.threads[number].ran_until(event.time)
        self._calls.setdefault(number, []).append(_RosCall(callback, runnable, after))
        self._states.start_runnable(thread, runnable)

    def _callback_end(self, event: CtfEvent) -> None:
        calls, address = self._calls.get(_thread_number(event), []), address_of(event, "callback")
        index = next((index for index in reversed(range(len(calls))) if calls[index].callback.address == address), None)
        if index is None:
            runnable = self._runnable(self.objects.callback(event))
        else:
            call = calls.pop(index)
            call.end()
            self._note_busy(call, event)
            runnable = call.runnable
        self._states.end_runnable(self._thread(event), runnable)

    def _note_busy(self, call: _RosCall, event: CtfEvent) -> None:
        """Note what a call took: how long the thread has run since the one before, with polling and taking the message."""
        number = _thread_number(event)
        thread = self.threads.get(number)
        ran = self._ends[number] = None if thread is None else thread.ran_until(event.time)
        if ran is not None and call.after is not None:
            call.callback.busy.append(ran - call.after)

    def _published(self, event: CtfEvent, topic: str | None) -> None:
        """Note which callback has published a message."""
        calls = self._calls.get(_thread_number(event))
        if topic is None:
            self.unnamed += 1
        elif calls:
            calls[-1].published.setdefault(event.name, Counter())[topic] += 1
        else:
            self.outside.add(topic)

    def _publish_above(self, event: CtfEvent) -> None:
        self._published(event, self.objects.topics.get(address_of(event, "publisher_handle")))

    def _publish(self, event: CtfEvent) -> None:
        topic = self.objects.topics_of_middleware.get(address_of(event, "rmw_publisher_handle"))
        stamp = event.fields.get("timestamp")
        if "rmw_publisher_handle" in event.fields:
            self._published(event, topic)
        if topic is None or not isinstance(stamp, int) or not stamp:
            self._inform(
                "publications without a source stamp, or by publishers that are older than the trace, are not followed"
            )
            return
        thread = self._thread(event)
        for subscription in self.objects.subscriptions.values():
            if subscription.topic == topic:
                self._follow(subscription, stamp, thread)

    def _follow(self, subscription: RosSubscription, stamp: int, thread: int) -> None:
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
        subscription = self.objects.by_middleware.get(address_of(event, "rmw_subscription_handle"))
        stamp = fields.get("source_timestamp", 0)
        number = subscription.published.get(stamp, -1) if subscription is not None else -1
        if subscription is not None and isinstance(stamp, int) and 0 < stamp < 1 << 63:
            subscription.stamps.append(stamp)
            subscription.foreign += subscription.count > 0 and stamp not in subscription.published
        if subscription is not None and number >= 0:
            self._taken[thread] = subscription, number
        else:
            self._inform("messages of publishers outside the trace are taken; their latencies are not known")

    def _inform(self, message: str) -> None:
        self._problems.add("TRC025", Severity.INFO, message, TracePlace())

    def _name(self, callback: RosCallback) -> str:
        if not callback.name:
            callback.name = self._names.name(("callback", callback), callback.label, f"{callback.address[1]:#x}", "callback")
        return callback.name

    def _runnable(self, callback: RosCallback) -> int:
        return self._entity(EntityKind.RUNNABLE, self._name(callback))

    def _thread(self, event: CtfEvent) -> int:
        return self._thread_of(_thread_number(event), str(event.context.get("procname", "")))

    handlers: ClassVar[dict[str, Handler]] = {
        **dict.fromkeys(RosObjects.handlers, _object),
        **dict.fromkeys(_LAYERS, _publish_above),
        "ros2:callback_start": _callback_start,
        "ros2:callback_end": _callback_end,
        "ros2:rmw_publish": _publish,
        "ros2:rmw_take": _take,
    }
    characteristic = frozenset({"ros2:callback_start"})


def _thread_number(event: CtfEvent) -> int:
    number = event.context.get("vtid", 0)
    return number if isinstance(number, int) else 0
