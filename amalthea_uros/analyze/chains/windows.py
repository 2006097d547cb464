"""When events occur, seen from the activation of their process."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.analyze.chains.evaluate import Evaluation
from amalthea_uros.analyze.response_times.core import known_releases
from amalthea_uros.perf.events import Event, EventSet
from amalthea_uros.timing.dataflow.events import Spot, When
from amalthea_uros.units import Time


class UnknownError(Exception):
    """A constraint cannot be judged; the text says why."""


@dataclass(frozen=True, slots=True)
class Windows:
    """The windows in which the events of a system occur."""

    evaluation: Evaluation

    def event(self, name: str) -> Event:
        """An event of the model.

        Raises
        ------
        UnknownError : there is none of that name, or it is several.
        """
        event = self.evaluation.known.system.events_by_name.get(name)
        if event is None or isinstance(event, EventSet):
            raise UnknownError(f"there is no single event {name!r} in the model")
        return event

    def spot(self, name: str) -> Spot:
        """Where an event occurs.

        Raises
        ------
        UnknownError : in several places, or in some jobs only.
        """
        spots = self.evaluation.resolver.spots.of(self.event(name))
        if len(spots) > 1:
            raise UnknownError(f"the event {name!r} occurs in several places")
        if any(counter.prescaler > 1 for counter in (spots[0].place.counters if spots[0].place else ())):
            raise UnknownError(f"the event {name!r} occurs in some jobs only")
        return spots[0]

    def of(self, spot: Spot) -> tuple[Time, Time]:
        """How long behind the activation an event occurs, at the earliest and at the latest."""
        response = self.evaluation.responses.get(spot.process.name)
        if response is None or response.worst is None:
            raise UnknownError(f"the response time of {spot.process.name!r} is not known, or has no bound")
        known = self.evaluation.known
        least = known.costs[spot.process.name].best // known.demands.grains(known.placed[spot.process.name].core)
        match spot.when:
            case When.ACTIVATION:
                return 0, 0
            case When.START:
                return 0, response.worst - least
            case When.END:
                return response.best, response.worst
        return 0, response.worst

    def spread(self, events: Sequence[str]) -> Time:
        """How far apart events of processes of the same period can occur."""
        windows = []
        periods = set()
        for name in events:
            spot = self.spot(name)
            releases = known_releases(spot.process, self.evaluation.known.system)
            if releases is None:
                raise UnknownError(f"the releases of {spot.process.name!r} are not known")
            periods.add(releases.period)
            early, late = self.of(spot)
            offset = releases.offset % releases.period
            windows.append((offset + early, offset + late))
        if not windows:
            raise UnknownError("it names no events")
        if len(periods) > 1:
            raise UnknownError("its events have different periods, so that not each of them has a partner")
        return max(late for _, late in windows) - min(early for early, _ in windows)
