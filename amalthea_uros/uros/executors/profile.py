"""What an executor needs to know of the middleware: how it waits, and what its callbacks wait for when they send."""

from __future__ import annotations

from amalthea_uros.perf.executors import Publication, Waiting
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import SECOND
from amalthea_uros.uros.callbacks import Callback, Message, transmission_name_of
from amalthea_uros.uros.executors.wires import describes_wire


def waiting_of(middleware: Middleware) -> Waiting:
    """How the middleware waits for an executor; see ros2 micro-ROS/rmw_microxrcedds `rmw_wait.c`."""
    return Waiting()


def publications_of(callback: Callback, middleware: Middleware) -> tuple[Publication, ...]:
    """What a callback sends."""
    return tuple(_publication(message, middleware) for message in callback.outgoing)


def _publication(message: Message, middleware: Middleware) -> Publication:
    waits = message.reliable and middleware.reliable.waits
    return Publication(
        topic=message.topic,
        transmission=transmission_name_of(message, incoming=False) if describes_wire(middleware.transport) else None,
        reliable=message.reliable,
        waits=waits,
        timeout=(middleware.reliable.timeout or SECOND) if waits else None,
    )
