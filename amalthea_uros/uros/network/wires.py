"""A wire as a part of a system: a core for each direction, or one for both, and a task for everything that is queued on it.

A frame is never interrupted. On a bus, the pending message of the lowest identifier is sent before each frame, so that the tasks are
cooperative. On other wires, messages are sent in the order in which they were queued: the tasks cannot be preempted and have the same
priority. Messages wait for the wire in any number.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from amalthea_uros.perf.activities import Activity, Demand, Execute, SchedulePoint, Trigger
from amalthea_uros.perf.distributions import Boundaries, Constant, Sampling
from amalthea_uros.perf.hardware import Clock, Core, CoreType, Structure
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.network import Direction, Network, Purpose, Wire
from amalthea_uros.perf.os import OperatingSystem, Policy, Scheduler
from amalthea_uros.perf.software import Preemption, Runnable, Task
from amalthea_uros.perf.system import System
from amalthea_uros.uros.network.queueing import Queued
from amalthea_uros.uros.network.receiving import Receivers
from amalthea_uros.uros.transports.choice import keeps_sender
from amalthea_uros.uros.transports.line import Frame, Line

_UNLIMITED = 1_000_000
#: The type of the cores.
_TYPE = "Wire"


@dataclass(frozen=True, kw_only=True)
class WirePlan:
    """A wire with what is queued on it.

    Attributes
    ----------
    name : of the wire
    frames : of each queued message, for each of its parts
    ranks : of the queued messages; a lower one is sent first
    is_bus : whether the ranks decide before each frame
    """

    line: Line
    name: str
    queued: Sequence[Queued]
    frames: Mapping[str, Sequence[Sequence[Frame]]]
    ranks: Mapping[str, int]
    is_bus: bool
    receivers: Receivers

    def core(self, direction: Direction) -> str:
        """The core that stands for a direction."""
        if not self.line.is_duplex:
            return self.name
        return f"{self.name}_{'to_controller' if direction is Direction.TO_CONTROLLER else 'to_agent'}"

    @property
    def cores(self) -> tuple[str, ...]:
        """The cores that stand for the wire."""
        return tuple(dict.fromkeys(map(self.core, Direction)))


def with_wire(system: System, plan: WirePlan, agent: str, loses_messages: bool) -> System:
    """A system with a wire."""
    cores = plan.cores
    stimuli = [each.stimulus for each in plan.queued if each.stimulus is not None]
    return replace(
        system,
        hardware=replace(
            system.hardware,
            core_types=(*system.hardware.core_types, CoreType(name=_TYPE)),
            clocks=(*system.hardware.clocks, Clock(name=plan.name, frequency=Fraction(plan.line.ticks_per_second))),
            structures=(
                *system.hardware.structures,
                Structure(name=plan.name, cores=tuple(Core(name=core, type=_TYPE, clock=plan.name) for core in cores)),
            ),
        ),
        os=replace(system.os, systems=(*system.os.systems, _operating_system(plan.name, cores))),
        stimuli=replace(system.stimuli, stimuli=(*system.stimuli.stimuli, *stimuli)),
        software=replace(
            system.software,
            tasks=(*system.software.tasks, *(_task(each, plan) for each in plan.queued)),
            runnables=tuple(_queueing(system.software.runnables, plan.queued)),
        ),
        mapping=replace(system.mapping, tasks=(*system.mapping.tasks, *_allocations(plan))),
        network=Network(
            wires=(
                Wire(
                    name=plan.name,
                    kind=plan.line.kind,
                    cores=cores,
                    loses_messages=loses_messages,
                    keeps_sender=keeps_sender(plan.line),
                ),
            ),
            transmissions=tuple(replace(each.transmission, wire=plan.name) for each in plan.queued),
            agent=agent,
        ),
    )


def _operating_system(name: str, cores: Collection[str]) -> OperatingSystem:
    schedulers = [Scheduler(name=core, policy=Policy.FIXED_PRIORITY_PREEMPTIVE, cores=(core,)) for core in cores]
    return OperatingSystem(name=name, schedulers=tuple(schedulers))


def _allocations(plan: WirePlan) -> Iterator[TaskAllocation]:
    lowest = max(plan.ranks.values(), default=0)
    for each in plan.queued:
        name = each.transmission.name
        priority = lowest - plan.ranks[name] if plan.is_bus else 0
        yield TaskAllocation(task=name, scheduler=plan.core(each.transmission.direction), priority=priority)


def _task(queued: Queued, plan: WirePlan) -> Task:
    return Task(
        name=queued.transmission.name,
        stimuli=() if queued.stimulus is None else (queued.stimulus.name,),
        activities=tuple(_activities(queued, plan)),
        preemption=Preemption.COOPERATIVE if plan.is_bus else Preemption.NON_PREEMPTIVE,
        activation_limit=_UNLIMITED,
        origin=queued.origin,
    )


def _activities(queued: Queued, plan: WirePlan) -> Iterator[Activity]:
    """The frames one after the other, each with what its end triggers."""
    parts = plan.frames[queued.transmission.name]
    count = sum(map(len, parts))
    number = 0
    for part in parts:
        for frame in part:
            if plan.is_bus and number:
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
