"""Messages with arrivals of their own: what arrives before the activation of a job waits in a queue until the job takes it."""

from __future__ import annotations

from dataclasses import dataclass, field

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.stimuli import Arrivals, Counter, Periodic
from amalthea_uros.simulate.arrivals import StimulusOccurrences, occurrences
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.kernel.operations import TAKE_MESSAGE
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.program.chains import ChainCompiler
from amalthea_uros.simulate.program.image import ProgramHooks
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.timing.activation.releases import known_releases, nominal_period, own_counters
from amalthea_uros.timing.jobs.counters import first_effect
from amalthea_uros.trace.table import EntityKind
from amalthea_uros.units import Time

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
