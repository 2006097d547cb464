"""Routes of a chain: the occurrences of its events that are linked to each other.

Each event is located in the processes; if several occurrences are possible, those that are linked are selected. The names of segments
are irrelevant: links are labels that one process writes and another one reads, triggers and OS events.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise, product
from math import prod

from amalthea_uros.perf.events import Event
from amalthea_uros.timing.dataflow.events import EventOccurrence, UnresolvedError
from amalthea_uros.timing.dataflow.links import GAPS, UNTIMED, Dataflow, Link

#: More combinations of occurrences of the events of one sequence are not tried.
MAX_CANDIDATES = 10_000


@dataclass(frozen=True, slots=True)
class Route:
    """A way through a chain: occurrences of its events, and the links between them."""

    events: tuple[str, ...]
    occurrences: tuple[EventOccurrence, ...]
    links: tuple[Link, ...]

    @property
    def gaps(self) -> int:
        """Number of events that are not linked to the next one."""
        return sum(link.kind in GAPS for link in self.links)

    @property
    def is_timed(self) -> bool:
        """Whether the times of all links are known."""
        return not any(link.kind in UNTIMED for link in self.links)


def is_linked(first: Event, then: Event, dataflow: Dataflow) -> bool:
    """Whether something takes the effect from one event to another; so it is if nobody knows where they occur."""
    try:
        return routes([first, then], dataflow)[0].gaps == 0
    except UnresolvedError:
        return True


def routes(events: Sequence[Event], dataflow: Dataflow) -> list[Route]:
    """The possible routes of a sequence of events, reduced to those with the fewest gaps.

    Raises
    ------
    UnresolvedError : an event cannot be located.
    """
    choices = [dataflow.events.of(event) for event in events]
    if prod(map(len, choices)) > MAX_CANDIDATES:
        raise UnresolvedError("its events occur in too many processes; set the process of each event")
    names = tuple(event.name for event in events)
    found = [
        Route(names, occurrences, tuple(dataflow.between(first, then) for first, then in pairwise(occurrences)))
        for occurrences in product(*choices)
    ]
    fewest = min(route.gaps for route in found)
    return [route for route in found if route.gaps == fewest]
