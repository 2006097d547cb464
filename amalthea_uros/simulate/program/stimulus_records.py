"""Stimuli as records, the occurrences of those that come from outside, and queues of messages with arrivals of their own."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros._internal.limits import SIMULATED_OCCURRENCES
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.events import StimulusEvent
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Arrivals, Counter, EventTriggered, InterProcess, Periodic, Stimulus
from amalthea_uros.simulate.arrivals import StimulusOccurrences, least_count, occurrences
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.kernel.layout import FIRE, TAKE_MESSAGE
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.program.chains import ChainCompiler
from amalthea_uros.simulate.program.image import ProgramHooks
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.program.watches import EventSource
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.timing.activation.releases import known_releases, nominal_period, own_counters
from amalthea_uros.timing.jobs.counters import first_effect
from amalthea_uros.trace.table import EntityKind
from amalthea_uros.units import Time, time_text


@dataclass(slots=True)
class StimulusRecords:
    """The records of stimuli.

    Attributes
    ----------
    left_out : why a process is not simulated
    """

    resources: Resources
    left_out: dict[str, str]

    def place(self) -> list[tuple[int, StimulusOccurrences]]:
        """Fill the records; those of stimuli that come from outside, and when they occur."""
        system = self.resources.context.system
        activated: dict[str, list[str]] = {}
        for name in self.resources.processes:
            for stimulus_name in system.processes[name].stimuli:
                activated.setdefault(stimulus_name, []).append(name)
        order = {name: number for number, name in enumerate(self.resources.processes)}
        external: list[tuple[int, int, StimulusOccurrences]] = []
        for name, record in self.resources.stimuli.items():
            stimulus, targets = system.stimuli_by_name[name], activated.get(name, [])
            try:
                if flaw := self.resources.context.activations.flaws.of_stimulus(name):
                    number = self.resources.entities.number(EntityKind.STIMULUS, name)
                    self.resources.image.put(record, {layout.STIMULUS_ENTITY: number})
                    raise UnknownError(flaw)
                self._stimulus(stimulus, record, targets)
                if isinstance(stimulus, EventTriggered) and not self.resources.context.activations.causes(stimulus):
                    raise UnknownError(f"no activity in the model raises an event of the stimulus {name!r}")
                is_internal = isinstance(stimulus, InterProcess | EventTriggered)
                is_internal = is_internal or name in self.resources.executors.messages.from_host
                if name in self.resources.executors.messages.brought:
                    line, stimulus = self.resources.executors.messages.brought[name]
                    self.resources.image.put(record, {layout.BRINGS: line})
                is_watched = self.resources.image.words[record + layout.STIMULUS_SOURCE] > 0
                if not is_internal and (targets or stimulus.assignments or is_watched):
                    first = min((order[target] for target in targets), default=len(order))
                    external.append((first, record, self._occurrences(stimulus)))
            except UnknownError as error:
                for target in targets:
                    self.left_out[target] = str(error)
        # Of simultaneous activations, that of the process comes first that is the first one of the model.
        external.sort(key=lambda entry: entry[0])
        return [(record, found) for _, record, found in external]

    def _occurrences(self, stimulus: Stimulus) -> StimulusOccurrences:
        options, context = self.resources.options, self.resources.context
        if (count := least_count(stimulus, options.duration)) > SIMULATED_OCCURRENCES:
            raise UnknownError(
                f"{stimulus.name!r} occurs {count:,} times in {time_text(options.duration)}; at most {SIMULATED_OCCURRENCES:,} "
                "occurrences of a stimulus are simulated"
            )
        source = RandomSource(options.seed, f"stimulus {stimulus.name}")
        found = occurrences(stimulus, context.system, options.mode, source, self.resources.units)
        for sentence in found.assumptions:
            context.notes.assume(sentence)
        return found

    def _stimulus(self, stimulus: Stimulus, record: int, targets: Sequence[str]) -> None:
        first, end = self.resources.image.items(self.resources.processes[target] for target in targets)
        pairs: list[int] = []
        for assignment in stimulus.assignments:
            pairs += (
                self.resources.modes.label(assignment.label),
                self.resources.modes.value(assignment.label, assignment.value),
            )
        assignments, assignments_end = self.resources.image.items(pairs)
        counter = stimulus.counter if isinstance(stimulus, InterProcess | EventTriggered) else None
        source = self.resources.watches.number(EventSource(StimulusEvent, stimulus.name))
        fields = {
            layout.TARGETS: first,
            layout.TARGETS_END: end,
            layout.CONDITION: self.resources.modes.condition(stimulus.condition) if stimulus.condition is not None else 0,
            layout.COUNTER: self.resources.counter(stimulus, counter),
            layout.ASSIGNMENTS: assignments,
            layout.ASSIGNMENTS_END: assignments_end,
            layout.STIMULUS_ENTITY: self.resources.entities.number(EntityKind.STIMULUS, stimulus.name),
            layout.STIMULUS_SOURCE: 0 if source is None else source + 1,
        }
        self.resources.image.put(record, fields)


def hook_firings(resources: Resources, chains: ChainCompiler) -> None:
    """Have events fire the stimuli that they activate; triggers fire theirs by themselves."""
    context = resources.context
    if not any(isinstance(stimulus, EventTriggered) for stimulus in context.system.stimuli.stimuli):
        return
    for name in resources.processes:
        hooks = chains.hooks.setdefault(name, ProgramHooks())
        for firing in context.dataflow.firings(name):
            if not isinstance(firing.position.activity, Trigger):
                side = hooks.before if firing.is_before else hooks.after
                side.setdefault(firing.position.number, []).append((FIRE, resources.stimuli[firing.stimulus], 0))


# Messages with arrivals of their own: what arrives before the activation of a job waits in a queue until the job takes it.


#: Messages that can wait: `RMW_UXRCE_MAX_HISTORY` of rmw_microxrcedds by default; further ones are dropped (`src/callbacks.c`).
QUEUE_LENGTH = 8


@dataclass(slots=True)
class Messages:
    """The queues of messages with arrivals of their own.

    Attributes
    ----------
    arrivals : the record of the stimulus of each queue, and its occurrences
    """

    resources: Resources
    chains: ChainCompiler
    arrivals: list[tuple[int, StimulusOccurrences]] = field(default_factory=list)

    def add(self, process: Process) -> None:
        """Place the queues of a process, and have its jobs take messages at their start.

        Raises
        ------
        UnknownError : it is unknown when the messages arrive.
        """
        found = {counter.source: counter for counter in own_counters(process) if counter.arrivals is not None}
        for source, counter in found.items():
            queue = self._queue(process, source)
            stimulus = self.resources.image.record(
                layout.STIMULUS_SIZE,
                {layout.MESSAGES: queue, layout.STIMULUS_ENTITY: self.resources.entities.number(EntityKind.STIMULUS, source)},
            )
            self.resources.queues[process.name, source] = queue
            self.arrivals.append((stimulus, self._occurrences(process, counter)))

    def _queue(self, process: Process, source: str) -> int:
        captures = self.chains.captures.setdefault(process.name, [])
        fields = {layout.MESSAGE_LIMIT: QUEUE_LENGTH, layout.MESSAGE_CAPTURE: len(captures)}
        queue = self.resources.image.record(layout.MESSAGE_SIZE, fields)
        captures.append(queue + layout.ARRIVED)
        self.chains.hooks.setdefault(process.name, ProgramHooks()).start.append((TAKE_MESSAGE, queue, 0))
        return queue

    def _occurrences(self, process: Process, counter: Counter) -> StimulusOccurrences:
        system, options, arrivals = self.resources.context.system, self.resources.options, counter.arrivals or Arrivals()
        period = nominal_period(process, counter, system)
        if period is None:
            raise UnknownError(f"it takes {counter.source!r}, of which the period is unknown")
        stimulus = Periodic(
            name=counter.source,
            period=period,
            offset=self._phase(process, counter, period),
            jitter=Uniform(lower=0, upper=arrivals.jitter) if arrivals.jitter else None,
        )
        source = RandomSource(options.seed, f"arrivals of {counter.source}")
        try:
            return occurrences(stimulus, system, options.mode, source, self.resources.units)
        except UnknownError as error:
            raise UnknownError(f"it takes {counter.source!r}: {error}") from None

    def _phase(self, process: Process, counter: Counter, period: Time) -> Time:
        """The nominal time of the first arrival: as stated, or any time at random."""
        resources = self.resources
        if counter.source in resources.options.settings.phases:
            return resources.options.settings.phases[counter.source]
        releases = known_releases(process, resources.context.system)
        first = 0 if releases is None else releases.offset
        if counter.is_phase_known and releases is not None:
            return first + (first_effect(counter) - 1) * releases.period
        resources.assume_phase()
        return (
            first
            if resources.options.mode is not SimulationMode.SAMPLED
            else resources.random_phase(counter.source) * period >> 64
        )
