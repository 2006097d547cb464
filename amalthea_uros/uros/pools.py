"""Static pools of rmw_microxrcedds: what an application needs against what was compiled in."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import data_size_text
from amalthea_uros.uros.callbacks import Callback, Message
from amalthea_uros.uros.notes import Notes
from amalthea_uros.uros.streams import DEFAULT_STREAM_HISTORY

#: Values of the build options that are not set, from the table in the README of micro-ROS/rmw_microxrcedds.
DEFAULTS: Mapping[str, int] = {
    "RMW_UXRCE_MAX_SESSIONS": 1,
    "RMW_UXRCE_MAX_NODES": 4,
    "RMW_UXRCE_MAX_TOPICS": -1,
    "RMW_UXRCE_MAX_PUBLISHERS": 4,
    "RMW_UXRCE_MAX_SUBSCRIPTIONS": 4,
    "RMW_UXRCE_MAX_SERVICES": 4,
    "RMW_UXRCE_MAX_CLIENTS": 4,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Pool:
    """A pool.

    Attributes
    ----------
    option : the build option that sets its size
    stated : whether the author states the size; otherwise it is the default
    """

    option: str
    needed: int
    available: int
    stated: bool

    @property
    def is_exceeded(self) -> bool:
        """Whether more is needed than there is."""
        return self.needed > self.available


def needs(application: Application) -> dict[str, int]:
    """How many places of each pool an application takes."""
    nodes = application.nodes
    publishers = sum(len(node.publishers) for node in nodes)
    subscriptions = sum(len(node.subscriptions) for node in nodes)
    return {
        "RMW_UXRCE_MAX_SESSIONS": 1 if nodes else 0,
        "RMW_UXRCE_MAX_NODES": len(nodes),
        "RMW_UXRCE_MAX_TOPICS": publishers + subscriptions,
        "RMW_UXRCE_MAX_PUBLISHERS": publishers,
        "RMW_UXRCE_MAX_SUBSCRIPTIONS": subscriptions,
        "RMW_UXRCE_MAX_SERVICES": sum(len(node.services) for node in nodes),
        "RMW_UXRCE_MAX_CLIENTS": sum(len(node.clients) for node in nodes),
    }


def pools_of(application: Application, middleware: Middleware) -> tuple[Pool, ...]:
    """All pools with what is needed and available."""
    limits = middleware.limits
    found = []
    for option, needed in needs(application).items():
        stated: int | None = getattr(limits, option)
        available = DEFAULTS[option] if stated is None else stated
        # -1 stands for as many as there are of everything that has a topic.
        found.append(
            Pool(option=option, needed=needed, available=needed if available < 0 else available, stated=stated is not None)
        )
    return tuple(found)


def check(pools: tuple[Pool, ...], callbacks: tuple[Callback, ...], middleware: Middleware, notes: Notes) -> None:
    """Note what is too small."""
    for pool in filter(lambda pool: pool.is_exceeded, pools):
        message = f"the application needs {pool.needed} of {pool.option}, which is {pool.available}"
        advice = f"Set {pool.option} to {pool.needed} or more in the build, and state it under 'limits'."
        place = middleware.limits.location(pool.option)
        if pool.stated:
            notes.error("UR120", message, place, advice)
        else:
            notes.warning("UR120", f"{message} by default", place, advice)
    for sent in _messages(callbacks):
        _check_size(sent, middleware, notes)


def _messages(callbacks: tuple[Callback, ...]) -> Iterator[Message]:
    """Each message once, although several callbacks may send it."""
    seen = set()
    for callback in callbacks:
        for message in (callback.incoming, *callback.outgoing):
            if message is not None and (key := (message.topic, message.size, message.origin)) not in seen:
                seen.add(key)
                yield message


def _check_size(message: Message, middleware: Middleware, notes: Notes) -> None:
    """A best-effort message has to fit into the MTU; a reliable one is split over the buffers of its stream."""
    limits = middleware.limits
    if limits.RMW_UXRCE_MTU is None:
        return
    history = limits.RMW_UXRCE_STREAM_HISTORY or DEFAULT_STREAM_HISTORY
    room = limits.RMW_UXRCE_MTU * (history if message.reliable else 1)
    size = message.size + middleware.transport.overhead
    if size > room:
        what = f"RMW_UXRCE_MTU times RMW_UXRCE_STREAM_HISTORY ({history})" if message.reliable else "RMW_UXRCE_MTU"
        text = f"a message of {message.topic!r} takes {data_size_text(size)} with headers, more than {data_size_text(room)}"
        notes.error("UR121", f"{text}, which is {what}", message.origin, "Enlarge it, or send smaller messages.")
