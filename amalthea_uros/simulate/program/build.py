"""From a system to the memory of the kernel, its streams, and the stimuli that come from outside."""

from __future__ import annotations

from collections.abc import Sequence
from math import lcm

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.simulate.arrivals import StimulusOccurrences
from amalthea_uros.simulate.kernel import layout
from amalthea_uros.simulate.kernel.layout import PUT
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.program.chains import ChainCompiler, FollowedRoute
from amalthea_uros.simulate.program.executors import ExecutorRecords
from amalthea_uros.simulate.program.flows import FlowRecords
from amalthea_uros.simulate.program.host_system import depending
from amalthea_uros.simulate.program.image import Image
from amalthea_uros.simulate.program.messages import MessageRecords
from amalthea_uros.simulate.program.modes import ModeRecords
from amalthea_uros.simulate.program.process_records import PLACES_AT_FIRST, HardwareRecords, ProcessRecords
from amalthea_uros.simulate.program.resources import Resources
from amalthea_uros.simulate.program.scheduling import Dispatching
from amalthea_uros.simulate.program.stimulus_records import Messages, StimulusRecords, hook_firings
from amalthea_uros.simulate.program.watches import EventSource, Watches, watched
from amalthea_uros.simulate.sampling.streams import ValueStream
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.trace.table import Entity

#: Sums of times must fit into 63 bits: the longest time of a run, in time units.
_LONGEST = 2**60


def build_program(context: TimingContext, options: Options) -> KernelProgram:
    """The program of a system; what cannot be simulated is left out of it, and said so there."""
    builder = _ProgramBuilder(context, options)
    # A process that cannot be simulated changes what others, its chains and triggers do: begin again without it.
    while (found := builder.build()) is None:
        builder = _ProgramBuilder(context, options, builder.left_out)
    return found


@dataclass(slots=True)
class _ProgramBuilder:
    context: TimingContext
    options: Options
    left_out: dict[str, str] = field(default_factory=dict)
    image: Image = field(default_factory=Image)
    dispatching: Dispatching = field(init=False)
    resources: Resources = field(init=False)

    def __post_init__(self) -> None:
        self.dispatching = Dispatching(self.context)
        self.left_out = self.dispatching.left_out | self.left_out
        self.left_out |= depending(self.context.system, self.left_out)
        processes = self.dispatching.processes
        self.dispatching.processes = {name: item for name, item in processes.items() if name not in self.left_out}
        watches = Watches(watched(self.context.system, self.options.watched_labels(self.context.system)))
        self.resources = Resources(self.context, self.options, self.image, watches, self._units())

    def _units(self) -> int:
        """Time units per picosecond, so that each tick is a whole number of them, if such times are not too long."""
        system, model = self.context.system, self.context.demand_model
        found = lcm(*(model.time_base(core) for core in system.cores))
        if found * self.options.duration <= _LONGEST:
            return found
        self.context.notes.assume("execution times are rounded to picoseconds")
        return 1

    def build(self) -> KernelProgram | None:
        """The program; None if one more process has turned out to be impossible."""
        system, resources, before = self.context.system, self.resources, len(self.left_out)
        modes = resources.modes = ModeRecords(system, self.image, self.context.settings.modes)
        processes = resources.processes = {name: self.image.record(layout.PROCESS_SIZE) for name in self.dispatching.processes}
        resources.stimuli = {name: self.image.record(layout.STIMULUS_SIZE) for name in system.stimuli_by_name}
        watches = resources.watches
        runnables = watches.watched.runnables
        watches.measured = {name: len(processes) + number for number, name in enumerate(runnables)}
        network = MessageRecords(resources)
        flows = FlowRecords(network)
        executors = resources.executors = ExecutorRecords(resources, network, flows, len(processes) + len(runnables))
        network.place()
        flows.place()
        executors.place()
        chains = ChainCompiler(resources)
        for name in filter(network.is_about_message, processes):
            chains.captures[name] = [layout.MESSAGE]
        for chain in system.events.chains:
            chains.add(chain)
        messages = Messages(resources, chains)
        hook_firings(resources, chains)
        hardware = HardwareRecords(resources, self.dispatching)
        hardware.place_cores()
        hardware.place_servers()
        records = ProcessRecords(resources, hardware, chains)
        for number, item in enumerate(self.dispatching.processes.values()):
            try:
                messages.add(item.scheduled.process)
                records.add(item, number)
            except UnknownError as error:
                self.left_out[item.name] = str(error)
        arrivals = StimulusRecords(resources, self.left_out).place()
        if len(self.left_out) > before:
            return None
        records.place_members()
        records.place_ceilings()
        self._head(hardware, chains)
        self.image.put(0, network.head())
        return KernelProgram(
            memory=self.image.words,
            units=resources.units,
            streams=resources.streams,
            stream_records=resources.stream_records,
            # What arrives at the time of an activation is there before it.
            arrivals=[*messages.arrivals, *network.arrivals, *network.host.arrivals, *arrivals],
            messages=resources.queues,
            processes=tuple(processes),
            records=processes,
            cores=hardware.cores,
            channels=modes.channels,
            queues=(*processes.values(), *records.decisions.values()),
            entities=resources.entities.all,
            routes=tuple(chains.routes),
            sources=tuple(watches.sources),
            runnables=runnables,
            handles=tuple(executors.measured),
            handle_records=dict(network.handles),
            host_handles=dict(network.host.handles),
            executors=executors.publications_of(),
            lossy=flows.on_lossy_wires(),
            left_out=self.left_out,
            chains_left_out=chains.left_out,
        )

    def _head(self, hardware: HardwareRecords, chains: ChainCompiler) -> None:
        lists = {
            (layout.CORES, layout.CORES_END): hardware.cores.values(),
            (layout.DOMAINS, layout.DOMAINS_END): dict.fromkeys(hardware.domains.values()),
            (layout.SERVERS, layout.SERVERS_END): hardware.servers.values(),
            (layout.PROCESSES, layout.PROCESSES_END): self.resources.processes.values(),
            (layout.SEMAPHORES, layout.SEMAPHORES_END): self.resources.semaphores.values(),
        }
        for (first, end), records in lists.items():
            places = self.image.items(records)
            self.image.put(0, dict(zip((first, end), places, strict=True)))
        has_writes = len(hardware.cores) > 1 and any(
            operation == PUT for hooks in chains.hooks.values() for operation, *_ in hooks.all()
        )
        self.image.put(0, {layout.PLACES: PLACES_AT_FIRST, layout.HAS_WRITES: int(has_writes)})


