"""The activations of processes: by external stimuli, and by triggers and events of other processes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias

from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.events import CustomEvent, Event, ModeLabelEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.network import Purpose
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess, Stimulus
from amalthea_uros.perf.system import System
from amalthea_uros.timing.dataflow.events import UnresolvedError
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.timing.event_models import Delayed, Downsampled, EventModel, Multiplied, aggregated, thinned
from amalthea_uros.timing.event_models.stimuli import event_model_of


class UnknownActivationError(Exception):
    """The activation pattern of a process is unknown or unbounded; the text says why."""


#: The event model of the completions of a process, given a function that computes that of its activations.
Output: TypeAlias = Callable[[Process, Callable[[], EventModel]], EventModel]


def as_activated(_process: Process, activations: Callable[[], EventModel]) -> EventModel:
    """The output of processes without execution time; its rate is right."""
    return activations()


class Cause(NamedTuple):
    """A process that triggers a stimulus.

    Attributes
    ----------
    times : how often in a job at most; None if that is unknown
    counter : if only every n-th time counts
    jobs : if only every n-th job reaches it
    """

    process: Process
    times: int | None
    counter: Counter | None
    jobs: Counter | None


@dataclass(slots=True)
class Activations:
    """The event models of the activations of all processes."""

    system: System
    dataflow: Dataflow
    _incomplete: str = ""
    _triggers: dict[str, list[Cause]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not any(isinstance(stimulus, InterProcess | EventTriggered) for stimulus in self.system.stimuli.stimuli):
            return
        for name in self.system.processes:
            try:
                positions = self.dataflow.events.positions(name)
            except UnresolvedError as error:
                self._incomplete = str(error)
                continue
            for position in positions:
                if isinstance(position.activity, Trigger) and position.times != 0:
                    causes = self._triggers.setdefault(position.activity.stimulus, [])
                    causes.append(Cause(position.process, position.times, position.activity.counter, position.counter))

    def of(self, process: Process, output: Output = as_activated) -> EventModel:
        """The event model of the activations of a process.

        Parameters
        ----------
        output : gives the completions of processes

        Raises
        ------
        UnknownActivationError : it is never activated, or its activations are unbounded.
        """
        return self._of_process(process, output, ())

    def _of_process(self, process: Process, output: Output, above: tuple[str, ...]) -> EventModel:
        if process.name in above:
            raise UnknownActivationError(f"it is triggered in a cycle: {' -> '.join((*above, process.name))}")
        found = tuple(self._of_stimulus(name, output, (*above, process.name)) for name in process.stimuli)
        if not found:
            raise UnknownActivationError(self._why_never(process))
        return self._answered(process, aggregated(found))

    def _why_never(self, process: Process) -> str:
        """Why a process has no stimulus."""
        transmission = self.system.transmissions.get(process.name)
        if transmission is None or transmission.purpose is not Purpose.DATA or transmission.agent.most is not None:
            return "it has no stimulus"
        agent = self.system.network.agent
        return f"how much later {agent!r} sends one message than another is not stated: 'middleware.agent.to_controller'"

    def _answered(self, process: Process, messages: EventModel) -> EventModel:
        """The activations of an acknowledgement: the receiver of the message sends it some time later."""
        transmission = self.system.transmissions.get(process.name)
        if transmission is None or transmission.purpose is not Purpose.ACKNOWLEDGEMENT:
            return messages
        answer = transmission.agent
        if answer.most is None:
            raise UnknownActivationError(f"how long {self.system.network.agent!r} takes to acknowledge a message is not stated")
        return Delayed(messages, answer.most - answer.least) if answer.most > answer.least else messages

    def _of_stimulus(self, name: str, output: Output, above: tuple[str, ...]) -> EventModel:
        stimulus = self.system.stimuli_by_name.get(name)
        if stimulus is None:
            raise UnknownActivationError(f"the stimulus {name!r} is not defined in the model")
        found = self._occurrences(stimulus, output, above)
        return found if stimulus.condition is None else thinned(found)

    def _occurrences(self, stimulus: Stimulus, output: Output, above: tuple[str, ...]) -> EventModel:
        """The occurrences of a stimulus, as if its condition were always true."""
        name = stimulus.name
        if not isinstance(stimulus, InterProcess | EventTriggered):
            found = event_model_of(stimulus, self.system)
            if found is None:
                raise UnknownActivationError(f"the rate of the stimulus {name!r} is unbounded")
            return found
        if self._incomplete:
            raise UnknownActivationError(f"the processes that trigger {name!r} are unknown: {self._incomplete}")
        causes = self._triggers.get(name, []) if isinstance(stimulus, InterProcess) else self.causes(stimulus)
        if not causes:
            raise UnknownActivationError(f"no process triggers {name!r}")
        return _counted(aggregated(tuple(self._caused_by(cause, output, above) for cause in causes)), stimulus.counter)

    def causes(self, stimulus: EventTriggered) -> list[Cause]:
        """The processes in which the events of a stimulus occur.

        Raises
        ------
        UnknownActivationError : they can occur otherwise, too, or it is unknown where.
        """
        found: list[Cause] = []
        for name in stimulus.events:
            event = self.system.events_by_name.get(name)
            if event is None:
                raise UnknownActivationError(f"the event {name!r} is not defined in the model")
            self._check(event)
            causes = [Cause(p.process, p.times, None, p.counter) for p in self.dataflow.events.raising(event) if p.times != 0]
            if not causes and isinstance(event, CustomEvent):
                raise UnknownActivationError(f"no activity in the model raises the event {name!r}")
            found += causes
        return found

    def _check(self, event: Event) -> None:
        """Refuse events that have other causes than activities of processes."""
        if isinstance(event, RunnableEvent) and event.change not in (RunnableChange.START, RunnableChange.TERMINATE):
            raise UnknownActivationError(f"the rate of the event {event.name!r} is unbounded")
        if isinstance(event, ModeLabelEvent):
            assigned = {mode.label for stimulus in self.system.stimuli.stimuli for mode in stimulus.assignments}
            if event.label is None or event.label in assigned:
                raise UnknownActivationError(f"stimuli also raise the event {event.name!r}")

    def _caused_by(self, cause: Cause, output: Output, above: tuple[str, ...]) -> EventModel:
        """The events that a process causes between its start and its end."""
        if cause.times is None:
            raise UnknownActivationError(
                f"the maximum number of times that a job of {cause.process.name!r} triggers it is unknown"
            )
        found = _counted(output(cause.process, lambda: self._of_process(cause.process, output, above)), cause.jobs)
        return _counted(found if cause.times == 1 else Multiplied(found, cause.times), cause.counter)


def _counted(events: EventModel, counter: Counter | None) -> EventModel:
    return Downsampled(events, counter.prescaler) if counter is not None and counter.prescaler > 1 else events
