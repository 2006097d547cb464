"""Systems on one core in which a tick is a microsecond, so that times are computed easily by hand."""

from dataclasses import dataclass, replace
from fractions import Fraction

from amalthea_uros.perf.activities import Demand, Execute
from amalthea_uros.perf.distributions import Constant
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure
from amalthea_uros.perf.mapping import IsrAllocation, Mapping, TaskAllocation
from amalthea_uros.perf.os import InterruptController, OperatingSystem, Os, Policy, Scheduler
from amalthea_uros.perf.software import Isr, Software, Task
from amalthea_uros.perf.stimuli import Periodic, Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.units import MICROSECOND as US

CORE = Core(name="core", clock="clock", type="type")
CLOCK = Clock(name="clock", frequency=Fraction(10**6))
SCHEDULER = Scheduler(name="scheduler", policy=Policy.OSEK, cores=("core",))


def ticks(number):
    return Demand(ticks=Constant(number))


def work(number):
    return Execute(demand=ticks(number))


@dataclass
class Job:
    """A task; its period and its offset are in microseconds."""

    name: str
    activities: tuple
    priority: int = 1
    period: int = 10_000
    offset: int = 0
    others: dict | None = None

    @property
    def stimulus(self):
        return Periodic(name=f"timer of {self.name}", period=self.period * US, offset=self.offset * US)

    @property
    def task(self):
        stimuli = (self.stimulus.name,)
        return Task(name=self.name, stimuli=stimuli, activities=tuple(self.activities), **(self.others or {}))


def one_core(jobs, isrs=(), *, scheduler=SCHEDULER, core=CORE, overhead=None, software=None, **others):
    """A system of tasks; an ISR is (`Isr`, stimulus).

    Parameters
    ----------
    overhead : of the operating system
    software : what the tasks use
    others : parts of the system
    """
    system = OperatingSystem(
        name="OS",
        schedulers=(scheduler,),
        interrupt_controllers=(InterruptController(name="controller", cores=("core",)),),
        overhead=overhead.name if overhead else None,
    )
    hardware = others.pop("hardware", Hardware())
    operating_systems = others.pop("os", Os())
    stimuli = others.pop("stimuli", Stimuli())
    mapping = others.pop("mapping", Mapping())
    return System(
        hardware=replace(
            hardware,
            clocks=(*hardware.clocks, CLOCK),
            structures=(*hardware.structures, Structure(name="ECU", cores=(core,))),
        ),
        os=replace(operating_systems, systems=(system,), overheads=(overhead,) if overhead else ()),
        stimuli=Stimuli(stimuli=(*stimuli.stimuli, *(job.stimulus for job in jobs), *(stimulus for _, stimulus in isrs))),
        software=replace(software or Software(), tasks=tuple(job.task for job in jobs), isrs=tuple(isr for isr, _ in isrs)),
        mapping=replace(
            mapping,
            tasks=tuple(TaskAllocation(task=job.name, scheduler="scheduler", priority=job.priority) for job in jobs),
            isrs=tuple(
                IsrAllocation(isr=isr.name, controller="controller", priority=number) for number, (isr, _) in enumerate(isrs)
            ),
        ),
        **others,
    )


def interrupt(name, number, *, category=None, period=10_000, offset=0):
    """An ISR of some ticks, with its stimulus; times in microseconds."""
    stimulus = Periodic(name=f"signal of {name}", period=period * US, offset=offset * US)
    return Isr(name=name, stimuli=(stimulus.name,), activities=(work(number),), category=category), stimulus


def microseconds(found):
    """A time in microseconds."""
    return None if found is None else Fraction(found, US) if isinstance(found, int) else found / US