@dataclass(frozen=True, slots=True)
class KernelProgram:
    """A system as the kernel executes it.

    Attributes
    ----------
    memory : of the kernel, at time 0
    units : time units per picosecond
    streams, stream_records : what is drawn from, and the records by which programs know it
    arrivals : of each stimulus that comes from outside: its record, and when it occurs
    processes : the names of the processes in the order of their numbers in rows
    records, cores, channels : the records of processes, cores and channels, by name
    messages : the queues of messages with arrivals of their own, by process and source
    queues : the records of everything that is activated
    sources : of events that are watched, in the order of their numbers in rows
    runnables : that are measured, in the order of their numbers in rows, which follow those of the processes
    handles : executors and handles of which the calls are measured, in the order of their numbers, which follow those of runnables
    handle_records : by executor and handle
    host_handles : the records of the callbacks of the host; none if it is not simulated
    executors : those that are simulated, each with the records of its publications
    lossy : the records of messages on wires of which it is stated how many they lose
    left_out : why a process is not simulated
    chains_left_out : why a chain is not followed
    """

    memory: list[int]
    units: int
    streams: Sequence[ValueStream]
    stream_records: Sequence[int]
    arrivals: Sequence[tuple[int, StimulusOccurrences]]
    processes: tuple[str, ...]
    records: dict[str, int]
    cores: dict[str, int]
    channels: dict[str, int]
    messages: dict[tuple[str, str], int]
    queues: tuple[int, ...]
    entities: tuple[Entity, ...]
    routes: tuple[FollowedRoute, ...]
    sources: tuple[EventSource, ...]
    runnables: tuple[str, ...]
    handles: tuple[tuple[str, str], ...]
    handle_records: dict[tuple[str, str], int]
    host_handles: dict[str, int]
    executors: dict[str, list[int]]
    lossy: dict[str, int]
    left_out: dict[str, str]
    chains_left_out: dict[str, str]
