"""The CAN bus as a part of a system: a core whose clock is the bit rate, and a task for each message.

A frame that is being sent is never interrupted, and before each frame the pending message of the lowest identifier wins the
arbitration. So the tasks are cooperative: between their frames are the schedule points at which others can go first. Messages with the
same identifier, such as those of a client that has only one, are sent in the order in which they were queued.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain, count

from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.activities import Activity, Demand, Execute, SchedulePoint
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.events import Event
from amalthea_uros.perf.hardware import Clock, Core, Structure
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import OperatingSystem, Policy, Scheduler
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.perf.stimuli import Stimulus
from amalthea_uros.perf.system import System
from amalthea_uros.uros.transports.can import CanBus

#: The core of the bus, if nothing else has this name.
BUS = "CAN"
#: A message waits until the bus is free, however many of its kind are queued before it.
_UNLIMITED = 1_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class BusTransmission:
    """A message on the bus.

    Attributes
    ----------
    frames : minimum and maximum number of data bytes of each frame
    identifier : lower numbers win the arbitration
    stimulus : when it is queued
    """

    name: str
    frames: Sequence[tuple[int, int]]
    identifier: int = 0
    stimulus: Stimulus
    origin: Location | None = None


def with_bus(system: System, bus: CanBus, transmissions: Sequence[BusTransmission], events: Iterable[Event] = ()) -> System:
    """A system with a bus and its messages added.

    Parameters
    ----------
    events : to which stimuli of the transmissions refer
    """
    operating_systems = {each.name for each in system.os.systems}
    name = _free_name(BUS, {*system.cores, *system.clocks, *system.schedulers, *operating_systems})
    lowest = max((each.identifier for each in transmissions), default=0)
    core = Core(name=name, clock=name)
    return replace(
        system,
        hardware=replace(
            system.hardware,
            clocks=(*system.hardware.clocks, Clock(name=name, frequency=Fraction(bus.bit_rate))),
            structures=(*system.hardware.structures, Structure(name=name, cores=(core,))),
        ),
        os=replace(
            system.os,
            systems=(
                *system.os.systems,
                OperatingSystem(
                    name=name, schedulers=(Scheduler(name=name, policy=Policy.FIXED_PRIORITY_PREEMPTIVE, cores=(name,)),)
                ),
            ),
        ),
        stimuli=replace(
            system.stimuli, stimuli=(*system.stimuli.stimuli, *dict.fromkeys(each.stimulus for each in transmissions))
        ),
        software=replace(system.software, tasks=(*system.software.tasks, *(_task(each, bus) for each in transmissions))),
        mapping=replace(
            system.mapping,
            tasks=(
                *system.mapping.tasks,
                *(TaskAllocation(task=each.name, scheduler=name, priority=lowest - each.identifier) for each in transmissions),
            ),
        ),
        events=replace(system.events, events=(*system.events.events, *events)),
    )


def _task(transmission: BusTransmission, bus: CanBus) -> Task:
    frames = chain.from_iterable((SchedulePoint(), _frame(data, bus)) for data in transmission.frames)
    return Task(
        name=transmission.name,
        stimuli=(transmission.stimulus.name,),
        # The point before the first frame is where its job starts.
        activities=tuple(frames)[1:],
        preemption=Preemption.COOPERATIVE,
        activation_limit=_UNLIMITED,
        origin=transmission.origin,
    )


def _frame(data: tuple[int, int], bus: CanBus) -> Activity:
    least, most = data
    bits = Boundaries(lower=bus.min_frame_bits(least), upper=bus.max_frame_bits(most))
    return Execute(demand=Demand(ticks=bits))


def _free_name(wanted: str, taken: Iterable[str]) -> str:
    names = {*taken}
    return next(name for name in chain([wanted], (f"{wanted}_{number}" for number in count(2))) if name not in names)
