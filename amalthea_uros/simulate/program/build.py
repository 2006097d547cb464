"""Everything together: a system as the memory of the kernel, its streams, and the stimuli that come from outside."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import lcm

from amalthea_uros.simulate.layout import (
    CORES,
    CORES_END,
    DOMAINS,
    DOMAINS_END,
    HAS_WRITES,
    PLACES,
    PROCESS_SIZE,
    PROCESSES,
    PROCESSES_END,
    SEMAPHORES,
    SEMAPHORES_END,
    SERVERS,
    SERVERS_END,
    STIMULUS_SIZE,
)
from amalthea_uros.simulate.operations import PUT
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.program.chains import ChainCompiler
from amalthea_uros.simulate.program.entities import Entities
from amalthea_uros.simulate.program.hardware import Hardware
from amalthea_uros.simulate.program.image import Image
from amalthea_uros.simulate.program.messages import Messages
from amalthea_uros.simulate.program.modes import Modes
from amalthea_uros.simulate.program.obstacles import NotSimulatedError
from amalthea_uros.simulate.program.parts import Parts
from amalthea_uros.simulate.program.process_records import PLACES_AT_FIRST, ProcessRecords
from amalthea_uros.simulate.program.program import Program
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.program.scheduling import Dispatching
from amalthea_uros.simulate.program.stimulus_records import StimulusRecords, hook_firings
from amalthea_uros.simulate.program.watches import Watches, watched
from amalthea_uros.timing.context import TimingContext

#: Sums of times must fit into 63 bits: the longest time of a run, in time units.
_LONGEST = 2**60


def build_program(context: TimingContext, options: Options) -> Program:
    """The program of a system; what cannot be simulated is left out of it, and said so there."""
    builder = _Builder(context, options)
    # A process that cannot be simulated changes what others, its chains and triggers do: begin again without it.
    while (found := builder.build()) is None:
        builder = _Builder(context, options, builder.left_out)
    return found


@dataclass(slots=True)
class _Builder:
    context: TimingContext
    options: Options
    left_out: dict[str, str] = field(default_factory=dict)
    image: Image = field(default_factory=Image)
    dispatching: Dispatching = field(init=False)
    resources: Resources = field(init=False)
    watches: Watches = field(init=False)

    def __post_init__(self) -> None:
        self.dispatching = Dispatching(self.context)
        self.left_out = self.dispatching.left_out | self.left_out
        processes = self.dispatching.processes
        self.dispatching.processes = {name: item for name, item in processes.items() if name not in self.left_out}
        self.resources = Resources(self.context, self.options, self.image, Entities(self.context.system), self._units())
        self.watches = Watches(watched(self.context.system, self.options.watched_labels(self.context.system)))

    def _units(self) -> int:
        """Time units per picosecond, so that each tick is a whole number of them, if such times are not too long."""
        system, model = self.context.system, self.context.demand_model
        found = lcm(*(model.time_base(core) for core in system.cores))
        if found * self.options.duration <= _LONGEST:
            return found
        self.context.notes.assume("execution times are rounded to picoseconds")
        return 1

    def build(self) -> Program | None:
        """The program; None if one more process has turned out to be impossible."""
        system, before = self.context.system, len(self.left_out)
        modes = Modes(system, self.image, self.context.settings.modes)
        processes = {name: self.image.record(PROCESS_SIZE) for name in self.dispatching.processes}
        stimuli = {name: self.image.record(STIMULUS_SIZE) for name in system.stimuli_by_name}
        runnables = self.watches.watched.runnables
        self.watches.measured = {name: len(processes) + number for number, name in enumerate(runnables)}
        chains = ChainCompiler(self.resources, processes)
        for chain in system.events.chains:
            chains.add(chain)
        messages = Messages(self.resources, chains)
        is_noted = self.options.traced is not None
        parts = Parts(self.resources, modes, processes, stimuli, messages.queues, is_noted, self.watches)
        hook_firings(parts, chains)
        hardware = Hardware(self.resources, self.dispatching)
        hardware.place_cores()
        hardware.place_servers(processes)
        records = ProcessRecords(parts, hardware, chains)
        for number, item in enumerate(self.dispatching.processes.values()):
            try:
                messages.add(item.scheduled.process)
                records.add(item, number)
            except NotSimulatedError as error:
                self.left_out[item.name] = str(error)
        arrivals = StimulusRecords(parts, self.left_out).place()
        if len(self.left_out) > before:
            return None
        records.place_members()
        records.place_ceilings()
        self._head(hardware, processes, chains)
        return Program(
            memory=self.image.words,
            units=self.resources.units,
            streams=self.resources.streams,
            stream_records=self.resources.stream_records,
            # What arrives at the time of an activation is there before it.
            arrivals=[*messages.arrivals, *arrivals],
            messages=messages.queues,
            processes=tuple(processes),
            records=processes,
            cores=hardware.cores,
            channels=modes.channels,
            queues=(*processes.values(), *records.decisions.values()),
            entities=self.resources.entities.all,
            routes=tuple(chains.routes),
            sources=tuple(self.watches.sources),
            runnables=runnables,
            left_out=self.left_out,
            chains_left_out=chains.left_out,
        )

    def _head(self, hardware: Hardware, processes: dict[str, int], chains: ChainCompiler) -> None:
        lists = {
            (CORES, CORES_END): hardware.cores.values(),
            (DOMAINS, DOMAINS_END): dict.fromkeys(hardware.domains.values()),
            (SERVERS, SERVERS_END): hardware.servers.values(),
            (PROCESSES, PROCESSES_END): processes.values(),
            (SEMAPHORES, SEMAPHORES_END): self.resources.semaphores.values(),
        }
        for (first, end), records in lists.items():
            places = self.image.items(records)
            self.image.put(0, dict(zip((first, end), places, strict=True)))
        has_writes = len(hardware.cores) > 1 and any(
            operation == PUT for hooks in chains.hooks.values() for operation, *_ in hooks.all()
        )
        self.image.put(0, {PLACES: PLACES_AT_FIRST, HAS_WRITES: int(has_writes)})
