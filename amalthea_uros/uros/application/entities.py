"""The entities that an application creates in the middleware, those behind actions, parameters and lifecycles included.

They are created one after the other by a state machine, each in two states: one cycle of the task sends the request, and the following
cycles check for the response. The next request is sent in the cycle after the one that received the response. Nothing blocks. See
S. R. Bappanadu, "Modeling and Timing Analysis of Micro-ROS Application on an Off-Road Vehicle Control Unit", University of Stuttgart,
2022, section 4.2.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.application import Application, NodeSection
from amalthea_uros.spec.middleware import Middleware, ResponseTime
from amalthea_uros.units import Time

#: An action server has services for goals, results and cancelling, and publishes feedback and its status; an action client has their
#: counterparts (ros2/rcl rcl_action/src/rcl_action/action_server.c, action_client.c).
ACTION_SERVICES, ACTION_TOPICS = 3, 2
#: Of a parameter server (ros2/rclc rclc_parameter/src/rclc_parameter/parameter_server.c).
PARAMETER_SERVICES = 6
#: A lifecycle node with its communication interface creates all five services, however many are added to the executor, and a publisher
#: (ros2/rcl rcl_lifecycle/src/com_interface.c).
LIFECYCLE_SERVICES = 5


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
        services=sum(map(_services, nodes)),
        clients=sum(len(node.clients) + ACTION_SERVICES * len(node.action_clients) for node in nodes),
        guard_conditions=sum(len(node.timers) + len(node.guard_conditions) + len(node.action_servers) for node in nodes),
        executors=len(middleware.stated_executors) if any(map(_has_handles, nodes)) else 0,
    )


def _publishers(node: NodeSection) -> int:
    changes = node.parameter_server is not None and node.parameter_server.events
    return len(node.publishers) + ACTION_TOPICS * len(node.action_servers) + changes + (node.lifecycle is not None)


def _services(node: NodeSection) -> int:
    parameters = PARAMETER_SERVICES if node.parameter_server is not None else 0
    lifecycle = LIFECYCLE_SERVICES if node.lifecycle is not None else 0
    return len(node.services) + ACTION_SERVICES * len(node.action_servers) + parameters + lifecycle


def _has_handles(node: NodeSection) -> bool:
    kinds = (node.subscriptions, node.timers, node.services, node.clients)
    more = (node.guard_conditions, node.action_servers, node.action_clients)
    return any(kinds) or any(more) or node.parameter_server is not None or node.lifecycle is not None


@dataclass(frozen=True, slots=True, kw_only=True)
class CreatedEntity:
    """An XRCE-DDS entity that the agent creates on request."""

    kind: str
    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Initialisation:
    """The initialisation of the middleware.

    Attributes
    ----------
    entities : in the order of their creation
    period : of the task that creates them
    min_cycles, max_cycles : activations of that task from the first request to the last response; the maximum is None if unknown
    """

    entities: tuple[CreatedEntity, ...]
    period: Time
    min_cycles: int
    max_cycles: int | None

    @property
    def min_time(self) -> Time:
        """Minimum time from the first request to the activation that receives the last response."""
        return max(0, self.min_cycles - 1) * self.period

    @property
    def max_time(self) -> Time | None:
        """Maximum time from the first request to the activation that receives the last response; None if unknown."""
        return None if self.max_cycles is None else max(0, self.max_cycles - 1) * self.period


def created_entities(application: Application) -> tuple[CreatedEntity, ...]:
    """All entities in the order of their creation: the session, then each node with its entities."""
    if not application.nodes:
        return ()
    return (CreatedEntity(kind="session", name="client"), *(entity for node in application.nodes for entity in _of_node(node)))


def _of_node(node: NodeSection) -> Iterator[CreatedEntity]:
    yield CreatedEntity(kind="participant", name=node.name)
    for publisher in node.publishers:
        yield from _of_topic(publisher.topic, "publisher", "datawriter")
    for subscription in node.subscriptions:
        yield from _of_topic(subscription.topic, "subscriber", "datareader")
    for service in node.services:
        yield CreatedEntity(kind="replier", name=service.name)
    for client in node.clients:
        yield CreatedEntity(kind="requester", name=client.service)


def _of_topic(topic: str, *kinds: str) -> Iterator[CreatedEntity]:
    yield CreatedEntity(kind="topic", name=topic)
    yield from (CreatedEntity(kind=kind, name=topic) for kind in kinds)


def initialisation(application: Application, period: Time, response_time: ResponseTime | None) -> Initialisation:
    """The initialisation of an application.

    Parameters
    ----------
    period : of the executor
    response_time : of the agent; None if unknown
    """
    entities = created_entities(application)
    fastest = response_cycles(response_time.min, period) if response_time else 1
    slowest = response_cycles(response_time.max, period) if response_time else None
    return Initialisation(
        entities=entities,
        period=period,
        min_cycles=len(entities) * (1 + fastest),
        max_cycles=None if slowest is None else len(entities) * (1 + slowest),
    )


def response_cycles(response_time: Time, period: Time) -> int:
    """The number of cycles that check for a response; the first is one cycle after the request."""
    return max(1, -(-response_time // period))
