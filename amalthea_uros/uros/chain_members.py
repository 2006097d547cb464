"""What the path of a chain can contain: processes, callbacks and runnables, with their accesses and messages, and topics.

A chain that begins with a topic begins when the message is queued for the wire, as its transmission is activated; one that ends with a
topic ends when its transmission has ended. What the agent adds at both ends is no event of the model: the analysis adds it. A topic in
the middle is sent by a callback before it, and received by one after it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.activities import AccessKind, Call, LabelAccess, walk
from amalthea_uros.perf.events import CustomEvent, Event, ProcessChange, ProcessEvent
from amalthea_uros.perf.network import OFF_WIRE_EVENT, Direction, Network, Purpose, plain_topic, request_topic, response_topic
from amalthea_uros.perf.qualified import qualified, qualified_name
from amalthea_uros.perf.software import Runnable
from amalthea_uros.units import Time
from amalthea_uros.uros.application.callbacks import Callback, body_name
from amalthea_uros.uros.application.messages import Message
from amalthea_uros.uros.assembly.context import AssemblyContext
from amalthea_uros.uros.assembly.executor_runnables import notification_name
from amalthea_uros.uros.assembly.planned import PlannedIsr, PlannedTask


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainElement:
    """A process or runnable that a path can contain.

    Attributes
    ----------
    process : the process itself, or the one that calls the runnable
    runnable : None for a process
    reads, writes : labels
    sends, receives : channels of messages
    taken_by : the element that takes its messages; None if it receives none
    interval : nominal time between two executions of a callback, at least; None if it is unknown, as where it sends in all activations
        of its task, or if this is no callback
    """

    process: str | None
    runnable: str | None = None
    reads: frozenset[str] = frozenset()
    writes: frozenset[str] = frozenset()
    sends: frozenset[str] = frozenset()
    receives: frozenset[str] = frozenset()
    taken_by: str | None = None
    interval: Time | None = None


def chain_elements(context: AssemblyContext, callbacks: Sequence[Callback]) -> Mapping[str, ChainElement]:
    """All elements by name; where a process and a runnable share a name, it is the process."""
    found: dict[str, ChainElement] = {}
    callers: dict[str, str] = {}
    processes: tuple[PlannedTask | PlannedIsr, ...] = (*context.tasks, *context.isrs)
    for process in processes:
        called = [context.runnables[call.runnable] for call in walk(process.activities) if isinstance(call, Call)]
        found[process.name] = _element(process.name, None, called)
        for runnable in called:
            callers.setdefault(runnable.name, process.name)
    for name, caller in callers.items():
        found.setdefault(name, _element(caller, name, [context.runnables[name]]))
    for callback in callbacks:
        # In the executor, a callback is one of its runnables; otherwise it is a task of the same name.
        body = body_name(callback.name)
        element = _with_messages(
            found.get(body if callback.in_executor else callback.name) or _without_task(callback), callback
        )
        found[callback.name] = element
        if callback.in_executor and body in found:
            found[body] = element
    if callbacks:
        for executor in context.description.middleware.stated_executors:
            found.setdefault(executor.name, _without_accesses(executor.name))
    return found


def _without_task(callback: Callback) -> ChainElement:
    """A callback whose task period could not be chosen: that error is already reported, and must not cause others."""
    section = callback.section
    reads = {*section.reads, *([callback.buffer] if callback.buffer else [])}
    return replace(_without_accesses(callback.name), reads=frozenset(reads), writes=frozenset(section.writes))


def _without_accesses(process: str) -> ChainElement:
    return _element(process, None, ())


def _element(process: str, runnable: str | None, parts: Iterable[Runnable]) -> ChainElement:
    activities = [activity for part in parts for activity in walk(part.activities)]
    accesses = [activity for activity in activities if isinstance(activity, LabelAccess)]
    return ChainElement(
        process=process,
        runnable=runnable,
        reads=frozenset(access.label for access in accesses if access.kind is AccessKind.READ),
        writes=frozenset(access.label for access in accesses if access.kind is AccessKind.WRITE),
    )


def _with_messages(element: ChainElement, callback: Callback) -> ChainElement:
    """The element with the messages that its callback sends and receives."""
    return replace(
        element,
        sends=frozenset(message.channel for message in callback.outgoing),
        receives=frozenset([callback.incoming.channel] if callback.incoming else []),
        taken_by=notification_name(callback) if callback.incoming else None,
        interval=callback.interval if callback.in_executor or callback.runs_when_due or not callback.outgoing else None,
    )


def topic_error(message: str, location: Location | None, advice: str) -> ReadError:
    """The error of a path in which it is not clear which message of a topic is meant."""
    return ReadError([Finding("CHN011", Severity.ERROR, message, location, advice)])


class MessageOfTopic(NamedTuple):
    """A message on the wire.

    Attributes
    ----------
    event : nothing of the model raises it if no wire is described
    callback : that receives or sends it
    processes : that it passes before the executor sees it
    """

    event: Event
    callback: str
    processes: tuple[str, ...] = ()

    @property
    def is_on_wire(self) -> bool:
        """Whether a wire is described."""
        return isinstance(self.event, ProcessEvent)


@dataclass(frozen=True, slots=True)
class Topics:
    """The topics and services of an application.

    Attributes
    ----------
    receivers, senders : the callbacks by topic, without a slash before it; a service has its own name, too, besides its topics
    network : with the transmissions of their messages
    """

    receivers: Mapping[str, Sequence[str]]
    senders: Mapping[str, Sequence[str]]
    network: Network

    @classmethod
    def of(cls, callbacks: Iterable[Callback], network: Network) -> Topics:
        """The topics that callbacks receive and send."""
        receivers: dict[str, list[str]] = {}
        senders: dict[str, list[str]] = {}
        for callback in callbacks:
            if callback.incoming is not None:
                for name in _names(callback.incoming):
                    receivers.setdefault(name, []).append(callback.name)
            for message in callback.outgoing:
                for name in _names(message):
                    senders.setdefault(name, []).append(callback.name)
        return cls(receivers, senders, network)

    @property
    def names(self) -> set[str]:
        """All topics."""
        return {*self.receivers, *self.senders}

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and plain_topic(name) in self.names

    def sent(self, topic: str, before: str, location: Location | None) -> MessageOfTopic:
        """The message of a topic that a path goes along after a member.

        Raises
        ------
        ReadError : no callback sends it, or several, and the member is none of them.
        """
        return self._message(topic, self._one(topic, self.senders, before, location), Direction.TO_AGENT)

    def received(self, topic: str, after: Sequence[str], location: Location | None) -> MessageOfTopic:
        """The message of a topic that a path goes along before the rest of its members.

        Raises
        ------
        ReadError : no callback receives it, or several, and the path does not go on with one of them.
        """
        named = next((name for name in after if name in self.receivers.get(plain_topic(topic), ())), "")
        return self._message(topic, self._one(topic, self.receivers, named, location), Direction.TO_CONTROLLER)

    def _one(self, topic: str, callbacks: Mapping[str, Sequence[str]], named: str, location: Location | None) -> str:
        """The callback that is meant: the one of a name, or the only one."""
        candidates = callbacks.get(plain_topic(topic), ())
        verb, end = ("publishes", "begin") if callbacks is self.senders else ("receives", "end")
        if not candidates:
            raise topic_error(f"no callback {verb} {topic!r}", location, f"Let the path {end} with {topic!r}, or remove it.")
        if named not in candidates and len(candidates) > 1:
            names = ", ".join(map(repr, candidates))
            message = f"more than one callback {verb} {topic!r}: {names}"
            raise topic_error(message, location, "Add the one that is meant next to the topic.")
        return named if named in candidates else candidates[0]

    def _message(self, topic: str, callback: str, direction: Direction) -> MessageOfTopic:
        is_received = direction is Direction.TO_CONTROLLER
        names = {plain_topic(topic), request_topic(topic), response_topic(topic)}
        name = f"{plain_topic(topic)}_{'received' if is_received else 'sent'}_by_{callback}"
        for each in self.network.transmissions:
            is_of_callback = (each.direction, each.callback, each.purpose) == (direction, callback, Purpose.DATA)
            if is_of_callback and plain_topic(each.topic) in names:
                change = ProcessChange.ACTIVATE if is_received else ProcessChange.TERMINATE
                return MessageOfTopic(ProcessEvent(name=name, process=each.name, change=change), callback, each.processes)
        return MessageOfTopic(CustomEvent(name=name, kind=OFF_WIRE_EVENT), callback)


def _names(message: Message) -> Iterable[str]:
    """The names that a path can use for a message: its topic, and the service."""
    return dict.fromkeys((plain_topic(message.topic), plain_topic(message.sent_as)))


class ChainMembers(NamedTuple):
    """The members that the path of a chain can have, besides callbacks of the host.

    Attributes
    ----------
    elements : by the name that a path uses
    """

    elements: Mapping[str, ChainElement]
    topics: Topics

    def of_part(self, part: str) -> ChainMembers:
        """The members as those of a part of a larger system."""
        elements = {qualified_name(part, name): qualified(element, part) for name, element in self.elements.items()}
        topics = self.topics
        return ChainMembers(elements, Topics(_of_part(topics.receivers, part), _of_part(topics.senders, part), topics.network))


def members_together(parts: Iterable[ChainMembers], network: Network) -> ChainMembers:
    """The members of several parts of a system.

    Parameters
    ----------
    network : of the whole system
    """
    elements: dict[str, ChainElement] = {}
    receivers: dict[str, list[str]] = {}
    senders: dict[str, list[str]] = {}
    for part in parts:
        elements |= part.elements
        for every, own in ((receivers, part.topics.receivers), (senders, part.topics.senders)):
            for topic, callbacks in own.items():
                every.setdefault(topic, []).extend(callbacks)
    return ChainMembers(elements, Topics(receivers, senders, network))


def _of_part(callbacks: Mapping[str, Sequence[str]], part: str) -> dict[str, list[str]]:
    return {topic: [qualified_name(part, name) for name in names] for topic, names in callbacks.items()}
