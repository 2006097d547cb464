"""The messages that callbacks receive and send."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from enum import StrEnum

from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.network import ActionPart, Direction, request_topic, response_topic
from amalthea_uros.spec.application import (
    ActionClient,
    ActionServer,
    CallbackSection,
    Client,
    NodeSection,
    Publisher,
    ServiceSection,
    Subscription,
)
from amalthea_uros.units import DataSize, Time
from amalthea_uros.uros.application.notes import Notes

#: Bytes of a message, above which it is refused whatever the middleware: its parts and frames could take all memory.
LONGEST = 2**20


class MessageKind(StrEnum):
    """What a message of the middleware carries."""

    PUBLICATION = "publication"
    DELIVERY = "delivery"
    REQUEST_OUT = "request to a service elsewhere"
    REQUEST_IN = "request to a service here"
    RESPONSE_OUT = "response of a service here"
    RESPONSE_IN = "response of a service elsewhere"
    PING = "ping of the agent"
    SYNC = "time synchronisation with the agent"


#: What the controller sends.
SENT = frozenset(
    {MessageKind.PUBLICATION, MessageKind.REQUEST_OUT, MessageKind.RESPONSE_OUT, MessageKind.PING, MessageKind.SYNC}
)
#: Questions, which the agent answers itself.
ASKING = frozenset({MessageKind.PING, MessageKind.SYNC})
#: What the names of the channels of messages end with.
_CHANNELS = {
    MessageKind.PUBLICATION: "topic",
    MessageKind.DELIVERY: "topic",
    MessageKind.REQUEST_OUT: "request",
    MessageKind.REQUEST_IN: "request",
    MessageKind.RESPONSE_OUT: "response",
    MessageKind.RESPONSE_IN: "response",
    MessageKind.PING: "request",
    MessageKind.SYNC: "request",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Message:
    """A message that the controller sends or receives.

    Attributes
    ----------
    callback : the callback that receives or sends it
    topic : or the service, for requests and responses
    size : without headers
    interval : minimum time between two messages; 0 if nothing keeps them apart, of what a loop without a sleep sends
    attempts : how often it is sent at most until it is answered
    timeout : after all of which nobody waits for the answer; None for the timeout of the middleware
    """

    callback: str
    topic: str
    kind: MessageKind
    size: DataSize
    interval: Time
    reliable: bool
    origin: Location | None
    attempts: int = 1
    timeout: Time | None = None

    @property
    def sent_as(self) -> str:
        """The topic as which the agent publishes or takes it: a service has one for requests and one for responses."""
        if self.kind in (MessageKind.REQUEST_OUT, MessageKind.REQUEST_IN):
            return request_topic(self.topic)
        if self.kind in (MessageKind.RESPONSE_OUT, MessageKind.RESPONSE_IN):
            return response_topic(self.topic)
        return self.topic

    @property
    def direction(self) -> Direction:
        """Whether it arrives or leaves."""
        return Direction.TO_AGENT if self.kind in SENT else Direction.TO_CONTROLLER

    @property
    def is_incoming(self) -> bool:
        """Whether it arrives."""
        return self.kind not in SENT

    @property
    def channel(self) -> str:
        """The name of its channel in the model, if the same application sends and receives it."""
        return f"{self.topic}_{_CHANNELS[self.kind]}"

    @property
    def transmission(self) -> str:
        """The name of the task that stands for it on the wire, such as `factor_topic_to_Message_Factor`."""
        return f"{self.channel}_{'to' if self.is_incoming else 'from'}_{self.callback}"

    @property
    def stated_bytes(self) -> int:
        """Its length in bytes, without headers, however long it is."""
        return -(-self.size // 8)

    @property
    def content_bytes(self) -> int:
        """Its length in bytes, without headers; of one that is too long for everything, the longest that is not."""
        return min(self.stated_bytes, LONGEST)


def incoming_message(section: CallbackSection, interval: Time) -> Message | None:
    """The message that makes a callback ready; None for timers and guard conditions, and if its size is not described."""
    reliable = True
    match section:
        case Subscription(topic=topic, message_size=size):
            kind, reliable = MessageKind.DELIVERY, section.reliability == "reliable"
            interval -= section.jitter or 0
        case ServiceSection(name=topic, request_size=size):
            kind = MessageKind.REQUEST_IN
        case Client(service=topic, response_size=size):
            kind = MessageKind.RESPONSE_IN
        case ActionServer(name=action, goal_size=size):
            kind, topic = MessageKind.REQUEST_IN, ActionPart.GOALS.of(action)
        case ActionClient(action=action, result_size=size):
            kind, topic = MessageKind.RESPONSE_IN, ActionPart.RESULTS.of(action)
        case _:
            return None
    return Message(
        callback=section.name,
        topic=topic,
        kind=kind,
        size=size,
        interval=interval,
        reliable=reliable,
        origin=section.location(),
    )


def _publisher(topic: str, node: NodeSection, nodes: Sequence[NodeSection]) -> Publisher | None:
    """The publisher of a topic: that of the node, else the only one of the other nodes."""
    own = next((publisher for publisher in node.publishers if publisher.topic == topic), None)
    others = [publisher for each in nodes for publisher in each.publishers if publisher.topic == topic]
    return own or (others[0] if len(others) == 1 else None)


def publication(
    sender: str,
    topic: str,
    node: NodeSection,
    nodes: Sequence[NodeSection],
    interval: Time,
    origin: Location | None,
    findings: Notes,
) -> Message | None:
    """A message to a topic; None, with a finding, if nothing publishes there.

    Parameters
    ----------
    sender : the callback
    node : of the publisher; `nodes` has all others
    origin : where the topic is named
    """
    publisher = _publisher(topic, node, nodes)
    if publisher is None:
        topics = [publisher.topic for each in nodes for publisher in each.publishers]
        findings.undefined("publisher", topic, topics, origin, owner=f"node {node.name!r}")
        return None
    return Message(
        callback=sender,
        topic=topic,
        kind=MessageKind.PUBLICATION,
        size=publisher.message_size,
        interval=interval,
        reliable=publisher.reliability == "reliable",
        origin=publisher.location(),
    )


def outgoing_messages(
    section: CallbackSection, node: NodeSection, nodes: Sequence[NodeSection], interval: Time, notes: Notes
) -> Iterator[Message]:
    """What a callback sends: messages to topics, requests to services and goals to actions, and the responses of its own ones.

    An action server sends a feedback message and the result for each goal.

    Parameters
    ----------
    nodes : of the application; a callback can publish with a publisher of another node than its own
    """

    def message(kind: MessageKind, topic: str, size: DataSize, origin: Location | None) -> Message:
        return Message(
            callback=section.name, topic=topic, kind=kind, size=size, interval=interval, reliable=True, origin=origin
        )

    owner = f"node {node.name!r}"
    for index, topic in enumerate(section.publishes):
        sent = publication(section.name, topic, node, nodes, interval, section.location("publishes", index), notes)
        if sent is not None:
            yield sent
    every: Sequence[Client | ActionClient] = [*node.clients, *node.action_clients]
    clients = {client.name: client for client in every}
    for index, name in enumerate(section.requests):
        match clients.get(name):
            case None:
                notes.undefined("client", name, clients, section.location("requests", index), owner=owner)
            case Client(service=topic, request_size=size) as client:
                yield message(MessageKind.REQUEST_OUT, topic, size, client.location())
            case ActionClient(action=action, goal_size=size) as client:
                yield message(MessageKind.REQUEST_OUT, ActionPart.GOALS.of(action), size, client.location())
    match section:
        case ServiceSection():
            yield message(MessageKind.RESPONSE_OUT, section.name, section.response_size, section.location())
        case ActionServer():
            feedback, results = ActionPart.FEEDBACK.of(section.name), ActionPart.RESULTS.of(section.name)
            yield message(MessageKind.PUBLICATION, feedback, section.feedback_size, section.location())
            yield message(MessageKind.RESPONSE_OUT, results, section.result_size, section.location())
