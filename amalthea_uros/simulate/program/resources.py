"""What programs refer to: records, streams, counters, and the numbers of entities in a trace."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import ClearEvent, ServerCall, SetEvent, WaitEvent, Waiting, walk
from amalthea_uros.perf.distributions import Distribution, Statistics
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.program.entities import EntityNumbers
from amalthea_uros.simulate.program.image import Image
from amalthea_uros.simulate.program.modes import ModeRecords
from amalthea_uros.simulate.program.watches import Watches
from amalthea_uros.simulate.sampling.streams import ValueStream, choices, durations, permutations, values
from amalthea_uros.simulate.sampling.variates import sampling_assumption
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.multiframe import DemandFrame
from amalthea_uros.timing.jobs.counters import first_effect
from amalthea_uros.timing.jobs.executed import servers
from amalthea_uros.trace.table import EntityKind
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.simulate.program.executors import ExecutorRecords


@dataclass(slots=True)
class Resources:
    """What the programs of all processes refer to, each thing once.

    Attributes
    ----------
    watches : what is observed apart from jobs and chains
    units : time units per picosecond
    processes, stimuli : their records
    queues : of messages with arrivals of their own, by process and source
    streams : in the order of their numbers
    executing : the processes that execute each runnable
    """

    context: TimingContext
    options: Options
    image: Image
    watches: Watches
    units: int
    entities: EntityNumbers = field(init=False)
    modes: ModeRecords = field(init=False)
    executors: ExecutorRecords = field(init=False)
    processes: dict[str, int] = field(default_factory=dict)
    stimuli: dict[str, int] = field(default_factory=dict)
    queues: dict[tuple[str, str], int] = field(default_factory=dict)
    streams: list[ValueStream] = field(default_factory=list)
    stream_records: list[int] = field(default_factory=list)
    semaphores: dict[str, int] = field(default_factory=dict)
    os_events: dict[str, int] = field(default_factory=dict)
    services: dict[str, int] = field(default_factory=dict)
    executing: Mapping[str, tuple[str, ...]] = field(init=False)
    _counters: dict[int, int] = field(default_factory=dict)
    _phases: dict[str, int] = field(default_factory=dict)
    _runnables: dict[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        system = self.context.system
        self.entities = EntityNumbers(system)
        for number, semaphore in enumerate(system.os.semaphores):
            fields = {
                layout.USED: semaphore.initial_users,
                layout.USERS: semaphore.users,
                layout.CEILING: -1,
                layout.DEADLINE_CEILING: layout.NEVER,
                layout.HAS_OWNER: int(semaphore.ownership),
                layout.SEMAPHORE_NUMBER: number,
                layout.SEMAPHORE_ENTITY: self.entities.number(EntityKind.SEMAPHORE, semaphore.name),
            }
            self.semaphores[semaphore.name] = self.image.record(layout.SEMAPHORE_SIZE, fields)
        self.os_events = {event.name: number for number, event in enumerate(system.software.os_events)}
        everything = (activity for body in system.software.bodies for activity in walk(body))
        asked = {activity.runnable: None for activity in everything if isinstance(activity, ServerCall) and activity.waits}
        self.executing = servers(system)
        for number, name in enumerate(asked):
            self.services[name] = self.image.record(layout.SERVICE_SIZE, {layout.SERVICE_NUMBER: number})

    @property
    def is_noted(self) -> bool:
        """Whether events of runnables and labels are recorded."""
        return self.options.traced is not None

    # Times.

    def time(self, time: Time) -> int:
        """A time in time units; one that is too long never comes."""
        return min(time * self.units, layout.NEVER)

    def ticks(self, ticks: Distribution[int], core: str, factor: Fraction, place: str) -> ValueStream:
        """The times that ticks, or units that take `factor` ticks each, take on a core."""
        settings, model = self.context.settings, self.context.demand_model
        tick = model.time_of_tick(settings.scale * settings.growth * factor, core) * Fraction(self.units, model.time_base(core))
        return self._durations(ticks, tick, place)

    def frame(self, frame: DemandFrame, core: str, place: str) -> ValueStream:
        """The times of something of which minimum, mean and maximum are known, in the time base of a core."""
        unit = Fraction(self.units, self.context.demand_model.time_base(core))
        average = min(max(float(frame.average), frame.best), frame.worst)
        return self._durations(Statistics(lower=frame.best, average=average, upper=frame.worst), unit, place)

    def _durations(self, ticks: Distribution[int], unit: Fraction, place: str) -> ValueStream:
        if self.options.mode is SimulationMode.SAMPLED and (sentence := sampling_assumption(ticks)):
            self.context.notes.assume(sentence)
        return durations(ticks, unit, self.options.mode, self._source(place))

    # Choices.

    def count(self, distribution: Distribution[int], place: str) -> int:
        """The record of a stream of numbers of passes."""
        return self.stream(values(distribution, self.options.mode, self._source(place)))

    def choice(self, weights: Sequence[float], place: str) -> int:
        """The record of a stream of branches."""
        equal = weights if any(weights) else [1.0] * len(weights)
        return self.stream(choices(equal, SimulationMode.SAMPLED, self._source(place)))

    def order(self, place: str) -> int:
        """The record of a stream of orders."""
        return self.stream(permutations(self._source(place)))

    def stream(self, stream: ValueStream) -> int:
        """The record of a stream."""
        self.stream_records.append(self.image.record(layout.STREAM_SIZE, {layout.STREAM_NUMBER: len(self.streams)}))
        self.streams.append(stream)
        return self.stream_records[-1]

    def _source(self, place: str) -> RandomSource:
        return RandomSource(self.options.seed, place)

    def site(self, runnable: str) -> int:
        """The record of a place that executes a runnable, for the numbers of its executions."""
        if runnable not in self._runnables:
            entity = self.entities.number(EntityKind.RUNNABLE, runnable)
            self._runnables[runnable] = self.image.record(layout.RUNNABLE_SIZE, {layout.RUNNABLE_ENTITY: entity})
        return self.image.record(layout.SITE_SIZE, {layout.EXECUTED: self._runnables[runnable]})

    # Counters.

    def counter(self, owner: object, counter: Counter | None) -> int:
        """The record of the counter of an element of the model, which all that pass the element share; 0: every time counts."""
        if counter is None:
            return 0
        if id(owner) not in self._counters:
            first = first_effect(counter) if counter.is_phase_known else self._phase(counter)
            fields = {layout.EVERY: counter.prescaler, layout.FIRST_EFFECT: first}
            self._counters[id(owner)] = self.image.record(layout.COUNTER_SIZE, fields)
        return self._counters[id(owner)]

    def _phase(self, counter: Counter) -> int:
        """The occurrence that takes effect first, where nobody has stated it: any, drawn at random; not sampled, the first one."""
        self.assume_phase()
        return (
            1 if self.options.mode is not SimulationMode.SAMPLED else self.random_phase(counter.source) % counter.prescaler + 1
        )

    def assume_phase(self) -> None:
        """Note what is assumed about the phase of what comes from outside."""
        how = (
            "has one at random, which the seed decides"
            if self.options.mode is SimulationMode.SAMPLED
            else "comes at its first possibility"
        )
        self.context.notes.assume(f"what comes from outside with an unknown phase {how}")

    def random_phase(self, source: str) -> int:
        """A random number of 64 bits that stands for the phase of something from outside, the same for all that take it."""
        place = f"phase of {source}"
        if place not in self._phases:
            self._phases[place] = int(self._source(place).words(1)[0])
        return self._phases[place]

    # Events of the operating system.

    def event_row(self, activity: SetEvent | ClearEvent | WaitEvent) -> int:
        """The record of the events that an activity sets, clears or waits for."""
        pairs: list[int] = []
        for name in activity.events:
            if name not in self.os_events:
                raise UnknownError(f"the OS event {name!r} is not defined in the model")
            pairs += (self.os_events[name], self.entities.number(EntityKind.OS_EVENT, name))
        first, end = self.image.items(pairs)
        fields = {layout.EVENT_LIST: first, layout.EVENT_LIST_END: end}
        match activity:
            case SetEvent(process=process) if process is not None:
                if process not in self.processes:
                    raise UnknownError(f"it sets events of {process!r}, which is not simulated")
                fields[layout.OF_PROCESS] = self.processes[process]
            case WaitEvent(all_of_them=all_of_them, waiting=waiting):
                fields |= {layout.NEEDS_ALL: int(all_of_them), layout.IS_ACTIVE_WAIT: int(waiting is Waiting.ACTIVE)}
        return self.image.record(layout.EVENT_ROW_SIZE, fields)
