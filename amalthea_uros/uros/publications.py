"""What a callback sends, and how long it waits for the acknowledgement."""

from __future__ import annotations

from collections.abc import Callable

from amalthea_uros.perf.executors import Publication
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.callbacks import Callback, Message
from amalthea_uros.uros.middleware.kinds import content_bytes, message_kind
from amalthea_uros.uros.middleware.profile import Profile


def publications(
    callback: Callback,
    middleware: Middleware,
    profile: Profile,
    transmission_of: Callable[[Message], str | None],
    acknowledgement_of: Callable[[Message], str | None],
) -> tuple[Publication, ...]:
    """The messages that a callback sends, in their order: to topics, requests, then its response.

    Parameters
    ----------
    transmission_of, acknowledgement_of : names of what a message and its acknowledgement are on the wire; None without a wire
    """
    found = []
    for message in callback.outgoing:
        kind, content = message_kind(message, incoming=False), content_bytes(message)
        timeout = profile.gives_up_after(kind, content, reliable=message.reliable, middleware=middleware)
        parts = profile.parts(kind, content, reliable=message.reliable, middleware=middleware)
        is_acknowledged = any(part.acknowledgement is not None for part in parts)
        publication = Publication(
            topic=message.topic,
            transmission=transmission_of(message),
            reliable=message.reliable,
            acknowledgement=acknowledgement_of(message) if is_acknowledged else None,
            waits=timeout is not None,
            timeout=timeout,
        )
        found.append(publication)
    return tuple(found)
