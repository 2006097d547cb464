"""The messages of an application with their parts: what the middleware makes of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from amalthea_uros.perf.network import Direction
from amalthea_uros.units import Time
from amalthea_uros.uros.application.callbacks import Callback, Message, transmission_name_of
from amalthea_uros.uros.middleware.kinds import content_bytes, message_kind
from amalthea_uros.uros.middleware.profile import Part, Profile


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


def wire_messages(callbacks: Iterable[Callback], profile: Profile) -> Iterator[WireMessage]:
    """All messages that callbacks receive and send."""
    for callback in callbacks:
        if callback.incoming is not None:
            yield _message(callback.incoming, callback, Direction.TO_CONTROLLER, profile)
        for message in callback.outgoing:
            yield _message(message, callback, Direction.TO_AGENT, profile)


def opposite(direction: Direction) -> Direction:
    """The direction of acknowledgements."""
    return Direction.TO_AGENT if direction is Direction.TO_CONTROLLER else Direction.TO_CONTROLLER


def acknowledgement_name(transmission: str) -> str:
    """The name of the task of the acknowledgements of a message."""
    return f"{transmission}_acknowledgement"


def _message(message: Message, callback: Callback, direction: Direction, profile: Profile) -> WireMessage:
    is_incoming = direction is Direction.TO_CONTROLLER
    kind, content = message_kind(message, incoming=is_incoming), content_bytes(message)
    jitter = callback.jitter if is_incoming else 0
    return WireMessage(
        name=transmission_name_of(message, incoming=is_incoming),
        message=message,
        callback=callback,
        direction=direction,
        parts=tuple(profile.parts(kind, content, reliable=message.reliable)),
        interval=message.interval + jitter,
        jitter=jitter,
    )
