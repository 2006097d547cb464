"""The initialisation of a client: how long it takes to create all entities, and what that sends over the wire.

A port without threads creates them by a state machine, each in two states: one cycle of the task sends the request, and the following
cycles check for the response. The next request is sent in the cycle after the one that received the response. Nothing blocks. See
S. R. Bappanadu, "Modeling and Timing Analysis of Micro-ROS Application on an Off-Road Vehicle Control Unit", University of Stuttgart,
2022, section 4.2. A request for data has no response; it takes no cycle of its own, or one.

A thread waits for each response before it sends the next request (micro-ROS/rmw_microxrcedds src/utils.c, `run_xrce_session`).
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.named import Brief
from amalthea_uros.spec.description import Description
from amalthea_uros.units import Time
from amalthea_uros.uros.application.created_entities import SESSION, CreatedEntity, created_entities
from amalthea_uros.uros.creation_traffic import CreationTraffic, creation_traffic, round_trip
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.transports.choice import line_of
from amalthea_uros.uros.transports.line import Line

_UNKNOWN = "no maximum is known: set 'initialisation.response_time'"


@dataclass(frozen=True, slots=True, kw_only=True)
class Initialisation(Brief):
    """The initialisation of a client of the middleware.

    Attributes
    ----------
    entities : in the order of their creation
    min_cycles, max_cycles : activations of the task that creates them, from the first request to the last response; None if a thread
        waits for the responses, or the maximum is unknown
    min_time, max_time : from the first request to the last response, or to the activation that receives it; the maximum is None if
        it is unknown
    reason : why the maximum is unknown; "" if it is known
    limit : after which an entity has certainly failed, for all of them; None if there is no limit
    traffic : the messages; None if the middleware has others
    """

    entities: tuple[CreatedEntity, ...]
    min_cycles: int | None
    max_cycles: int | None
    min_time: Time
    max_time: Time | None
    reason: str
    limit: Time | None
    traffic: CreationTraffic | None

    @property
    def most_load(self) -> Fraction | None:
        """Maximum load of the wire, or of its busier direction, meanwhile, if nothing is lost; None if it is unknown."""
        if self.traffic is None or self.traffic.most_wire_time is None or not self.min_time:
            return None
        return min(Fraction(1), Fraction(self.traffic.most_wire_time, self.min_time) + self.traffic.heartbeat_load)


def initialisation(description: Description, profile: Profile, period: Time | None) -> Initialisation | None:
    """The initialisation of the application of a description; None if nothing is known of it.

    Parameters
    ----------
    profile : of its middleware
    period : of the task that creates entities in cycles; None if a thread waits for the responses
    """
    middleware, line = description.middleware, line_of(description)
    entities, figures = created_entities(description.application, profile.middleware), profile.creation
    stated = middleware.initialisation.response_time
    if not entities or (figures is None and period is None):
        return None
    fastest = [_fastest(entity, profile, line, 0 if stated is None else stated.min) for entity in entities]
    limit = None
    if figures is not None and figures.entity_limit and period is None:
        limit = figures.session_limit + (len(entities) - 1) * figures.entity_limit
    # A stated maximum below what the wire needs does not hold.
    slowest = None if stated is None else max(stated.max, *fastest)
    cycles = None if period is None else _cycles(entities, fastest, slowest, period)
    if cycles is None or period is None:
        least, most = sum(fastest), None if slowest is None else len(entities) * slowest
    else:
        least = max(0, cycles[0] - 1) * period
        most = None if cycles[1] is None else max(0, cycles[1] - 1) * period
    stated_sizes = middleware.initialisation.request_sizes
    sizes = {key: size for key in type(stated_sizes).model_fields if (size := getattr(stated_sizes, key)) is not None}
    return Initialisation(
        entities=entities,
        min_cycles=None if cycles is None else cycles[0],
        max_cycles=None if cycles is None else cycles[1],
        min_time=least,
        max_time=most,
        reason=_UNKNOWN if slowest is None else "",
        limit=limit,
        traffic=None if figures is None else creation_traffic(entities, figures, sizes, line, profile.heartbeat),
    )


def _cycles(
    entities: Sequence[CreatedEntity], fastest: Sequence[Time], slowest: Time | None, period: Time
) -> tuple[int, int | None]:
    """The least and the most cycles; before the last response, each request for data can take one."""
    least = sum(1 + response_cycles(time, period) for time in fastest)
    if slowest is None:
        return least, None
    requests = sum(entity.asks_for_data for entity in entities[:-1])
    return least, len(entities) * (1 + response_cycles(slowest, period)) + requests


def _fastest(entity: CreatedEntity, profile: Profile, line: Line | None, stated: Time) -> Time:
    """The minimum time from a request to its response: not less than the wire needs."""
    if profile.creation is None or line is None:
        return stated
    return max(stated, round_trip(profile.creation, line, is_session=entity.kind == SESSION))


def response_cycles(response_time: Time, period: Time) -> int:
    """The number of cycles that check for a response; the first is one cycle after the request."""
    return max(1, -(-response_time // period))
