"""What activates processes: stimuli from outside, and other processes by triggers and events."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias

from amalthea_uros.perf.events import CustomEvent, Event, ModeLabelEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.software import Process, Trigger
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.events import UnresolvedError, raises
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.timing.dataflow.positions import ActivityPosition
from amalthea_uros.timing.event_models import Downsampled, EventModel, Multiplied, aggregated
from amalthea_uros.timing.event_models.stimuli import event_model_of


class UnknownActivationError(Exception):
    """There is no bound on how often a process is activated; the text says why."""


#: The events at the completions of a process, given what computes the model of its activations.
Output: TypeAlias = Callable[[Process, Callable[[], EventModel]], EventModel]


def as_activated(_process: Process, activations: Callable[[], EventModel]) -> EventModel:
    """The output of processes that take no time; it has the right rate."""
    return activations()


class Cause(NamedTuple):
    """A process that causes something, how often in a job, and whether only every n-th time."""

    process: Process
    times: int
    counter: Counter | None


@dataclass(slots=True)
class Activations:
    """The event models of the activations of all processes."""

    system: System
    dataflow: Dataflow
    _positions: list[ActivityPosition] = field(default_factory=list)
    _unfollowed: str = ""
    _triggers: dict[str, list[Cause]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name in self.system.processes:
            try:
                self._positions += [position for position in self.dataflow.events.positions(name) if position.times > 0]
            except UnresolvedError as error:
                self._unfollowed = str(error)
        for position in self._positions:
            if isinstance(position.activity, Trigger):
                causes = self._triggers.setdefault(position.activity.stimulus, [])
                causes.append(Cause(position.process, position.times, position.activity.counter))

    def of(self, process: Process, output: Output = as_activated) -> EventModel:
        """The event model of the activations of a process.

        Parameters
        ----------
        output : the events that processes cause

        Raises
        ------
        UnknownActivationError : it is never activated, or there is no bound on how often.
        """
        return self._of_process(process, output, ())

    def _of_process(self, process: Process, output: Output, above: tuple[str, ...]) -> EventModel:
        if process.name in above:
            raise UnknownActivationError(f"it is triggered in a circle: {' -> '.join((*above, process.name))}")
        found = tuple(self._of_stimulus(name, output, (*above, process.name)) for name in process.stimuli)
        if not found:
            raise UnknownActivationError("it has no stimulus, so that nothing activates it")
        return aggregated(found)

    def _of_stimulus(self, name: str, output: Output, above: tuple[str, ...]) -> EventModel:
        stimulus = self.system.stimuli_by_name.get(name)
        if stimulus is None:
            raise UnknownActivationError(f"the stimulus {name!r} is not part of the model")
        if not isinstance(stimulus, InterProcess | EventTriggered):
            found = event_model_of(stimulus, self.system)
            if found is None:
                raise UnknownActivationError(f"nothing bounds how often {name!r} occurs")
            return found
        if self._unfollowed:
            raise UnknownActivationError(f"what triggers {name!r} is unknown: {self._unfollowed}")
        causes = self._triggers.get(name, []) if isinstance(stimulus, InterProcess) else self._causes(stimulus)
        if not causes:
            raise UnknownActivationError(f"nothing triggers {name!r}")
        return _counted(aggregated(tuple(self._caused_by(cause, output, above) for cause in causes)), stimulus.counter)

    def _causes(self, stimulus: EventTriggered) -> list[Cause]:
        """The processes in which the events of a stimulus occur."""
        found: list[Cause] = []
        for name in stimulus.events:
            event = self.system.events_by_name.get(name)
            if event is None:
                raise UnknownActivationError(f"the event {name!r} is not part of the model")
            self._check(event)
            causes = [Cause(p.process, p.times, None) for p in self._positions if raises(p, event)]
            if not causes and isinstance(event, CustomEvent):
                raise UnknownActivationError(f"nothing in the model raises the event {name!r}")
            found += causes
        return found

    def _check(self, event: Event) -> None:
        """Refuse events that may occur otherwise than by what processes execute."""
        if isinstance(event, RunnableEvent) and event.change not in (RunnableChange.START, RunnableChange.TERMINATE):
            raise UnknownActivationError(f"nothing bounds how often the event {event.name!r} occurs")
        if isinstance(event, ModeLabelEvent):
            assigned = {mode.label for stimulus in self.system.stimuli.stimuli for mode in stimulus.assignments}
            if event.label is None or event.label in assigned:
                raise UnknownActivationError(f"stimuli raise the event {event.name!r}, too")

    def _caused_by(self, cause: Cause, output: Output, above: tuple[str, ...]) -> EventModel:
        """The events that a process causes somewhere between its start and its end."""
        found = output(cause.process, lambda: self._of_process(cause.process, output, above))
        return _counted(found if cause.times == 1 else Multiplied(found, cause.times), cause.counter)


def _counted(events: EventModel, counter: Counter | None) -> EventModel:
    return Downsampled(events, counter.prescaler) if counter is not None and counter.prescaler > 1 else events
