"""Which occurrences of its events a chain means: those between which something takes the effect on.

Each event is looked for in the processes; where several occurrences are possible, those are taken that are linked. The names of
segments do not matter: what counts is which label one process writes and the other one reads.
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
        """Whether it is known when each effect is passed on."""
        return not any(link.kind in UNTIMED for link in self.links)


def is_linked(first: Event, then: Event, dataflow: Dataflow) -> bool:
    """Whether something takes the effect from one event to another; so it is if nobody knows where they occur."""
    try:
        return routes([first, then], dataflow)[0].gaps == 0
    except UnresolvedError:
        return True


def routes(events: Sequence[Event], dataflow: Dataflow) -> list[Route]:
    """The ways that a sequence of events can mean, those with the fewest gaps.

    Raises
    ------
    UnresolvedError : an event is not found, or there is no analysis for it.
    """
    choices = [dataflow.events.of(event) for event in events]
    if prod(map(len, choices)) > MAX_CANDIDATES:
        raise UnresolvedError("its events fit too many processes; they should name theirs")
    names = tuple(event.name for event in events)
    found = [
        Route(names, occurrences, tuple(dataflow.between(first, then) for first, then in pairwise(occurrences)))
        for occurrences in product(*choices)
    ]
    fewest = min(route.gaps for route in found)
    return [route for route in found if route.gaps == fewest]
