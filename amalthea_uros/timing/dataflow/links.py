"""What carries the effect from one event of a chain to the next: the order within a job, a trigger, or data.

Each event is looked for in the processes; where several fit, those are taken between which something carries. The names of segments say
nothing: what counts is which label one process writes and the other one reads.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from itertools import pairwise, product

from amalthea_uros.perf.events import Event, RunnableChange, RunnableEvent
from amalthea_uros.perf.software import (
    AccessKind,
    Call,
    LabelAccess,
    ModeAccess,
    ModeOperation,
    Receive,
    Send,
    Trigger,
)
from amalthea_uros.perf.stimuli import EventTriggered
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.events import Spot, Spots, UnresolvedError, When
from amalthea_uros.timing.dataflow.occurrences import Occurrence, raises
from amalthea_uros.timing.dataflow.positions import Place

#: More candidates for the events of one sequence are not tried.
MOST_CANDIDATES = 10_000

_NameOf = Callable[[Place], "str | None"]


class Carrier(StrEnum):
    """What takes the effect from one event to the next."""

    JOB = "the same job"
    NEXT_JOB = "the next job"
    TRIGGER = "a trigger"
    DATA = "data"
    NOTHING = "nothing"


#: The effect is taken over as if there were a variable.
GAPS = (Carrier.NOTHING, Carrier.NEXT_JOB)


@dataclass(frozen=True, slots=True)
class Hop:
    """From one event to the next.

    Attributes
    ----------
    names : of the labels, the channel or the stimulus
    write, read : where the data are written and read, or the trigger is fired
    """

    carrier: Carrier
    names: tuple[str, ...] = ()
    write: Place | None = None
    read: Place | None = None


@dataclass(frozen=True, slots=True)
class Route:
    """A way through a chain: spots, and the hops between them."""

    events: tuple[str, ...]
    spots: tuple[Spot, ...]
    hops: tuple[Hop, ...]

    @property
    def gaps(self) -> int:
        """How often nothing carries the effect."""
        return sum(hop.carrier in GAPS for hop in self.hops)


@dataclass(slots=True)
class Resolver:
    """Finds what carries the effect from event to event."""

    system: System
    spots: Spots = field(init=False)
    _named: dict[tuple[str, _NameOf], dict[str, list[Place]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.spots = Spots(self.system)

    def routes(self, events: Sequence[Event]) -> list[Route]:
        """The ways that a sequence of events can mean, those with the fewest gaps.

        Raises
        ------
        UnresolvedError : an event is not found, or there is no analysis for it.
        """
        choices = [self.spots.of(event) for event in events]
        count = 1
        for choice in choices:
            count *= len(choice)
        if count > MOST_CANDIDATES:
            raise UnresolvedError("its events fit too many processes; they should name theirs")
        names = tuple(event.name for event in events)
        found = [self._route(names, spots) for spots in product(*choices)]
        fewest = min(route.gaps for route in found)
        return [route for route in found if route.gaps == fewest]

    def _route(self, events: tuple[str, ...], spots: tuple[Spot, ...]) -> Route:
        return Route(events, spots, tuple(self._hop(first, then) for first, then in pairwise(spots)))

    def _hop(self, first: Spot, then: Spot) -> Hop:
        if first.process.name == then.process.name:
            if first.order <= then.order:
                return Hop(Carrier.JOB)
            carried = self._data(first, then)
            return Hop(Carrier.NEXT_JOB) if carried is None else carried
        trigger = self._trigger(first, then)
        if trigger is not None:
            return trigger
        return self._data(first, then) or Hop(Carrier.NOTHING)

    def _trigger(self, first: Spot, then: Spot) -> Hop | None:
        if then.when is When.ACTIVATION and then.process.stimuli and first.when is When.ACTIVATION:
            return None
        raised = {
            name: stimulus.events
            for name in then.process.stimuli
            if isinstance(stimulus := self.system.stimuli_by_name.get(name), EventTriggered)
        }
        for place in self.spots.places(first.process.name):
            if isinstance(place.activity, Trigger) and place.activity.stimulus in then.process.stimuli:
                return Hop(Carrier.TRIGGER, (place.activity.stimulus,), place)
            for name, events in raised.items():
                if any(self._occurs_at(place, event) for event in events):
                    return Hop(Carrier.TRIGGER, (name,), place)
        return None

    def _occurs_at(self, place: Place, name: str) -> bool:
        """Whether an event occurs behind an activity; before a call is no place from which something is triggered."""
        event = self.system.events_by_name.get(name)
        if event is None or (isinstance(event, RunnableEvent) and event.change is not RunnableChange.TERMINATE):
            return False
        return raises(Occurrence(place.process, place.runnable, place.activity), event)

    def _accesses(self, spot: Spot, name_of: _NameOf) -> dict[str, list[Place]]:
        """What is written or read where an event occurs: by the access itself, in its runnable, or anywhere in the process."""
        key = (spot.process.name, name_of)
        if key not in self._named:
            self._named[key] = _by_name(self.spots.places(spot.process.name), name_of)
        everything = self._named[key]
        if spot.place is None:
            return everything
        if (own := name_of(spot.place)) is not None:
            return {own: [spot.place]}
        runnable = spot.place.activity.runnable if isinstance(spot.place.activity, Call) else spot.place.runnable
        within = [place for place in self.spots.places(spot.process.name) if place.runnable == runnable]
        return _by_name(within, name_of) or everything

    def _data(self, first: Spot, then: Spot) -> Hop | None:
        """The labels and channels that one process writes, behind an event if it can be, and the other one reads."""
        written = self._accesses(first, _written)
        read = self._accesses(then, _read)
        names = tuple(name for name in written if name in read)
        if not names:
            return None
        # The last write counts, and the first read behind which the data are there.
        return Hop(Carrier.DATA, names, written[names[0]][-1], read[names[0]][0])


def _written(place: Place) -> str | None:
    match place.activity:
        case LabelAccess(label=name, kind=AccessKind.WRITE) | Send(channel=name):
            return name
        case ModeAccess(label=name, operation=operation) if operation is not ModeOperation.READ:
            return name
    return None


def _read(place: Place) -> str | None:
    match place.activity:
        case LabelAccess(label=name, kind=AccessKind.READ) | Receive(channel=name) | ModeAccess(label=name):
            return name
    return None


def _by_name(within: Iterable[Place], name_of: _NameOf) -> dict[str, list[Place]]:
    by_name: dict[str, list[Place]] = {}
    for place in within:
        if (name := name_of(place)) is not None:
            by_name.setdefault(name, []).append(place)
    return by_name
