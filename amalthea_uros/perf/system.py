"""A system: all models together, and its objects by name."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from typing import Any, TypeVar

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.perf.activities import Activity, LabelAccess, Trigger, transformed, walk
from amalthea_uros.perf.constraints import Constraints
from amalthea_uros.perf.events import Event, EventChain, Events
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.hardware import Cache, Clock, Connection, Core, Hardware, Interconnect, Memory
from amalthea_uros.perf.host import Host, HostCallback
from amalthea_uros.perf.mapping import Mapping as SystemMapping
from amalthea_uros.perf.named import Named
from amalthea_uros.perf.network import Direction, Network, Purpose, Span, Transmission
from amalthea_uros.perf.os import InterruptController, Os, Scheduler
from amalthea_uros.perf.software import Channel, Label, Process, Runnable, Software
from amalthea_uros.perf.stimuli import Stimuli, Stimulus
from amalthea_uros.units import Frequency, Time

N = TypeVar("N", bound=Named)


@dataclass(frozen=True, kw_only=True)
class System:
    """The generic performance model of a system.

    Besides the models that AMALTHEA has, too, it has the executors that spin in loops, and the network: tasks and cores of the other
    models stand for them. It has the host as well. The mappings find objects by name; where a name occurs twice, the last one counts
    (an extracted model has unique names).
    """

    hardware: Hardware = field(default_factory=Hardware)
    os: Os = field(default_factory=Os)
    stimuli: Stimuli = field(default_factory=Stimuli)
    software: Software = field(default_factory=Software)
    mapping: SystemMapping = field(default_factory=SystemMapping)
    events: Events = field(default_factory=Events)
    constraints: Constraints = field(default_factory=Constraints)
    executors: tuple[Executor, ...] = ()
    network: Network = field(default_factory=Network)
    host: Host = field(default_factory=Host)

    def __repr__(self) -> str:
        parts = (
            ("core", self.cores),
            ("task", self.software.tasks),
            ("ISR", self.software.isrs),
            ("chain", self.events.chains),
        )
        return f"<System: {', '.join(counted(len(items), noun) for noun, items in parts if items) or 'empty'}>"

    def with_activities(self, change: Callable[[Activity], Activity]) -> System:
        """The system with all activities of processes and runnables changed that contain no others."""
        software = self.software
        items: dict[str, Any] = {kind: getattr(software, kind) for kind in ("tasks", "isrs", "runnables")}
        for kind, found in items.items():
            items[kind] = tuple(replace(each, activities=transformed(each.activities, change)) for each in found)
        return replace(self, software=replace(software, **items))

    @property
    def has_messages_or_loops(self) -> bool:
        """Whether something is sent, or an executor spins in a loop, so that not all is said by tasks and their activations."""
        return bool(self.executors or self.transmissions or self.host.executors)

    @cached_property
    def clocks(self) -> Mapping[str, Clock]:
        """The clocks of the hardware."""
        return _by_name(self.hardware.clocks)

    def frequency_of(self, clock: str | None) -> Frequency | None:
        """The frequency of a clock; None if it is unknown, and what a frequency that is not positive stands for is unknown, too."""
        found = self.clocks.get(clock or "")
        return found.frequency if found is not None and found.frequency is not None and found.frequency > 0 else None

    @cached_property
    def cores(self) -> Mapping[str, Core]:
        """The cores, in the order of the hardware."""
        return _by_name(core for structure in self.hardware.walk() for core in structure.cores)

    @cached_property
    def memories(self) -> Mapping[str, Memory]:
        """The memories."""
        return _by_name(memory for structure in self.hardware.walk() for memory in structure.memories)

    @cached_property
    def modules(self) -> Mapping[str, Cache | Interconnect | Connection]:
        """What can lie on the way from a core to a memory."""
        found: list[Cache | Interconnect | Connection] = []
        for structure in self.hardware.walk():
            found += (*structure.caches, *structure.interconnects, *structure.connections)
            found += (cache for core in structure.cores for cache in core.caches)
        return _by_name(found)

    @cached_property
    def memory_of(self) -> Mapping[str, str]:
        """The memories of labels and other elements."""
        return {placement.element: placement.memory for placement in self.mapping.placements}

    @cached_property
    def schedulers(self) -> Mapping[str, Scheduler]:
        """The schedulers of all operating systems."""
        return _by_name(scheduler for system in self.os.systems for scheduler in system.schedulers)

    @cached_property
    def interrupt_controllers(self) -> Mapping[str, InterruptController]:
        """The interrupt controllers of all operating systems."""
        return _by_name(controller for system in self.os.systems for controller in system.interrupt_controllers)

    @cached_property
    def stimuli_by_name(self) -> Mapping[str, Stimulus]:
        """The stimuli."""
        return _by_name(self.stimuli.stimuli)

    @cached_property
    def processes(self) -> Mapping[str, Process]:
        """Tasks, then interrupt service routines."""
        return _by_name((*self.software.tasks, *self.software.isrs))

    @cached_property
    def runnables(self) -> Mapping[str, Runnable]:
        """The runnables."""
        return _by_name(self.software.runnables)

    @cached_property
    def activity_classes(self) -> frozenset[type[Activity]]:
        """The classes of all activities in processes and runnables."""
        return frozenset(type(activity) for body in self.software.bodies for activity in walk(body))

    @cached_property
    def triggered(self) -> tuple[tuple[str, ...], ...]:
        """The stimuli that each process and each runnable triggers, in order; without those that trigger none."""
        stimuli = (tuple(each.stimulus for each in walk(body) if isinstance(each, Trigger)) for body in self.software.bodies)
        return tuple(filter(None, stimuli))

    @cached_property
    def labels(self) -> Mapping[str, Label]:
        """The labels."""
        return _by_name(self.software.labels)

    @cached_property
    def label_accesses(self) -> Mapping[str, tuple[LabelAccess, ...]]:
        """The reads and writes of labels, in processes and runnables."""
        found: dict[str, list[LabelAccess]] = {}
        for body in self.software.bodies:
            for activity in walk(body):
                if isinstance(activity, LabelAccess):
                    found.setdefault(activity.label, []).append(activity)
        return {label: tuple(accesses) for label, accesses in found.items()}

    @cached_property
    def channels(self) -> Mapping[str, Channel]:
        """The channels."""
        return _by_name(self.software.channels)

    @cached_property
    def events_by_name(self) -> Mapping[str, Event]:
        """The events."""
        return _by_name(self.events.events)

    @cached_property
    def chains(self) -> Mapping[str, EventChain]:
        """The event chains."""
        return _by_name(self.events.chains)

    @cached_property
    def executor_of_task(self) -> Mapping[str, Executor]:
        """The executors that spin in loops, by the tasks that execute their rounds."""
        return {executor.task: executor for executor in self.executors}

    def tasks_of_thread(self, task: str) -> frozenset[str]:
        """The tasks of the executors that spin in the same thread as that of a task, itself included."""
        own = self.executor_of_task.get(task)
        if own is None or own.place is None:
            return frozenset((task,))
        return self._tasks_of_threads[own.place.thread]

    @cached_property
    def _tasks_of_threads(self) -> Mapping[str, frozenset[str]]:
        """The tasks of the executors that share a thread, by thread."""
        tasks: dict[str, set[str]] = {}
        for each in self.executors:
            if each.place is not None:
                tasks.setdefault(each.place.thread, set()).add(each.task)
        return {thread: frozenset(names) for thread, names in tasks.items()}

    @property
    def clients(self) -> tuple[System, ...]:
        """The system as each client of the middleware sees it: with no executors and wires but its own; itself if there is one."""
        return self._several_clients or (self,)

    @cached_property
    def _several_clients(self) -> tuple[System, ...]:
        names = dict.fromkeys((*(each.client for each in self.executors), *(each.client for each in self.network.wires)))
        return tuple(map(self._client, names)) if len(names) > 1 else ()

    def _client(self, name: str) -> System:
        wires = tuple(wire for wire in self.network.wires if wire.client == name)
        own = {wire.name for wire in wires}
        # The agent can bring what other clients publish.
        published = Direction.TO_AGENT, Purpose.DATA
        sent = tuple(
            each for each in self.network.transmissions if each.wire in own or (each.direction, each.purpose) == published
        )
        return replace(
            self,
            executors=tuple(each for each in self.executors if each.client == name),
            network=replace(self.network, wires=wires, transmissions=sent),
        )

    def client_at(self, wire: str) -> System:
        """The system as the client at the end of a wire sees it."""
        return next((each for each in self.clients if any(own.name == wire for own in each.network.wires)), self)

    @cached_property
    def callback_of_host_event(self) -> Mapping[str, HostCallback]:
        """The callbacks of the host, by the custom events that stand for them in chains."""
        return {f"{each.name}_{moment}": each for each in self.host.callbacks for moment in ("activation", "start", "finish")}

    @cached_property
    def transmissions(self) -> Mapping[str, Transmission]:
        """The messages on wires, by the tasks that stand for them."""
        return _by_name(self.network.transmissions)

    def in_driver(self, transmission: Transmission) -> Span:
        """The time that a received message is in the driver, where it waits for those before it: none overtakes another one."""
        return replace(transmission.driver, most=self._longest_in_driver[transmission.wire, transmission.direction])

    @cached_property
    def _longest_in_driver(self) -> Mapping[tuple[str, Direction], Time | None]:
        times: dict[tuple[str, Direction], list[Time | None]] = {}
        for each in self.network.transmissions:
            times.setdefault((each.wire, each.direction), []).append(each.driver.most)
        return {key: None if None in found else max(time for time in found if time is not None) for key, found in times.items()}


def _by_name(objects: Iterable[N]) -> dict[str, N]:
    return {item.name: item for item in objects}
