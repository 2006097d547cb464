"""When events occur, seen from the activation of their process."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.analyze.chains.evaluate import Evaluation
from amalthea_uros.perf.events import Event, EventSet
from amalthea_uros.timing.dataflow.events import EventOccurrence, JobPhase
from amalthea_uros.timing.releases import known_releases
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
        event = self.evaluation.context.system.events_by_name.get(name)
        if event is None or isinstance(event, EventSet):
            raise UnknownError(f"there is no single event {name!r} in the model")
        return event

    def occurrence(self, name: str) -> EventOccurrence:
        """Where an event occurs.

        Raises
        ------
        UnknownError : in several positions, or in some jobs only.
        """
        occurrences = self.evaluation.context.dataflow.events.of(self.event(name))
        if len(occurrences) > 1:
            raise UnknownError(f"the event {name!r} occurs in several positions")
        if any(counter.prescaler > 1 for counter in (occurrences[0].position.counters if occurrences[0].position else ())):
            raise UnknownError(f"the event {name!r} occurs in some jobs only")
        return occurrences[0]

    def of(self, occurrence: EventOccurrence) -> tuple[Time, Time]:
        """How long behind the activation an event occurs, at the earliest and at the latest."""
        response = self.evaluation.solution.responses.get(occurrence.process.name)
        if response is None or response.worst is None:
            raise UnknownError(f"the response time of {occurrence.process.name!r} is not known, or has no bound")
        least = self.evaluation.solution.bcet(occurrence.process.name)
        match occurrence.when:
            case JobPhase.ACTIVATION:
                return 0, 0
            case JobPhase.START:
                return 0, response.worst - least
            case JobPhase.END:
                return response.best, response.worst
        return 0, response.worst

    def spread(self, events: Sequence[str]) -> Time:
        """How far apart events of processes of the same period can occur."""
        windows = []
        periods = set()
        for name in events:
            occurrence = self.occurrence(name)
            releases = known_releases(occurrence.process, self.evaluation.context.system)
            if releases is None:
                raise UnknownError(f"the releases of {occurrence.process.name!r} are not known")
            periods.add(releases.period)
            early, late = self.of(occurrence)
            offset = releases.offset % releases.period
            windows.append((offset + early, offset + late))
        if not windows:
            raise UnknownError("it names no events")
        if len(periods) > 1:
            raise UnknownError("its events have different periods, so that not each of them has a partner")
        return max(late for _, late in windows) - min(early for early, _ in windows)
