"""The XRCE-DDS entities that an application creates, in the order of their creation.

For a node there is a participant; for a publisher a topic, a publisher and a data writer; for a subscription a topic, a subscriber and
a data reader; a service has a replier, a client a requester (micro-ROS/rmw_microxrcedds src/rmw_node.c, rmw_publisher.c,
rmw_subscription.c, rmw_service.c, rmw_client.c). What receives data asks the agent for them once it is created.
"""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros._internal.ports import ACTION_SERVICES, ACTION_TOPICS, LIFECYCLE_SERVICES, parameter_services
from amalthea_uros._internal.records import dataclass
from amalthea_uros.spec.application import Application, NodeSection
from amalthea_uros.spec.middleware import Middleware

SESSION = "session"
#: The kinds of entities that the agent sends data for.
_RECEIVING = ("datareader", "replier", "requester")


@dataclass(frozen=True, slots=True, kw_only=True)
class CreatedEntity:
    """An XRCE-DDS entity that the agent creates on request."""

    kind: str
    name: str

    @property
    def asks_for_data(self) -> bool:
        """Whether the client then asks the agent for its data, which no response follows."""
        return self.kind in _RECEIVING


def created_entities(application: Application, middleware: Middleware) -> tuple[CreatedEntity, ...]:
    """All entities in the order of their creation: the session, then each node with its entities."""
    if not application.nodes:
        return ()
    return (
        CreatedEntity(kind=SESSION, name="client"),
        *(entity for node in application.nodes for entity in _of_node(node, middleware)),
    )


def _of_node(node: NodeSection, middleware: Middleware) -> Iterator[CreatedEntity]:
    yield CreatedEntity(kind="participant", name=node.name)
    for publisher in node.publishers:
        yield from _publisher(publisher.topic)
    for subscription in node.subscriptions:
        yield from _subscription(subscription.topic)
    for service in node.services:
        yield CreatedEntity(kind="replier", name=service.name)
    for client in node.clients:
        yield CreatedEntity(kind="requester", name=client.service)
    for server in node.action_servers:
        yield from [CreatedEntity(kind="replier", name=server.name)] * ACTION_SERVICES
        for _ in range(ACTION_TOPICS):
            yield from _publisher(server.name)
    for action in node.action_clients:
        yield from [CreatedEntity(kind="requester", name=action.action)] * ACTION_SERVICES
        for _ in range(ACTION_TOPICS):
            yield from _subscription(action.action)
    if node.parameter_server is not None:
        yield from [CreatedEntity(kind="replier", name="parameters")] * parameter_services(middleware.ros)
        if node.parameter_server.events:
            yield from _publisher("parameter_events")
    if node.lifecycle is not None:
        yield from _publisher("transition_event")
        yield from [CreatedEntity(kind="replier", name="lifecycle")] * LIFECYCLE_SERVICES


def _publisher(topic: str) -> Iterator[CreatedEntity]:
    yield from (CreatedEntity(kind=kind, name=topic) for kind in ("topic", "publisher", "datawriter"))


def _subscription(topic: str) -> Iterator[CreatedEntity]:
    yield from (CreatedEntity(kind=kind, name=topic) for kind in ("topic", "subscriber", "datareader"))
