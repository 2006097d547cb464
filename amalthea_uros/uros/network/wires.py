"""A wire as a part of a system: a core for each direction, or one for both, and a task for everything that is queued on it.

A frame is never interrupted. On a bus, the pending message of the lowest identifier is sent before each frame, so that the tasks are
cooperative. On other wires, messages are sent in the order in which they were queued: the tasks cannot be preempted and have the same
priority. Messages wait for the wire in any number.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cached_property
from itertools import chain, count

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import Activity, Demand, Execute, SchedulePoint, Trigger
from amalthea_uros.perf.distributions import Boundaries, Bucket, Constant, Histogram, Sampling
from amalthea_uros.perf.hardware import Clock, Core, CoreType, Structure
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.network import Direction, Losses, Network, Purpose, Recovery, Wire
from amalthea_uros.perf.os import OperatingSystem, Policy, Scheduler
from amalthea_uros.perf.software import UNLIMITED, Preemption, Runnable, Task
from amalthea_uros.perf.stimuli import Stimulus
from amalthea_uros.perf.system import System
from amalthea_uros.spec.transports import Can, CanFd
from amalthea_uros.uros.network.queueing import Queued
from amalthea_uros.uros.network.receiving import Receivers
from amalthea_uros.uros.transports.can import BusLine, arbitration_rank
from amalthea_uros.uros.transports.framing import BYTES, ESCAPED
from amalthea_uros.uros.transports.line import Frame, Line

#: The type of the cores.
_TYPE = "Wire"
#: Loses the arbitration against all identifiers.
_OF_CLIENT = 2**31


@dataclass(frozen=True, slots=True, kw_only=True)
class WireCores:
    """The cores of a wire, each with a scheduler of its name, and their tasks.

    Attributes
    ----------
    name : of the wire, of its clock and of its operating system
    """

    name: str
    ticks_per_second: int
    cores: tuple[Core, ...]
    stimuli: tuple[Stimulus, ...]
    tasks: tuple[Task, ...]
    allocations: tuple[TaskAllocation, ...]


def with_cores(system: System, wire: WireCores) -> System:
    """A system with the cores of a wire."""
    schedulers = tuple(
        Scheduler(name=core.name, policy=Policy.FIXED_PRIORITY_PREEMPTIVE, cores=(core.name,)) for core in wire.cores
    )
    return replace(
        system,
        hardware=replace(
            system.hardware,
            clocks=(*system.hardware.clocks, Clock(name=wire.name, frequency=Fraction(wire.ticks_per_second))),
            structures=(*system.hardware.structures, Structure(name=wire.name, cores=wire.cores)),
        ),
        os=replace(system.os, systems=(*system.os.systems, OperatingSystem(name=wire.name, schedulers=schedulers))),
        stimuli=replace(system.stimuli, stimuli=(*system.stimuli.stimuli, *wire.stimuli)),
        software=replace(system.software, tasks=(*system.software.tasks, *wire.tasks)),
        mapping=replace(system.mapping, tasks=(*system.mapping.tasks, *wire.allocations)),
    )


def free_name(wanted: str, system: System) -> str:
    """A name for a wire, whose cores, clock, operating system and schedulers begin with it."""
    taken = (*system.cores, *system.clocks, *system.schedulers, *(each.name for each in system.os.systems))
    names = chain([wanted], (f"{wanted}_{number}" for number in count(2)))
    return next(name for name in names if not _is_taken(name, taken))


def _is_taken(name: str, taken: Collection[str]) -> bool:
    return any(other == name or other.startswith(f"{name}_to_") for other in taken)


@dataclass(frozen=True, kw_only=True)
class WirePlan:
    """A wire with what is queued on it.

    Attributes
    ----------
    name : of the wire
    loses_messages, losses, recovery : as in `perf.network.Wire`
    origin : where the transport is described
    """

    line: Line
    name: str
    queued: Sequence[Queued]
    receivers: Receivers
    loses_messages: bool = False
    losses: tuple[Losses, ...] = ()
    recovery: Recovery | None = None
    origin: Location | None = None

    def core(self, direction: Direction) -> str:
        """The core that stands for a direction."""
        if not self.line.is_duplex:
            return self.name
        return f"{self.name}_{'to_controller' if direction is Direction.TO_CONTROLLER else 'to_agent'}"

    @property
    def cores(self) -> tuple[str, ...]:
        """The cores that stand for the wire."""
        return tuple(dict.fromkeys(map(self.core, Direction)))

    @cached_property
    def frames(self) -> Mapping[str, Sequence[Sequence[Frame]]]:
        """The frames of each queued message, for each of its parts."""
        return {each.transmission.name: [*self._frames(each)] for each in self.queued}

    def _frames(self, queued: Queued) -> Iterator[Sequence[Frame]]:
        if queued.frame is not None and isinstance(self.line, BusLine):
            yield (self.line.foreign(queued.frame.data_bytes, extended=queued.frame.extended),)
        else:
            yield from (self.line.frames(part, queued.transmission.direction) for part in queued.parts)

    @property
    def assumptions(self) -> Iterator[str]:
        """The assumptions about frames of which only the longest and the shortest are certain."""
        if any(frame.weights for parts in self.frames.values() for part in parts for frame in part):
            yield (
                f"means and simulations: each byte on {self.name!r} has any of its {BYTES} values as often, "
                f"{ESCAPED} of which are sent as two bytes"
            )

    @cached_property
    def ranks(self) -> Mapping[str, int]:
        """The order of identifiers, from 0 on: a lower one is sent first; messages without one have that of the client, which loses."""
        found = {each.transmission.name: self._rank(each) for each in self.queued}
        dense = {rank: number for number, rank in enumerate(sorted(set(found.values())))}
        return {name: dense[rank] for name, rank in found.items()}

    def _rank(self, queued: Queued) -> int:
        if queued.frame is not None:
            return queued.frame.rank
        section = self.line.section
        if not isinstance(section, Can | CanFd) or queued.transmission.purpose is not Purpose.DATA:
            return _OF_CLIENT
        identifier = section.identifiers.get(queued.channel)
        return _OF_CLIENT if identifier is None else arbitration_rank(identifier, extended=section.identifier == "extended")


def with_wire(system: System, plan: WirePlan, agent: str, assumptions: tuple[str, ...]) -> System:
    """A system with a wire."""
    lowest = max(plan.ranks.values(), default=0)
    wire = WireCores(
        name=plan.name,
        ticks_per_second=plan.line.ticks_per_second,
        cores=tuple(Core(name=core, type=_TYPE, clock=plan.name, origin=plan.origin) for core in plan.cores),
        stimuli=tuple(each.stimulus for each in plan.queued if each.stimulus is not None),
        tasks=tuple(_task(each, plan) for each in plan.queued),
        allocations=tuple(
            TaskAllocation(
                task=each.transmission.name,
                scheduler=plan.core(each.transmission.direction),
                priority=lowest - plan.ranks[each.transmission.name] if plan.line.is_bus else 0,
            )
            for each in plan.queued
        ),
    )
    found = with_cores(system, wire)
    return replace(
        found,
        hardware=replace(found.hardware, core_types=(*system.hardware.core_types, CoreType(name=_TYPE))),
        software=replace(found.software, runnables=tuple(_queueing(system.software.runnables, plan.queued))),
        network=Network(
            wires=(
                Wire(
                    name=plan.name,
                    kind=plan.line.kind,
                    cores=plan.cores,
                    loses_messages=plan.loses_messages,
                    losses=plan.losses,
                    recovery=plan.recovery,
                    keeps_sender=plan.line.keeps_sender,
                ),
            ),
            transmissions=tuple(replace(each.transmission, wire=plan.name) for each in plan.queued),
            agent=agent,
            assumptions=assumptions,
        ),
    )


def _task(queued: Queued, plan: WirePlan) -> Task:
    return Task(
        name=queued.transmission.name,
        stimuli=() if queued.stimulus is None else (queued.stimulus.name,),
        activities=tuple(_activities(queued, plan)),
        preemption=Preemption.COOPERATIVE if plan.line.is_bus else Preemption.NON_PREEMPTIVE,
        activation_limit=UNLIMITED,
        origin=queued.origin,
    )


def _activities(queued: Queued, plan: WirePlan) -> Iterator[Activity]:
    """The frames one after the other, each with what its end triggers."""
    parts = plan.frames[queued.transmission.name]
    count = sum(map(len, parts))
    number = 0
    for part in parts:
        for frame in part:
            if plan.line.is_bus and number:
                yield SchedulePoint()
            number += 1
            yield _execution(frame)
            yield from map(_trigger, _received(queued, plan.receivers, is_last=number == count))
        if queued.answer is not None:
            yield _trigger(queued.answer)


def _received(queued: Queued, receivers: Receivers, *, is_last: bool) -> tuple[str, ...]:
    """The stimuli that the end of a frame triggers in the controller."""
    transmission = queued.transmission
    if transmission.direction is Direction.TO_AGENT or transmission.purpose is Purpose.FOREIGN:
        return ()
    is_message = is_last and transmission.purpose is Purpose.DATA
    return receivers.message_triggers if is_message else receivers.other_triggers


def _execution(frame: Frame) -> Execute:
    if frame.least == frame.most:
        return Execute(demand=Demand(ticks=Constant(frame.most)))
    if frame.weights:
        buckets = (Bucket(lower=ticks, upper=ticks, occurrences=weight) for ticks, weight in frame.weights)
        return Execute(demand=Demand(ticks=Histogram(tuple(buckets))))
    ticks = Boundaries(lower=frame.least, upper=frame.most, sampling=Sampling.UNIFORM)
    return Execute(demand=Demand(ticks=ticks))


def _trigger(stimulus: str) -> Trigger:
    return Trigger(stimulus=stimulus)


def _queueing(runnables: Sequence[Runnable], queued: Sequence[Queued]) -> Iterator[Runnable]:
    """The runnables, with what those that send trigger at their end."""
    added: dict[str, list[Trigger]] = {}
    for each in queued:
        if each.sender is not None and each.stimulus is not None:
            trigger = Trigger(stimulus=each.stimulus.name, counter=each.sender.counter)
            added.setdefault(each.sender.runnable, []).extend([trigger] * each.sender.times)
    for runnable in runnables:
        yield replace(runnable, activities=(*runnable.activities, *added.get(runnable.name, ())))
