"""Routes of a chain: the occurrences of its events that are linked to each other.

Each event is located in the processes; if several occurrences are possible, those that are linked are selected. The names of segments
are irrelevant: links are labels that one process writes and another one reads, triggers and OS events. If several links can take the
effect from one event to the next, each of them is on a route of its own, because nobody states which one is meant.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from itertools import pairwise, product
from math import prod

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.events import Event, EventChain
from amalthea_uros.timing.dataflow.chains import MAX_ROUTES, Unfolded, sequences, unfold
from amalthea_uros.timing.dataflow.events import EventOccurrence
from amalthea_uros.timing.dataflow.links import GAPS, UNTIMED, Dataflow, Link, LinkKind
from amalthea_uros.timing.dataflow.untyped_events import readings

#: More combinations of occurrences of the events of one sequence are not tried.
MAX_CANDIDATES = 10_000


class UnlinkedError(UnknownError):
    """Nothing takes the effect from an event of a chain to the next one.

    Attributes
    ----------
    gaps : the names of both events, for each place at which that is so
    """

    def __init__(self, gaps: Sequence[tuple[str, str]]) -> None:
        first, then = gaps[0]
        super().__init__(f"no data flow or trigger connects {first!r} to {then!r}")
        self.gaps = tuple(gaps)


@dataclass(frozen=True, slots=True)
class Route:
    """A path through a chain: occurrences of its events, and the links between them."""

    events: tuple[str, ...]
    occurrences: tuple[EventOccurrence, ...]
    links: tuple[Link, ...]

    @property
    def gaps(self) -> tuple[tuple[str, str], ...]:
        """The events that are not linked to the next one, with that."""
        return tuple(pair for pair, link in zip(pairwise(self.events), self.links, strict=True) if link.kind in GAPS)

    @property
    def is_timed(self) -> bool:
        """Whether the times of all links are known."""
        return not any(link.kind in UNTIMED for link in self.links)


def is_linked(first: Event, then: Event, dataflow: Dataflow) -> bool:
    """Whether something takes the effect from one event to another; so it is if nobody knows where they occur."""
    try:
        routes([first, then], dataflow)
    except UnlinkedError:
        return False
    except UnknownError:
        return True
    return True


def routes(events: Sequence[Event], dataflow: Dataflow) -> list[Route]:
    """The possible routes of a sequence of events.

    Raises
    ------
    UnknownError : an event cannot be located, nothing links it to the next one, or there are too many routes.
    """
    found = _least_gaps(events, dataflow)
    gaps = dict.fromkeys(gap for route in found for gap in route.gaps)
    if gaps:
        raise UnlinkedError(list(gaps))
    return found


def routes_of_paths(
    unfolded: Unfolded, dataflow: Dataflow, *, with_readings: bool = False
) -> dict[tuple[str, ...], list[Route]]:
    """The possible routes of all paths through a chain, by their events.

    Parameters
    ----------
    with_readings : also of events without a type, for each type that they may have

    Raises
    ------
    UnknownError : an event cannot be located, nothing links it to the next one, or there are too many routes.
    """
    events = dataflow.system.events_by_name
    found: dict[tuple[str, ...], list[Route]] = {}
    gaps: list[tuple[str, str]] = []
    for path in sequences(unfolded):
        of_path = [events[name] for name in path]
        routes_here: list[Route] = []
        unlinked: list[UnlinkedError] = []
        for each in readings(of_path) if with_readings else [of_path]:
            try:
                routes_here += routes(each, dataflow)
            except UnlinkedError as error:
                unlinked.append(error)
        if unlinked and routes_here:
            raise UnknownError(f"events of the chain have no type, and with some types {unlinked[0]}")
        if unlinked:
            gaps += unlinked[0].gaps
        found[path] = routes_here
    if gaps:
        raise UnlinkedError(list(dict.fromkeys(gaps)))
    return found


def corresponding(first: Event, then: Event, dataflow: Dataflow) -> list[Route]:
    """The routes from occurrences of an event to those of another one that belong to them, even if nothing links them.

    If a job passes both, or one triggers the other, these belong together, whatever data they share as well.

    Raises
    ------
    UnknownError : an event cannot be located, or there are too many routes.
    """
    found = _least_gaps([first, then], dataflow)
    one_to_one = [route for route in found if route.links[0].kind in (LinkKind.JOB, LinkKind.TRIGGER)]
    return one_to_one or found


def _least_gaps(events: Sequence[Event], dataflow: Dataflow) -> list[Route]:
    """The routes with the fewest events that are not linked to the next one."""
    choices = [dataflow.events.of(event) for event in events]
    if prod(map(len, choices)) > MAX_CANDIDATES:
        raise UnknownError("its events occur in too many processes; set the process of each event")
    found = _occurrences_with_least_gaps(choices, dataflow)
    # Occurrences alone can be more.
    if sum(prod(map(len, links)) for _, links in found) > max(MAX_ROUTES, len(found)):
        raise UnknownError(f"it has more than {MAX_ROUTES} routes, as several links can take the effect on")
    names = tuple(event.name for event in events)
    return [Route(names, occurrences, links) for occurrences, alternatives in found for links in product(*alternatives)]


def _occurrences_with_least_gaps(
    choices: Sequence[Sequence[EventOccurrence]], dataflow: Dataflow
) -> list[tuple[tuple[EventOccurrence, ...], list[tuple[Link, ...]]]]:
    """Occurrences of each event, and all links from each of them to the next one, or the gap there."""
    found = []
    for occurrences in product(*choices):
        links = [dataflow.links(first, then) or (dataflow.gap(first, then),) for first, then in pairwise(occurrences)]
        found.append((sum(alternatives[0].kind in GAPS for alternatives in links), occurrences, links))
    fewest = min(gaps for gaps, _, _ in found)
    return [(occurrences, links) for gaps, occurrences, links in found if gaps == fewest]


def route_text(route: Route) -> str:
    """The events of a route and the links between them."""
    parts = [route.events[0]]
    for link, event in zip(route.links, route.events[1:], strict=True):
        carried = f"{link.kind} {', '.join(link.names)}".strip()
        parts.append(f"-[{carried}]-> {event}")
    return " ".join(parts)


def crosses(chain: EventChain, dataflow: Dataflow) -> bool:
    """Whether a chain passes a wire or an executor that loops, so that its latency is a sum of message hops."""
    system = dataflow.system
    if not system.has_messages_or_loops:
        return False
    try:
        unfolded = unfold(chain, system)[0]
        names = {name for path in sequences(unfolded) for name in path}
    except UnknownError:
        return False  # the analysis of chains reports it
    if names & system.callback_of_host_event.keys():
        return True
    crossing = system.transmissions.keys() | system.executor_of_task.keys()
    for name in names & system.events_by_name.keys():
        with suppress(UnknownError):
            if any(each.process.name in crossing for each in dataflow.events.of(system.events_by_name[name])):
                return True
    return False
