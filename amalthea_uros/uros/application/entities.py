"""The entities that an application creates in the middleware, those behind actions, parameters and lifecycles included."""

from __future__ import annotations

from amalthea_uros._internal.ports import ACTION_SERVICES, ACTION_TOPICS, LIFECYCLE_SERVICES, parameter_services
from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.application import Application, NodeSection
from amalthea_uros.spec.middleware import Middleware


@dataclass(frozen=True, slots=True, kw_only=True)
class Entities(Brief):
    """How many entities an application creates.

    Attributes
    ----------
    guard_conditions : one per timer (ros2/rcl rcl/src/rcl/timer.c), those of action servers included, and those of the application
    executors : those that spin, each with a wait set
    """

    nodes: int
    publishers: int
    subscriptions: int
    services: int
    clients: int
    guard_conditions: int
    executors: int

    @property
    def topics(self) -> int:
        """One per publisher and subscription, also for the same name."""
        return self.publishers + self.subscriptions

    @property
    def receivers(self) -> int:
        """The entities that messages arrive for."""
        return self.subscriptions + self.services + self.clients


def entities_of(application: Application, middleware: Middleware) -> Entities:
    """The entities of an application."""
    nodes = application.nodes
    return Entities(
        nodes=len(nodes),
        publishers=sum(map(_publishers, nodes)),
        subscriptions=sum(len(node.subscriptions) + ACTION_TOPICS * len(node.action_clients) for node in nodes),
        services=sum(_services(node, middleware) for node in nodes),
        clients=sum(len(node.clients) + ACTION_SERVICES * len(node.action_clients) for node in nodes),
        guard_conditions=sum(len(node.timers) + len(node.guard_conditions) + len(node.action_servers) for node in nodes),
        executors=len(middleware.stated_executors) if any(map(_has_handles, nodes)) else 0,
    )


def _publishers(node: NodeSection) -> int:
    changes = node.parameter_server is not None and node.parameter_server.events
    return len(node.publishers) + ACTION_TOPICS * len(node.action_servers) + changes + (node.lifecycle is not None)


def _services(node: NodeSection, middleware: Middleware) -> int:
    parameters = parameter_services(middleware.ros) if node.parameter_server is not None else 0
    lifecycle = LIFECYCLE_SERVICES if node.lifecycle is not None else 0
    return len(node.services) + ACTION_SERVICES * len(node.action_servers) + parameters + lifecycle


def _has_handles(node: NodeSection) -> bool:
    kinds = (node.subscriptions, node.timers, node.services, node.clients)
    more = (node.guard_conditions, node.action_servers, node.action_clients)
    return any(kinds) or any(more) or node.parameter_server is not None or node.lifecycle is not None
