"""The activations of processes: by external stimuli, and by triggers and events of other processes.

Processes that a job triggers on paths that exclude each other take together as long as the longest path.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from fractions import Fraction
from itertools import chain, groupby
from operator import attrgetter
from typing import NamedTuple, TypeAlias

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.events import CustomEvent, Event, ModeLabelEvent, RunnableChange, RunnableEvent
from amalthea_uros.perf.network import Direction, Purpose, Transmission
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Counter, Custom, EventTriggered, InterProcess, Stimulus
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.relays import comes_regularly
from amalthea_uros.timing.dataflow.links import Dataflow
from amalthea_uros.timing.demand.job_paths import most_in_a_job
from amalthea_uros.timing.event_models.derived import Delayed, Downsampled, Multiplied, aggregated, thinned
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents, SporadicEvents
from amalthea_uros.timing.event_models.stimuli import event_model_of
from amalthea_uros.timing.jobs.counters import CounterFlaws, is_always
from amalthea_uros.timing.jobs.positions import ActivityPosition, is_in_fixed_order
from amalthea_uros.units import Time

#: The event model of the completions of a process, given a function that computes that of its activations, and whether the demand of
#: a job is always on the same side of the event.
Output: TypeAlias = Callable[[Process, Callable[[], EventModel], bool], EventModel]


def as_activated(_process: Process, activations: Callable[[], EventModel], _has_fixed_place: bool) -> EventModel:
    """The output of processes without execution time; its rate is right."""
    return activations()


class TriggeredStimulus(NamedTuple):
    """What an activity triggers.

    Attributes
    ----------
    share : of the times at which the activity is executed
    """

    position: ActivityPosition
    stimulus: str
    share: Fraction


class TriggeringActivity(NamedTuple):
    """A process that triggers a stimulus.

    Attributes
    ----------
    position : of the activity that triggers it
    counter : if only every n-th time counts
    """

    position: ActivityPosition
    counter: Counter | None = None

    @property
    def process(self) -> Process:
        """The process that triggers it."""
        return self.position.process

    @property
    def is_each_time(self) -> bool:
        """Whether each job that reaches the activity triggers it once, and no counter decides which jobs do."""
        jobs = self.position.counter
        return self.counter is None and self.position.times == 1 and jobs is not None and is_always(jobs)

    @property
    def has_fixed_place(self) -> bool:
        """Whether no unordered group around it lets parts of the job come before it or after it."""
        return is_in_fixed_order(self.position)


@dataclass(slots=True)
class Activations:
    """The event models of the activations of all processes."""

    system: System
    dataflow: Dataflow
    flaws: CounterFlaws = field(init=False)
    _incomplete: str = ""
    _triggers: dict[str, list[TriggeringActivity]] = field(default_factory=dict)
    _effects: dict[str, list[TriggeredStimulus]] | None = None
    _triggering: dict[str, dict[str, None]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.flaws = CounterFlaws(self.system)
        if not any(isinstance(stimulus, InterProcess | EventTriggered) for stimulus in self.system.stimuli.stimuli):
            return
        for name in self.system.processes:
            try:
                positions = self.dataflow.events.positions(name)
            except UnknownError as error:
                self._incomplete = str(error)
                continue
            for position in positions:
                if isinstance(position.activity, Trigger) and position.times != 0:
                    causes = self._triggers.setdefault(position.activity.stimulus, [])
                    causes.append(TriggeringActivity(position, position.activity.counter))

    def of(self, process: Process, output: Output = as_activated) -> EventModel:
        """The event model of the activations of a process.

        Parameters
        ----------
        output : gives the completions of processes

        Raises
        ------
        UnknownError : it is never activated, or its activations are unbounded.
        """
        return self._of_process(process, output, ())

    def _of_process(self, process: Process, output: Output, above: tuple[str, ...]) -> EventModel:
        if process.name in above:
            raise UnknownError(f"it is triggered in a cycle: {' -> '.join((*above, process.name))}")
        found = tuple(self._of_stimulus(name, output, (*above, process.name)) for name in process.stimuli)
        if not found:
            raise UnknownError(self._why_never(process))
        transmission = self.system.transmissions.get(process.name)
        events = aggregated(found)
        return events if transmission is None else self._answered(transmission, self._sent(transmission, events))

    def _why_never(self, process: Process) -> str:
        """Why a process has no stimulus."""
        transmission = self.system.transmissions.get(process.name)
        if transmission is None or transmission.purpose is not Purpose.DATA or transmission.agent.most is not None:
            return _why_inactive(process.name, self.dataflow)
        agent = self.system.network.agent
        return f"how much later {agent!r} sends one message than another is not stated: 'middleware.agent.to_controller'"

    def _sent(self, transmission: Transmission, messages: EventModel) -> EventModel:
        """The messages of a transmission: only those of which it is stated that the host publishes them regularly are not rarer."""
        if not isinstance(messages, PeriodicEvents) or isinstance(messages, SporadicEvents):
            return messages
        handles = (handle for executor in self.system.executors for handle in executor.handles)
        if any(handle.transmission == transmission.name and comes_regularly(handle, self.system) for handle in handles):
            return messages
        return SporadicEvents(messages.period, messages.jitter, messages.min_interarrival)

    def _answered(self, transmission: Transmission, messages: EventModel) -> EventModel:
        """The activations of an acknowledgement: the receiver of the message sends it some time later."""
        if transmission.purpose is not Purpose.ACKNOWLEDGEMENT:
            return messages
        answer = transmission.agent
        if answer.most is None:
            raise UnknownError(f"how long {self.system.network.agent!r} takes to acknowledge a message is not stated")
        return Delayed(messages, answer.most - answer.least) if answer.most > answer.least else messages

    def _of_stimulus(self, name: str, output: Output, above: tuple[str, ...]) -> EventModel:
        stimulus = self.system.stimuli_by_name.get(name)
        if stimulus is None:
            raise UnknownError(f"the stimulus {name!r} is not defined in the model")
        found = self._occurrences(stimulus, output, above)
        return found if stimulus.condition is None else thinned(found)

    def _occurrences(self, stimulus: Stimulus, output: Output, above: tuple[str, ...]) -> EventModel:
        """The occurrences of a stimulus, as if its condition were always true."""
        name = stimulus.name
        if not isinstance(stimulus, InterProcess | EventTriggered):
            stated = event_model_of(stimulus, self.system)
            if stated is None:
                why = stimulus.description if isinstance(stimulus, Custom) else ""
                raise UnknownError(f"the rate of the stimulus {name!r} is unbounded" + (f": {why}" if why else ""))
            return stated
        if self._incomplete:
            raise UnknownError(f"the processes that trigger {name!r} are unknown: {self._incomplete}")
        causes = self.causes(stimulus)
        if not causes:
            raise UnknownError(f"no process triggers {name!r}")
        if flaw := self.flaws.of_stimulus(name):
            raise UnknownError(flaw)
        process_of = attrgetter("position.process.name")
        by_process = groupby(sorted(causes, key=process_of), key=process_of)
        caused = (self._caused_by_process(list(group), output, above) for _, group in by_process)
        return _counted(aggregated(tuple(chain.from_iterable(caused))), stimulus.counter)

    def _caused_by_process(
        self, causes: Sequence[TriggeringActivity], output: Output, above: tuple[str, ...]
    ) -> Iterator[EventModel]:
        """The events that the activities of a process cause: those of one path of a job, if others exclude it."""
        if all(cause.is_each_time for cause in causes) and (most := self.most_in_a_job(causes)) < len(causes):
            events = self._caused_by(causes[0], output, above)
            yield events if most == 1 else Multiplied(events, most)
        else:
            yield from (self._caused_by(cause, output, above) for cause in causes)

    def most_in_a_job(self, causes: Sequence[TriggeringActivity]) -> int:
        """How many of some activities of a process a job can reach; each one reaches an activity once at most."""
        numbers = sorted(cause.position.number for cause in causes)
        positions = self.dataflow.events.positions(causes[0].process.name)
        return most_in_a_job(positions, dict.fromkeys(numbers, 1))

    def causes(self, stimulus: InterProcess | EventTriggered) -> list[TriggeringActivity]:
        """The activities that trigger a stimulus, or raise its events.

        Raises
        ------
        UnknownError : they can occur otherwise, too, or it is unknown where.
        """
        if isinstance(stimulus, InterProcess):
            return self._triggers.get(stimulus.name, [])
        found: list[TriggeringActivity] = []
        for name in stimulus.events:
            event = self.system.events_by_name.get(name)
            if event is None:
                raise UnknownError(f"the event {name!r} is not defined in the model")
            self._check(event)
            causes = [TriggeringActivity(position) for position in self.dataflow.events.raising(event) if position.times != 0]
            if not causes and isinstance(event, CustomEvent):
                raise UnknownError(f"no activity in the model raises the event {name!r}")
            found += causes
        return found

    def effects(self, process: str) -> Sequence[TriggeredStimulus]:
        """What the activities of a process trigger, in order, as far as it is known."""
        if self._effects is None:
            self._effects = {}
            for stimulus in self.system.stimuli.stimuli:
                if isinstance(stimulus, InterProcess | EventTriggered):
                    with suppress(UnknownError):
                        for cause in self.causes(stimulus):
                            self._triggering.setdefault(stimulus.name, {})[cause.process.name] = None
                            if self.flaws.of_stimulus(stimulus.name):
                                continue
                            share = _share(cause.counter) * _share(stimulus.counter)
                            self._effects.setdefault(cause.process.name, []).append(
                                TriggeredStimulus(cause.position, stimulus.name, share)
                            )
            for found in self._effects.values():
                found.sort(key=lambda effect: effect.position.number)
        return self._effects.get(process, ())

    def triggering(self, process: str) -> Iterator[str]:
        """The processes whose activities activate a process, as far as it is known."""
        self.effects(process)
        for stimulus in self.system.processes[process].stimuli:
            yield from self._triggering.get(stimulus, ())

    def activated(self, stimulus: str) -> Sequence[str]:
        """The processes that a stimulus activates."""
        return self.dataflow.activated.get(stimulus, ())

    def external_rate(self, process: Process) -> Fraction:
        """Maximum number of activations per picosecond that no process triggers, in the long run.

        Raises
        ------
        UnknownError : it is unbounded.
        """
        stimuli = [self.system.stimuli_by_name.get(name) for name in process.stimuli]
        names = [each.name for each in stimuli if each is not None and not isinstance(each, InterProcess | EventTriggered)]
        return sum((self._of_stimulus(name, as_activated, ()).rate for name in names), Fraction(0))

    def _check(self, event: Event) -> None:
        """Refuse events that have other causes than activities of processes."""
        if isinstance(event, RunnableEvent) and event.change not in (RunnableChange.START, RunnableChange.TERMINATE):
            raise UnknownError(f"the rate of the event {event.name!r} is unbounded")
        if isinstance(event, ModeLabelEvent):
            assigned = {mode.label for stimulus in self.system.stimuli.stimuli for mode in stimulus.assignments}
            if event.label is None or event.label in assigned:
                raise UnknownError(f"stimuli also raise the event {event.name!r}")

    def _caused_by(self, cause: TriggeringActivity, output: Output, above: tuple[str, ...]) -> EventModel:
        """The events that a process causes between its start and its end."""
        times = cause.position.times
        if times is None:
            raise UnknownError(f"the maximum number of times that a job of {cause.process.name!r} triggers it is unknown")
        completions = output(cause.process, lambda: self._of_process(cause.process, output, above), cause.has_fixed_place)
        found = _counted(self._on_its_way(cause.process.name, completions), cause.position.counter)
        return _counted(found if times == 1 else Multiplied(found, times), cause.counter)

    def _on_its_way(self, process: str, completions: EventModel) -> EventModel:
        """The completions of a message on its wire, delayed by the varying time that it then takes to where it goes."""
        transmission = self.system.transmissions.get(process)
        if transmission is None:
            return completions
        is_received = transmission.direction is Direction.TO_CONTROLLER
        spans = (transmission.link, self.system.in_driver(transmission)) if is_received else (transmission.link,)
        variations = [None if span.most is None else span.most - span.least for span in spans]
        if None in variations:
            raise UnknownError(f"how long {process!r} takes besides the wire is not stated")
        variation = sum(filter(None, variations))
        return Delayed(completions, variation) if variation else completions


def _share(counter: Counter | None) -> Fraction:
    return Fraction(1, 1 if counter is None else counter.prescaler)


def _counted(events: EventModel, counter: Counter | None) -> EventModel:
    return Downsampled(events, counter.prescaler) if counter is not None and counter.prescaler > 1 else events


@dataclass(frozen=True, slots=True)
class TriggeredTogether:
    """Processes of which each job of another process triggers some, each once at most, and nothing else triggers them.

    Attributes
    ----------
    cause : the process that triggers them
    numbers : by their names, those of the activities that do
    """

    cause: str
    numbers: Mapping[str, Sequence[int]]

    def longest(self, demands: Mapping[str, Time], activations: Activations, modes: Mapping[str, str]) -> Time:
        """What those that one job triggers demand together at most.

        Parameters
        ----------
        demands : of those that count
        """
        triggered: dict[int, Time] = {}
        for name, demand in demands.items():
            for number in self.numbers.get(name, ()):
                triggered[number] = triggered.get(number, 0) + demand
        positions = activations.dataflow.events.positions(self.cause)
        return most_in_a_job(positions, dict(sorted(triggered.items())), modes)


def triggered_together(activations: Activations) -> list[TriggeredTogether]:
    """All processes that others trigger in this way."""
    found: dict[str, dict[str, list[int]]] = {}
    system = activations.system
    for process in system.processes.values():
        stimulus = system.stimuli_by_name.get(process.stimuli[0]) if len(process.stimuli) == 1 else None
        if not isinstance(stimulus, InterProcess) or stimulus.counter is not None:
            continue
        causes = activations.causes(stimulus)
        triggering = {cause.process.name for cause in causes}
        if len(triggering) == 1 and all(cause.is_each_time for cause in causes) and activations.most_in_a_job(causes) == 1:
            numbers = [cause.position.number for cause in causes]
            found.setdefault(min(triggering), {})[process.name] = numbers
    return [TriggeredTogether(cause, numbers) for cause, numbers in found.items() if len(numbers) > 1]


class SpareStimulus(NamedTuple):
    """A stimulus that no process has.

    Attributes
    ----------
    is_triggered : whether a job triggers it
    """

    name: str
    is_triggered: bool


def spare_stimulus(process: str, dataflow: Dataflow) -> SpareStimulus | None:
    """The stimulus that a process without one may have been meant to have: one that is triggered, or one with its name."""
    system = dataflow.system
    unused = [each.name for each in system.stimuli.stimuli if each.name not in dataflow.activated]
    fired: set[str] = set()
    with suppress(UnknownError):
        fired = {firing.stimulus for each in system.processes for firing in dataflow.firings(each)}
    spare = min(unused, key=lambda name: (name not in fired, process not in name), default=None)
    return None if spare is None else SpareStimulus(spare, spare in fired)


def _why_inactive(process: str, dataflow: Dataflow) -> str:
    spare = spare_stimulus(process, dataflow)
    if spare is None:
        return "it has no stimulus"
    triggered = ", which is triggered," if spare.is_triggered else ""
    return f"it has no stimulus, and the stimulus {spare.name!r}{triggered} activates no process"
