"""Activations that spread through a system: a process that another one triggers arrives as irregularly as that one ends.

Compositional analysis (K. Richter 2005): the arrivals of the triggered process are derived from those of the triggering one and the
times at which the jobs of its busy window end. This is repeated until nothing changes; irregularity only grows, so that the least fixed
point is found, or none.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from amalthea_uros.analyze.response_times.task import Response
from amalthea_uros.perf.events import CustomEvent, Event, ModeLabelEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.software import Process, Trigger
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.occurrences import Occurrence, occurrences, raises
from amalthea_uros.timing.event_models.base import Arrivals, Behind, Delayed, Every, Repeated, Together
from amalthea_uros.timing.event_models.stimuli import arrivals_of
from amalthea_uros.units import Time


class UnknownArrivalsError(Exception):
    """Nothing bounds the arrivals of a process; the text says why."""


class Cause(NamedTuple):
    """A process that causes something, how often in a job, and whether only every n-th time."""

    process: Process
    times: int
    counter: Counter | None


@dataclass(slots=True)
class Propagation:
    """The arrivals of all processes, given their response times so far.

    Attributes
    ----------
    least_costs : best-case execution times, as far as they are known
    unknown : processes of which the response time is not known
    triggers : who triggers a stimulus
    """

    system: System
    least_costs: Mapping[str, Time]
    unknown: Mapping[str, str]
    triggers: dict[str, list[Cause]] = field(default_factory=dict)
    happens: list[Occurrence] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.happens = list(occurrences(self.system))
        for what in self.happens:
            if isinstance(what.activity, Trigger):
                causes = self.triggers.setdefault(what.activity.stimulus, [])
                causes.append(Cause(what.process, what.times, what.activity.counter))

    def arrivals(self, process: Process, responses: Mapping[str, Response], above: tuple[str, ...] = ()) -> Arrivals:
        """The event model of a process.

        Raises
        ------
        UnknownArrivalsError : it is never activated, or nothing bounds how often.
        """
        if process.name in above:
            raise UnknownArrivalsError(f"it is triggered in a circle: {' -> '.join((*above, process.name))}")
        found = [self._of(name, responses, (*above, process.name)) for name in process.stimuli]
        if not found:
            raise UnknownArrivalsError("it has no stimulus, so that nothing activates it")
        return found[0] if len(found) == 1 else Together(tuple(found))

    def _of(self, name: str, responses: Mapping[str, Response], above: tuple[str, ...]) -> Arrivals:
        stimulus = self.system.stimuli_by_name.get(name)
        if stimulus is None:
            raise UnknownArrivalsError(f"the stimulus {name!r} is not part of the model")
        if not isinstance(stimulus, InterProcess | EventTriggered):
            arrivals = arrivals_of(stimulus, self.system)
            if arrivals is None:
                raise UnknownArrivalsError(f"nothing bounds how often {name!r} occurs")
            return arrivals
        is_triggered = isinstance(stimulus, InterProcess)
        causes = self.triggers.get(name, []) if is_triggered else self._causes(stimulus)  # type: ignore[arg-type]
        if not causes:
            raise UnknownArrivalsError(f"nothing triggers {name!r}")
        sources = [self._behind(cause, responses, above) for cause in causes]
        together = sources[0] if len(sources) == 1 else Together(tuple(sources))
        return _counted(together, stimulus.counter)

    def _causes(self, stimulus: EventTriggered) -> list[Cause]:
        """The processes in which the events of a stimulus occur."""
        found: list[Cause] = []
        for name in stimulus.events:
            event = self.system.events_by_name.get(name)
            if event is None:
                raise UnknownArrivalsError(f"the event {name!r} is not part of the model")
            self._check(event)
            causes = [Cause(what.process, what.times, None) for what in self.happens if raises(what, event)]
            if not causes and isinstance(event, CustomEvent):
                raise UnknownArrivalsError(f"nothing in the model raises the event {name!r}")
            found += causes
        return found

    def _check(self, event: Event) -> None:
        """Refuse events that may occur otherwise than by what processes execute."""
        if isinstance(event, RunnableEvent) and event.change not in (RunnableChange.START, RunnableChange.TERMINATE):
            raise UnknownArrivalsError(f"nothing bounds how often the event {event.name!r} occurs")
        if isinstance(event, ModeLabelEvent):
            assigned = {mode.label for stimulus in self.system.stimuli.stimuli for mode in stimulus.assignments}
            if event.label is None or event.label in assigned:
                raise UnknownArrivalsError(f"stimuli raise the event {event.name!r}, too")

    def _behind(self, cause: Cause, responses: Mapping[str, Response], above: tuple[str, ...]) -> Arrivals:
        """The arrivals that a process causes somewhere between its start and its end."""
        process = cause.process
        if process.name in self.unknown:
            raise UnknownArrivalsError(f"too little is known of {process.name!r}, which triggers it")
        found = self.arrivals(process, responses, above)
        response = responses.get(process.name)
        if response is not None:
            if response.worst is None:
                raise UnknownArrivalsError(f"{process.name!r}, which triggers it, has no bounded response time")
            found = behind(found, response, self.least_costs.get(process.name, 0))
        return _counted(found if cause.times == 1 else Repeated(found, cause.times), cause.counter)


def behind(arrivals: Arrivals, response: Response, least_cost: Time) -> Arrivals:
    """The ends of the jobs of a task as arrivals; each of them costs something at least."""
    if response.completions:
        return Behind(arrivals, response.completions, least_cost)
    return Delayed(arrivals, (response.worst or 0) - least_cost)


def _counted(arrivals: Arrivals, counter: Counter | None) -> Arrivals:
    return Every(arrivals, counter.prescaler) if counter is not None and counter.prescaler > 1 else arrivals
