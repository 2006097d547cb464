"""What an executor needs to know of the middleware: how it waits, and what its callbacks wait for when they send."""

from __future__ import annotations

from amalthea_uros.perf.executors import Publication, Waiting
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.callbacks import Callback, Message, transmission_name_of
from amalthea_uros.uros.executors.wires import describes_wire
from amalthea_uros.uros.middleware.load import profile_of
from amalthea_uros.uros.publications import publications
from amalthea_uros.uros.transports.messages import acknowledgement_name


def waiting_of(middleware: Middleware) -> Waiting:
    """How the middleware waits for an executor."""
    return profile_of(middleware).waiting(middleware)


def publications_of(callback: Callback, middleware: Middleware) -> tuple[Publication, ...]:
    """What a callback sends."""

    def transmission(message: Message) -> str | None:
        return transmission_name_of(message, incoming=False) if describes_wire(middleware.transport) else None

    def acknowledgement(message: Message) -> str | None:
        name = transmission(message)
        return None if name is None else acknowledgement_name(name)

    return publications(callback, middleware, profile_of(middleware), transmission, acknowledgement)
