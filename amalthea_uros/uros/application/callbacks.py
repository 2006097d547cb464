"""The callbacks of an application in one form for all kinds: their interval, the message that makes them ready, what they send.

What the middleware adds to an executor by itself has a callback, too: the services of parameters and of the lifecycle. The sizes of
their messages are not described.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from amalthea_uros._internal.ports import parameter_services
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.perf.software import Channel
from amalthea_uros.spec.application import (
    Application,
    CallbackSection,
    Lifecycle,
    MessageCallback,
    NodeSection,
    ParameterServer,
    Subscription,
    Timer,
)
from amalthea_uros.spec.executors import ExecutorSection
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import SECOND, Frequency, Time
from amalthea_uros.uros.application.messages import Message, incoming_message, outgoing_messages
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.application.serving import Serving


@dataclass(frozen=True, slots=True, kw_only=True)
class Callback:
    """A callback.

    Attributes
    ----------
    interval : nominal time between two executions, at least; None if it is not known, which an executor without a loop does not allow
    executor : the name of the executor that has its handle
    in_executor : whether that executor runs it; otherwise it has a task of its own
    incoming : the message that makes it ready; None for timers and guard conditions, and if its size is not described
    outgoing : messages that each execution sends
    buffer : the label in which the executor leaves the message; None without one
    handles : the number of handles that it has in its executor
    """

    section: CallbackSection
    kind: HandleKind
    node: NodeSection
    interval: Time | None
    executor: str
    in_executor: bool
    incoming: Message | None
    outgoing: tuple[Message, ...]
    buffer: str | None
    handles: int = 1

    @property
    def name(self) -> str:
        """The name of the callback, and of its task."""
        return self.section.name

    @property
    def jitter(self) -> Time:
        """Maximum delay of its message against the nominal time; 0 without one."""
        return (self.section.jitter or 0) if isinstance(self.section, Subscription) else 0

    @property
    def nominal_interval(self) -> Time:
        """The interval of a callback that has one."""
        assert self.interval is not None
        return self.interval

    @property
    def min_interval(self) -> Time:
        """Minimum time between two messages, or two expirations of its timer, of a callback that has an interval."""
        return self.nominal_interval - self.jitter

    @property
    def runs_when_due(self) -> bool:
        """Whether it runs only in the activations of its own task in which it is due, instead of all."""
        return (self.section.runs_when or ("due" if self.kind is HandleKind.TIMER else "activated")) == "due"

    @property
    def origin(self) -> Location | None:
        """Where the callback is described."""
        return self.section.location()


def callbacks_of(application: Application, middleware: Middleware, notes: Notes) -> tuple[Callback, ...]:
    """All valid callbacks in the order of the file; the others get a finding."""
    serving = Serving.of(middleware, notes)
    found = [
        callback
        for node in application.nodes
        for kind, section in sections_of(node)
        if (callback := _callback(kind, section, node, application.nodes, serving, middleware.ros, notes)) is not None
    ]
    return tuple(found)


def sections_of(node: NodeSection) -> Iterator[tuple[HandleKind, CallbackSection]]:
    """The sections of all callbacks of a node."""
    for kind, sections in (
        (HandleKind.SUBSCRIPTION, node.subscriptions),
        (HandleKind.TIMER, node.timers),
        (HandleKind.SERVICE, node.services),
        (HandleKind.CLIENT, node.clients),
        (HandleKind.GUARD_CONDITION, node.guard_conditions),
        (HandleKind.ACTION_SERVER, node.action_servers),
        (HandleKind.ACTION_CLIENT, node.action_clients),
    ):
        yield from ((kind, section) for section in sections)
    if node.parameter_server is not None:
        yield HandleKind.PARAMETER_SERVICE, _of_middleware(f"{node.name}_Parameters", node.parameter_server)
    if node.lifecycle is not None:
        yield HandleKind.LIFECYCLE_SERVICE, _of_middleware(f"{node.name}_Lifecycle", node.lifecycle)


def _of_middleware(name: str, section: ParameterServer | Lifecycle) -> CallbackSection:
    """The callback that answers requests to the middleware itself, with the locations of its section."""
    shared = {key: getattr(section, key) for key in section.model_fields_set & MessageCallback.model_fields.keys()}
    found = MessageCallback.model_construct(name=name, **shared)
    found._where = section._where
    return found


def _callback(
    kind: HandleKind,
    section: CallbackSection,
    node: NodeSection,
    nodes: Sequence[NodeSection],
    serving: Serving,
    distribution: str | None,
    notes: Notes,
) -> Callback | None:
    executor, in_executor = serving.place(section, node, is_of_middleware=kind in OF_MIDDLEWARE)
    needs_interval = not _may_be_unknown(section, kind) or executor.loop is None
    interval = _interval(section, needs_interval, notes)
    outgoing = tuple(outgoing_messages(section, node, nodes, interval or SECOND, notes))
    if interval is None and needs_interval:
        return None
    incoming = None if interval is None else incoming_message(section, interval)
    return Callback(
        section=section,
        kind=kind,
        node=node,
        interval=interval,
        executor=executor.name,
        in_executor=in_executor,
        incoming=incoming,
        outgoing=outgoing,
        buffer=(section.buffer or f"{section.name}_message") if incoming and isinstance(section, MessageCallback) else None,
        handles=handle_count(kind, node, distribution),
    )


#: What the executor serves without a callback of the application.
OF_MIDDLEWARE = (HandleKind.PARAMETER_SERVICE, HandleKind.LIFECYCLE_SERVICE)


def _may_be_unknown(section: CallbackSection, kind: HandleKind) -> bool:
    """Whether a callback can do without an interval: nothing else of known rate follows from it."""
    if kind is HandleKind.GUARD_CONDITION:
        return not section.publishes and not section.requests
    return kind in OF_MIDDLEWARE


def interval_of_rate(rate: Frequency) -> Time:
    """The time between two occurrences, rounded down so that it is a lower bound."""
    return int(SECOND / rate)


def _interval(section: CallbackSection, needed: bool, notes: Notes) -> Time | None:
    key = "period" if isinstance(section, Timer) else "interval"
    given: Time | None = getattr(section, key, None)
    rate: Frequency | None = getattr(section, "rate", None)
    if given is None and rate is None:
        if not needed:
            return None
        message = f"{section.name!r} has neither {key!r} nor 'rate'"
        notes.error("APP003", message, section.location(), f"Set '{key}: 20 ms' or 'rate: 50 Hz'.")
        return None
    by_rate = None if rate is None else interval_of_rate(rate)
    if given is not None and by_rate is not None and given != by_rate:
        message = f"{key!r} and 'rate' of {section.name!r} contradict each other"
        notes.error("APP003", message, section.location("rate"), "Remove one of them.")
    interval = given if given is not None else by_rate
    jitter = section.jitter if isinstance(section, Subscription) else None
    if interval and jitter is not None and jitter >= interval:
        message = f"the jitter of {section.name!r} is not shorter than its message interval"
        notes.error("APP003", message, section.location("jitter"), "Reduce the jitter, or increase the interval.")
        return None
    if not interval:
        message = f"'rate' of {section.name!r} is above the maximum of 1 THz"
        notes.error("APP003", message, section.location("rate"), "Set a lower rate.")
        return None
    return interval


def internal_channels(callbacks: Sequence[Callback]) -> Mapping[str, Channel]:
    """The channels of messages that the application sends and receives itself; they pass the agent on their way."""
    received = {callback.incoming.channel for callback in callbacks if callback.incoming is not None}
    sent = {message.channel: message for callback in callbacks for message in callback.outgoing}
    return {
        name: Channel(name=name, element_size=message.size, capacity=1, external=True, origin=message.origin)
        for name, message in sent.items()
        if name in received
    }


def registration_order(callbacks: Iterable[Callback], executor: ExecutorSection, notes: Notes) -> tuple[Callback, ...]:
    """Callbacks in the order in which they are added to the executor."""
    by_name = {callback.name: callback for callback in callbacks}
    for index, name in enumerate(executor.order):
        if name not in by_name:
            notes.undefined("callback", name, by_name, executor.location("order", index))
    names = [name for name in executor.order if name in by_name]
    return tuple(by_name[name] for name in dict.fromkeys([*names, *by_name]))


def body_name(callback: str) -> str:
    """The name of the runnable of a callback."""
    return f"{callback}_Callback"


def handle_count(kind: HandleKind, node: NodeSection, distribution: str | None) -> int:
    """The number of handles that a callback, or a service of the middleware, has in its executor."""
    if kind is HandleKind.PARAMETER_SERVICE:
        return parameter_services(distribution)
    if kind is HandleKind.LIFECYCLE_SERVICE:
        return 0 if node.lifecycle is None else node.lifecycle.services
    return 1
