"""What a callback sends, and how long it waits for the acknowledgement."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from amalthea_uros.perf.executors import Publication
from amalthea_uros.perf.network import Wait
from amalthea_uros.perf.system import System
from amalthea_uros.uros.application.callbacks import Callback, CallbackKind, Message, body_name, transmission_name_of
from amalthea_uros.uros.middleware.kinds import content_bytes, message_kind
from amalthea_uros.uros.middleware.profile import MessageKind, Profile
from amalthea_uros.uros.transports.line import describes_wire
from amalthea_uros.uros.transports.messages import acknowledgement_name


def publications(callback: Callback, profile: Profile) -> tuple[Publication, ...]:
    """The messages that a callback sends, in their order: to topics, requests, then its response."""
    if callback.kind in (CallbackKind.PARAMETERS, CallbackKind.LIFECYCLE):
        return tuple(_of_middleware(callback, profile))
    return tuple(_publication(message, profile) for message in callback.outgoing)


def _publication(message: Message, profile: Profile) -> Publication:
    kind, content = message_kind(message, incoming=False), content_bytes(message)
    timeout = profile.times_out_after(kind, content, reliable=message.reliable)
    parts = profile.parts(kind, content, reliable=message.reliable)
    is_acknowledged = any(part.acknowledgement is not None for part in parts)
    transmission = transmission_name_of(message, incoming=False) if describes_wire(profile.middleware.transport) else None
    return Publication(
        topic=message.topic,
        transmission=transmission,
        reliable=message.reliable,
        acknowledgement=acknowledgement_name(transmission) if transmission and is_acknowledged else None,
        waits=timeout is not None,
        timeout=timeout,
    )


def _of_middleware(callback: Callback, profile: Profile) -> Iterator[Publication]:
    """Responses of parameters and of the lifecycle: of unknown sizes, but reliable, so that they keep the executor as others do."""
    timeout = profile.times_out_after(MessageKind.RESPONSE_OUT, 0, reliable=True)
    topics = [f"{callback.name} (response)"]
    server = callback.node.parameter_server if callback.kind is CallbackKind.PARAMETERS else None
    if server is not None and server.events:
        topics.append("parameter_events")
    for topic in topics:
        yield Publication(topic=topic, reliable=True, waits=timeout is not None, timeout=timeout)


def waits_outside(callbacks: Iterable[Callback], system: System, profile: Profile) -> Iterator[Wait]:
    """The waits of callbacks that no executor in a loop runs, for acknowledgements of messages that no wire of the system has.

    In executors that spin in loops, publications say so themselves; messages on wires of the system, too.

    Parameters
    ----------
    system : with its executors and its wires
    """
    loops = {executor.name for executor in system.executors}
    wired = {transmission.name for transmission in system.network.transmissions if transmission.waits}
    for callback in callbacks:
        if callback.in_executor and callback.executor in loops:
            continue
        for each in publications(callback, profile):
            if each.waits and each.transmission not in wired:
                yield Wait(runnable=body_name(callback.name), topic=each.topic, timeout=each.timeout)
