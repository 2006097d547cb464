"""The messages of an application with their parts: what the middleware makes of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

from amalthea_uros.perf.network import Direction
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import Time
from amalthea_uros.uros.callbacks import Callback, CallbackKind, Message
from amalthea_uros.uros.middleware.profile import MessageKind, Part

_BITS_PER_BYTE = 8


class Messaging(Protocol):
    """What is asked of a middleware here; its profile answers."""

    def parts(self, kind: MessageKind, content: int, *, reliable: bool, middleware: Middleware) -> Sequence[Part]:
        """What is sent for a message."""
        ...

    def heartbeat(self, middleware: Middleware) -> tuple[int, Time] | None:
        """Length and least interval of messages that ask for acknowledgements."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class WireMessage:
    """A message with what is sent for it.

    Attributes
    ----------
    interval : minimum time between two of them, before `jitter`
    """

    name: str
    message: Message
    callback: Callback
    direction: Direction
    parts: tuple[Part, ...]
    interval: Time
    jitter: Time

    @property
    def length(self) -> int:
        """In bytes, with the headers of the middleware."""
        return sum(part.length for part in self.parts)


def wire_messages(callbacks: Iterable[Callback], middleware: Middleware, profile: Messaging) -> Iterator[WireMessage]:
    """All messages that callbacks receive and send."""
    for callback in callbacks:
        if callback.incoming is not None:
            yield _message(callback.incoming, callback, Direction.TO_CONTROLLER, middleware, profile)
        for message in callback.outgoing:
            yield _message(message, callback, Direction.TO_AGENT, middleware, profile)


def transmission_name(message: Message, direction: Direction) -> str:
    """The name of the task of a message, such as `factor_topic_to_Message_Factor`."""
    return f"{message.channel}_{'to' if direction is Direction.TO_CONTROLLER else 'from'}_{message.callback}"


def acknowledgement_name(transmission: str) -> str:
    """The name of the task of the acknowledgements of a message."""
    return f"{transmission}_acknowledgement"


def _message(
    message: Message, callback: Callback, direction: Direction, middleware: Middleware, profile: Messaging
) -> WireMessage:
    content = -(-message.size // _BITS_PER_BYTE)
    kind = _kind(message, callback, direction)
    is_incoming = direction is Direction.TO_CONTROLLER
    jitter = callback.jitter if is_incoming else 0
    return WireMessage(
        name=transmission_name(message, direction),
        message=message,
        callback=callback,
        direction=direction,
        parts=tuple(profile.parts(kind, content, reliable=message.reliable, middleware=middleware)),
        interval=message.interval + jitter,
        jitter=jitter,
    )


def _kind(message: Message, callback: Callback, direction: Direction) -> MessageKind:
    if direction is Direction.TO_CONTROLLER:
        incoming = {CallbackKind.SERVICE: MessageKind.REQUEST_IN, CallbackKind.CLIENT: MessageKind.RESPONSE_IN}
        return incoming.get(callback.kind, MessageKind.DELIVERY)
    if message.channel.endswith("_request"):
        return MessageKind.REQUEST_OUT
    return MessageKind.RESPONSE_OUT if message.channel.endswith("_response") else MessageKind.PUBLICATION
