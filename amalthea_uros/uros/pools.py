"""Static pools of rmw_microxrcedds: their sizes compared with the needs of the application."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.notes import Notes

#: Default values of the build options, from the table in the README of micro-ROS/rmw_microxrcedds.
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
    configured : whether the description sets the size; otherwise it is the default
    """

    option: str
    needed: int
    available: int
    configured: bool

    @property
    def is_exceeded(self) -> bool:
        """Whether the application needs more than is available."""
        return self.needed > self.available


def needs(application: Application) -> dict[str, int]:
    """The number of elements of each pool that an application needs."""
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
    """All pools with their needed and available sizes."""
    limits = middleware.limits
    found = []
    for option, needed in needs(application).items():
        configured: int | None = getattr(limits, option)
        size = DEFAULTS[option] if configured is None else configured
        # -1 makes the pool as large as all entities with a topic need.
        available = needed if size < 0 else size
        found.append(Pool(option=option, needed=needed, available=available, configured=configured is not None))
    return tuple(found)


def check_pools(pools: tuple[Pool, ...], middleware: Middleware, notes: Notes) -> None:
    """Report pools that are too small."""
    for pool in filter(lambda pool: pool.is_exceeded, pools):
        default = "" if pool.configured else " by default"
        message = f"{pool.option} is {pool.available}{default}, but the application needs {pool.needed}"
        advice = f"Set {pool.option} to {pool.needed} or more in the build and under 'limits'."
        report = notes.error if pool.configured else notes.warning
        report("UR120", message, middleware.limits.location(pool.option), advice)
