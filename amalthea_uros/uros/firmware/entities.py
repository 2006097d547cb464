"""The entities that the code creates, with their types and the memory of their messages."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from amalthea_uros._internal.message_types import LengthBounds, MessageType, length_of
from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.executors import Executor, HandleKind
from amalthea_uros.perf.named import Brief
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
from amalthea_uros.spec.message_types import TypedMessage
from amalthea_uros.uros.application.callbacks import OF_MIDDLEWARE, sections_of

#: The package of the types that stand for those that a description does not state.
STAND_INS = "amuros_types"
_MEMORY = ("string", "sequence")
#: What the goal, the result and the feedback of an action have besides their fields, in bytes: its identifier or its state.
_AROUND_ACTIONS = (16, 1, 16)


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeMessage(Brief):
    """A variable for a message.

    Attributes
    ----------
    is_open : whether its strings and sequences need memory
    string, sequence : capacities
    """

    variable: str
    type: MessageType
    is_open: bool
    string: int = 0
    sequence: int = 0

    @property
    def c_type(self) -> str:
        """The structure of the message."""
        return f"{self.type.package}__{self.type.kind}__{self.type.name}"

    @property
    def support(self) -> str:
        """The macro that leads to its type support."""
        return f"ROSIDL_GET_MSG_TYPE_SUPPORT({self.type.package}, {self.type.kind}, {self.type.name})"


@dataclass(frozen=True, slots=True, kw_only=True)
class CodePublisher(Brief):
    """A publisher, and the message that it sends."""

    section: Publisher
    node: str
    variable: str
    message: CodeMessage


@dataclass(frozen=True, slots=True, kw_only=True)
class CodeHandler(Brief):
    """An entity that an executor waits for, and the reaction of the application.

    Attributes
    ----------
    kind : `timer`, `subscription`, `service`, `client`, `guard_condition`, `action_server`, `action_client` or `parameter_server`
    callback : the function that the executor calls
    hook : the function of the application that it calls
    messages : what it gets, and what it fills in before it returns
    publishes, requests : what is sent then
    """

    kind: str
    name: str
    node: str
    variable: str
    hook: str
    callback: str = ""
    section: CallbackSection | None = None
    messages: tuple[CodeMessage, ...] = ()
    publishes: tuple[CodePublisher, ...] = ()
    requests: tuple[CodeHandler, ...] = ()

    @property
    def whole_type(self) -> MessageType:
        """The type of a service or action."""
        part = self.messages[0].type
        return MessageType(part.package, part.kind, re.sub(r"(_SendGoal)?_Request$|_GetResult_Response$", "", part.name))


class Identifiers:
    """Names of C, each once."""

    def __init__(self) -> None:
        self._used: set[str] = set()

    def of(self, *parts: str) -> str:
        """A name from some texts."""
        base = re.sub(r"\W+", "_", "_".join(parts), flags=re.ASCII).strip("_") or "unnamed"
        name, number = base, 1
        while name in self._used:
            number += 1
            name = f"{base}_{number}"
        self._used.add(name)
        return name


class CodeEntities:
    """The entities of an application.

    Attributes
    ----------
    nodes : variables by name
    stand_ins : definitions of types that stand for those that are not stated, by the names of their files
    """

    def __init__(self, nodes: Sequence[NodeSection], executors: Iterable[Executor]) -> None:
        self.names = Identifiers()
        self.stand_ins: dict[str, str] = {}
        self._sizes: dict[tuple[str, str], list[int]] = {}
        self.nodes = {node.name: self.names.of("node", node.name) for node in nodes}
        self.publishers = [self._publisher(node, each) for node in nodes for each in node.publishers]
        self._clients: dict[tuple[str, str], CodeHandler] = {}
        sections = {
            each.name: (node, kind, each) for node in nodes for kind, each in sections_of(node) if kind not in OF_MIDDLEWARE
        }
        for name, (node, kind, section) in sections.items():
            if isinstance(section, Client):
                self._clients[node.name, name] = self._handler(node, kind, section)
        self.handlers: dict[str, list[CodeHandler]] = {}
        for executor in executors:
            created = self.handlers.setdefault(executor.name, [])
            for handle in executor.handles:
                if handle.name in sections:
                    node, kind, section = sections[handle.name]
                    own = self._clients.get((node.name, handle.name)) or self._handler(node, kind, section)
                    created.append(own)
                elif not any(each.kind == "parameter_server" for each in created):
                    created.append(self._server(nodes, handle.name))

    @property
    def messages(self) -> list[CodeMessage]:
        """The variables for messages."""
        every = [each.message for each in self.publishers]
        return every + [message for each in self.every_handler for message in each.messages]

    @property
    def every_handler(self) -> list[CodeHandler]:
        """The entities that executors wait for."""
        return [each for group in self.handlers.values() for each in group]

    def _publisher(self, node: NodeSection, section: Publisher) -> CodePublisher:
        variable = self.names.of("publisher", section.topic)
        message = self._messages(section, section.topic, "msg")[0]
        return CodePublisher(section=section, node=self.nodes[node.name], variable=variable, message=message)

    def _messages(self, section: TypedMessage, name: str, kind: str) -> tuple[CodeMessage, ...]:
        """The messages of a type, or of one that stands for it; services and clients of actions have two."""
        stated, bounds = section.type, section.bounds
        own = MessageType(*stated.split("/")) if stated is not None else self._stand_in(section, name, kind)
        created = []
        # What is received has a variable; the rest is sent by functions of its own.
        for part in _RECEIVED.get(type(section), type(section).sizes.values()):
            whole = own.part(part) if part else own
            length = length_of(own.part(_CONTENT[part]) if kind == "action" else whole) if stated is not None else None
            given = {each: getattr(bounds, each) or 0 for each in _MEMORY} if bounds is not None else dict.fromkeys(_MEMORY, 0)
            created.append(
                CodeMessage(
                    variable=self.names.of("message", name, part),
                    type=whole,
                    is_open=bounds is not None and (length is None or not length.is_fixed),
                    # With the byte at its end.
                    string=given["string"] + 1 if given["string"] else 0,
                    sequence=given["sequence"],
                )
            )
        return tuple(created)

    def _stand_in(self, section: TypedMessage, name: str, kind: str) -> MessageType:
        words = re.findall(r"[A-Za-z0-9]+", name)
        title = "".join(word[:1].upper() + word[1:] for word in words)
        title = title if title[:1].isalpha() else f"T{title}"
        # Of both ends of a topic, the longer message.
        sizes = [-(-getattr(section, key) // 8) for key in type(section).sizes]
        if kind == "action":
            sizes = [max(0, size - around) for size, around in zip(sizes, _AROUND_ACTIONS, strict=True)]
        known = self._sizes.setdefault((kind, title), sizes)
        sizes[:] = map(max, known, sizes)
        self._sizes[kind, title] = sizes
        fields = [f"uint8[{size}] data" for size in sizes]
        self.stand_ins[f"{STAND_INS}/{kind}/{title}.{kind}"] = "\n---\n".join(fields) + "\n"
        return MessageType(STAND_INS, kind, title)

    def _handler(self, node: NodeSection, role: HandleKind, section: CallbackSection) -> CodeHandler:
        kind = role.replace(" ", "_")
        messages: tuple[CodeMessage, ...] = ()
        match section:
            case Subscription():
                messages = self._messages(section, section.topic, "msg")
            case ServiceSection():
                messages = self._messages(section, section.name, "srv")
            case Client():
                messages = self._messages(section, section.service, "srv")
            case ActionServer():
                messages = self._messages(section, section.name, "action")
            case ActionClient():
                messages = self._messages(section, section.action, "action")
        return CodeHandler(
            kind=kind,
            name=section.name,
            node=self.nodes[node.name],
            variable=self.names.of(kind, section.name),
            callback=self.names.of(section.name),
            hook=self.names.of("application", section.name),
            section=section,
            messages=messages,
            publishes=tuple(each for topic in section.publishes for each in [self._of_topic(topic, node)] if each is not None),
            requests=tuple(self._clients[node.name, each] for each in section.requests if (node.name, each) in self._clients),
        )

    def _of_topic(self, topic: str, node: NodeSection) -> CodePublisher | None:
        created = [each for each in self.publishers if each.section.topic == topic]
        return next((each for each in created if each.node == self.nodes[node.name]), created[0] if created else None)

    def _server(self, nodes: Sequence[NodeSection], handle: str) -> CodeHandler:
        node = next(each for each in nodes if each.parameter_server is not None)
        variable = self.names.of("parameter_server", node.name)
        return CodeHandler(
            kind="parameter_server",
            name=handle,
            node=self.nodes[node.name],
            variable=variable,
            hook=self.names.of("on_parameter"),
        )


#: The messages of an action that are received -> what of it is in them.
_CONTENT = {"SendGoal_Request": "Goal", "GetResult_Response": "Result", "FeedbackMessage": "Feedback"}
_RECEIVED: dict[type[TypedMessage], tuple[str, ...]] = {
    ActionServer: ("SendGoal_Request",),
    ActionClient: ("GetResult_Response", "FeedbackMessage"),
}


def open_types(nodes: Sequence[NodeSection]) -> Iterator[tuple[TypedMessage, str]]:
    """Messages whose strings and sequences have no bound in the description, so that nothing can give them memory."""
    for node in nodes:
        typed: tuple[Sequence[TypedMessage], ...] = (
            *(node.subscriptions, node.publishers, node.services, node.clients),
            node.action_servers,
            node.action_clients,
        )
        for section in (each for group in typed for each in group):
            stated, bounds = section.type, section.bounds
            if stated is None:
                continue
            whole = MessageType(*stated.split("/"))
            given = LengthBounds(bounds.string, bounds.sequence) if bounds is not None else LengthBounds()
            parts = [whole.part(part) if part else whole for part in type(section).sizes.values()]
            lengths = [length_of(each, bounds=given) for each in parts]
            if any(length is not None and length.most is None for length in lengths):
                yield section, stated
