"""The initialisation of the middleware as a state machine.

Entities are created one after the other, each in two states: one cycle of the task sends the request, and the following cycles check
for the response. The next request is sent in the cycle after the one that received the response. Nothing blocks. See S. R. Bappanadu,
"Modeling and Timing Analysis of Micro-ROS Application on an Off-Road Vehicle Control Unit", University of Stuttgart, 2022, section 4.2.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from amalthea_uros.spec.application import Application, NodeSection
from amalthea_uros.spec.middleware import ResponseTime
from amalthea_uros.units import Time


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


def entities_of(application: Application) -> tuple[CreatedEntity, ...]:
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
    entities = entities_of(application)
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
