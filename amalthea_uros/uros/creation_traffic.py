"""The messages that create the entities of a client, and how long they occupy the wire.

For the session there is a request of its own; for every other entity a request, which names it, and a status. What receives data then
asks for them. Requests, other than that of the session, and their responses are acknowledged if they are reliable; a port can collect
several acknowledgements in one, so that only their maximum is known.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.network import Direction
from amalthea_uros.units import DataSize, Time
from amalthea_uros.uros.application.created_entities import SESSION, CreatedEntity
from amalthea_uros.uros.middleware.profile import CreationFigures, Heartbeat, whole_bytes
from amalthea_uros.uros.transports.line import Line, time_on


@dataclass(frozen=True, slots=True, kw_only=True)
class SentForCreation(Brief):
    """The messages in one direction.

    Attributes
    ----------
    least_bytes, most_bytes : without acknowledgements and the framing of the transport; the maximum is None if it is unknown
    acknowledgements : their maximum number
    wire_time : the least and the most time on the wire, acknowledgements included in the most; None if it is unknown
    """

    messages: int
    least_bytes: int
    most_bytes: int | None
    acknowledgements: int
    wire_time: tuple[Time | None, Time | None]


@dataclass(frozen=True, slots=True, kw_only=True)
class CreationTraffic(Brief):
    """All messages of the creation.

    Attributes
    ----------
    is_shared : whether both directions use the wire one after the other
    heartbeat_load : maximum load by heartbeats and their answers, while responses take longer than their interval
    reason : why a maximum or a time is unknown; "" if all are known
    """

    to_agent: SentForCreation
    to_controller: SentForCreation
    is_shared: bool
    heartbeat_load: Fraction
    reason: str

    @property
    def least_wire_time(self) -> Time | None:
        """Minimum time for which the wire, or its busier direction, is occupied; None if it is unknown."""
        return self._occupied(0)

    @property
    def most_wire_time(self) -> Time | None:
        """Maximum time for which the wire, or its busier direction, is occupied, without heartbeats; None if it is unknown."""
        return self._occupied(1)

    def _occupied(self, end: int) -> Time | None:
        one, other = self.to_agent.wire_time[end], self.to_controller.wire_time[end]
        if one is None or other is None:
            return None
        return one + other if self.is_shared else max(one, other)


def creation_traffic(
    entities: Sequence[CreatedEntity],
    figures: CreationFigures,
    sizes: Mapping[str, DataSize],
    line: Line | None,
    heartbeat: Callable[[Direction], Heartbeat],
) -> CreationTraffic:
    """The messages of the creation.

    Parameters
    ----------
    sizes : of the longest request of each kind of entity that is stated
    line : the wire; None if it is not described
    """
    created = [entity for entity in entities if entity.kind != SESSION]
    asking = sum(entity.asks_for_data for entity in created)
    longest = [_bytes_of(entity.kind, sizes) for entity in created]
    stated = [size for size in longest if size is not None]
    fixed = [figures.session_request, *[figures.data_request] * asking]
    least = [*fixed, *(min(figures.least_request, size or figures.least_request) for size in longest)]
    most = [*fixed, *stated] if len(stated) == len(longest) else None
    responses = [figures.session_response, *[figures.status] * len(created)]
    own, others = (len(created), len(created) + asking) if figures.acknowledgement else (0, 0)
    missing = list(dict.fromkeys(e.kind for e, size in zip(created, longest, strict=True) if size is None))
    return CreationTraffic(
        to_agent=_sent(least, most, own, figures, line, Direction.TO_AGENT),
        to_controller=_sent(responses, responses, others, figures, line, Direction.TO_CONTROLLER),
        is_shared=line is None or not line.is_duplex,
        heartbeat_load=_heartbeat_load(heartbeat, figures, line),
        reason=_reason(missing, line),
    )


def round_trip(figures: CreationFigures, line: Line, *, is_session: bool) -> Time:
    """The minimum time on the wire from a request to its response."""
    sizes = (figures.session_request, figures.session_response) if is_session else (figures.least_request, figures.status)
    there, back = (
        time_on(line, line.frames(size, way))[0]
        for size, way in zip(sizes, (Direction.TO_AGENT, Direction.TO_CONTROLLER), strict=True)
    )
    return there + back + 2 * line.link.least


def _heartbeat_load(heartbeat: Callable[[Direction], Heartbeat], figures: CreationFigures, line: Line | None) -> Fraction:
    """Each side asks for acknowledgements after its interval without one, and the other side answers."""
    if line is None or figures.acknowledgement is None:
        return Fraction(0)
    loads = []
    for way, back in ((Direction.TO_AGENT, Direction.TO_CONTROLLER), (Direction.TO_CONTROLLER, Direction.TO_AGENT)):
        asked, answered = heartbeat(way), heartbeat(back)
        times = (time_on(line, line.frames(length, way))[1] for length in (asked.length, figures.acknowledgement))
        loads.append(sum(map(Fraction, times, (asked.interval, answered.interval)), Fraction(0)))
    return max(loads) if line.is_duplex else sum(loads, Fraction(0))


def _sent(
    least: Sequence[int],
    most: Sequence[int] | None,
    acknowledgements: int,
    figures: CreationFigures,
    line: Line | None,
    direction: Direction,
) -> SentForCreation:
    ends: tuple[Time | None, Time | None] = (None, None)
    if line is not None:
        times: Callable[[int], tuple[Time, Time]] = lambda size: time_on(line, line.frames(size, direction))  # noqa: E731
        longest = None
        if most is not None:
            answers = [times(figures.acknowledgement)[1]] * acknowledgements if figures.acknowledgement else []
            longest = sum([*(times(size)[1] for size in most), *answers])
        ends = sum(times(size)[0] for size in least), longest
    return SentForCreation(
        messages=len(least),
        least_bytes=sum(least),
        most_bytes=None if most is None else sum(most),
        acknowledgements=acknowledgements,
        wire_time=ends,
    )


def _bytes_of(kind: str, sizes: Mapping[str, DataSize]) -> int | None:
    return whole_bytes(sizes[kind]) if kind in sizes else None


def _reason(missing: Sequence[str], line: Line | None) -> str:
    if line is None:
        return "the wire to the agent is not described: set 'transport'"
    if not missing:
        return ""
    return f"no maximum of the bytes is known: set 'initialisation.request_sizes' for {', '.join(missing)}"
