"""Small systems in which processes wait for each other, lose activations, migrate; cores have 1 MHz, so a tick is a microsecond."""

from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise

from amalthea_uros.perf.activities import (
    AccessKind,
    Call,
    ClearEvent,
    Communication,
    Demand,
    Execute,
    Group,
    LabelAccess,
    SchedulePoint,
    SemaphoreAccess,
    SemaphoreOperation,
    ServerCall,
    SetEvent,
    Trigger,
    WaitEvent,
    Waiting,
)
from amalthea_uros.perf.distributions import Boundaries, Constant
from amalthea_uros.perf.events import EventChain, Events, ProcessChange, ProcessEvent, Segment, Sequence
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure
from amalthea_uros.perf.mapping import IsrAllocation, Mapping, TaskAllocation
from amalthea_uros.perf.os import (
    Duration,
    InterruptController,
    OperatingSystem,
    Os,
    Parameter,
    Parent,
    Policy,
    Scheduler,
    Semaphore,
    SemaphoreKind,
)
from amalthea_uros.perf.software import Isr, Label, OsEvent, Preemption, Runnable, Software, Task
from amalthea_uros.perf.stimuli import InterProcess, Periodic, Stimuli
from amalthea_uros.perf.system import System
from amalthea_uros.units import MICROSECOND as US

CORES = ("c0", "c1")
READ, WRITE = AccessKind.READ, AccessKind.WRITE


def ticks(worst, best=None):
    return Execute(demand=Demand(Constant(worst) if best in (None, worst) else Boundaries(lower=best, upper=worst)))


def request(semaphore, waiting=None, *, exclusive=False):
    operation = SemaphoreOperation.EXCLUSIVE if exclusive else SemaphoreOperation.REQUEST
    return SemaphoreAccess(semaphore=semaphore, operation=operation, waiting=waiting)


def release(semaphore):
    return SemaphoreAccess(semaphore=semaphore, operation=SemaphoreOperation.RELEASE)


def locked(semaphore, length, waiting=None, *, exclusive=False):
    return request(semaphore, waiting, exclusive=exclusive), ticks(length), release(semaphore)


def access(label, kind, communication=Communication.EXPLICIT):
    return LabelAccess(label=label, kind=kind, communication=communication)


def read(label):
    """A read whose communication is not stated."""
    return access(label, READ, None)


def write(label):
    return access(label, WRITE, None)


@dataclass(frozen=True)
class Proc:
    """A process; times in microseconds."""

    name: str
    body: tuple
    period: int = 0
    offset: int = 0
    stimuli: tuple = ()
    priority: int | None = None
    scheduler: str = "s0"
    deadline: int | None = None
    is_isr: bool = False
    task: dict = field(default_factory=dict)


def chain(name, *events):
    """A chain through some events."""
    segments = tuple(Segment(stimulus=first, response=then) for first, then in pairwise(events))
    return EventChain(name=name, stimulus=events[0], response=events[-1], items=Sequence(segments))


def of_parts(tasks, allocations, stimuli, *, cores=("core",), schedulers=None, policy=Policy.OSEK, frequency=10**6, **parts):
    """A system of cores with one clock, each with a scheduler of its own name if none are given.

    Parameters
    ----------
    parts : of the operating system (`os_parts`), of the software by name, and of the system itself
    """
    schedulers = schedulers or [Scheduler(name=core, policy=policy, cores=(core,)) for core in cores]
    software = {
        name: tuple(parts.pop(name)) for name in ("isrs", "runnables", "labels", "channels", "os_events") if name in parts
    }
    os_parts = dict(parts.pop("os_parts", {}))
    controllers = tuple(os_parts.pop("interrupt_controllers", ()))
    operating_system = OperatingSystem(
        name="OS", schedulers=tuple(schedulers), interrupt_controllers=controllers, overhead=parts.pop("overhead", None)
    )
    structure = Structure(name="ECU", cores=tuple(Core(name=core, clock="clock") for core in cores))
    clock = Clock(name="clock", frequency=Fraction(frequency))
    return System(
        hardware=parts.pop("hardware", None) or Hardware(clocks=(clock,), structures=(structure,)),
        os=Os(systems=(operating_system,), **os_parts),
        stimuli=Stimuli(stimuli=tuple(stimuli)),
        software=Software(tasks=tuple(tasks), **software),
        mapping=Mapping(tasks=tuple(allocations), isrs=tuple(parts.pop("isr_allocations", ()))),
        **parts,
    )


def system(*processes, schedulers=None, triggers=(), chains=(), **parts):
    """A system of two cores, with a scheduler for each if none are given."""
    schedulers = schedulers or [Scheduler(name=f"s{n}", policy=Policy.OSEK, cores=(core,)) for n, core in enumerate(CORES)]
    tasks, isrs, stimuli, allocations, controlled = [], [], [], [], []
    for each in processes:
        own = (each.name + "_tick",) if each.period else ()
        if each.period:
            stimuli.append(Periodic(name=own[0], period=each.period * US, offset=each.offset * US))
        (isrs if each.is_isr else tasks).append(
            (Isr if each.is_isr else Task)(name=each.name, stimuli=(*own, *each.stimuli), activities=each.body, **each.task)
        )
        if each.is_isr:
            controlled.append(IsrAllocation(isr=each.name, controller="irq", priority=each.priority))
        else:
            deadline = None if each.deadline is None else each.deadline * US
            allocations.append(
                TaskAllocation(task=each.name, scheduler=each.scheduler, priority=each.priority, deadline=deadline)
            )
    os_parts = {
        "interrupt_controllers": (InterruptController(name="irq", cores=("c0",)),),
        "semaphores": parts.pop("semaphores", ()),
    }
    return of_parts(
        tasks,
        allocations,
        [*stimuli, *(InterProcess(name=name) for name in triggers)],
        cores=CORES,
        schedulers=schedulers,
        isrs=isrs,
        isr_allocations=controlled,
        os_parts=os_parts,
        events=Events(events=parts.pop("events", ()), chains=tuple(chains)),
        **parts,
    )


def one_core(*tasks, stimuli=(), **parts):
    """Tasks of (name, period in us, activities) on a core of 1 MHz, the first one first; those without a period are triggered.

    Stimuli that are named "every ..." or "trigger ..." after a task activate it.
    """
    periodic = [Periodic(name=f"every {name}", period=period * US) for name, period, _ in tasks if period]
    known = {stimulus.name for stimulus in (*periodic, *stimuli)}
    return of_parts(
        [
            Task(
                name=name,
                stimuli=(f"every {name}" if f"every {name}" in known else f"trigger {name}",),
                activities=tuple(activities),
            )
            for name, _, activities in tasks
        ],
        [TaskAllocation(task=name, scheduler="core", priority=-index) for index, (name, _, _) in enumerate(tasks)],
        [*periodic, *stimuli],
        **parts,
    )


def changed(built, name=None, /, **changes):
    """A system with one task changed, or all of them."""
    tasks = tuple(replace(task, **changes) if name in (None, task.name) else task for task in built.software.tasks)
    return replace(built, software=replace(built.software, tasks=tasks))


def reallocated(built, name=None, /, **changes):
    """A system with the allocation of one task changed, or of all of them."""
    found = tuple(replace(each, **changes) if name in (None, each.task) else each for each in built.mapping.tasks)
    return replace(built, mapping=replace(built.mapping, tasks=found))


def _time(name, microseconds):
    return Parameter(name=name, values=(Duration(microseconds * US),))


def three_on_one_lock(semaphore, *, exclusive=False):
    """The lowest task takes the lock first, the others come in its critical section; one is on the other core."""
    return system(
        Proc("low", locked(semaphore.name, 30), 100, priority=1),
        Proc("mid", (ticks(2), *locked(semaphore.name, 5), ticks(1)), 100, 5, priority=2),
        Proc("high", (ticks(1), *locked(semaphore.name, 4, exclusive=exclusive)), 50, 10, priority=3),
        Proc("other", (ticks(3), *locked(semaphore.name, 8, exclusive=exclusive)), 25, 4, priority=1, scheduler="s1"),
        semaphores=(semaphore,),
    )


def across_cores(semaphore, waiting=None):
    """Who polls is kept from its core now and then, so that it is parked; so is who has the lock."""
    return system(
        Proc("first", (ticks(1), *locked(semaphore.name, 18, waiting, exclusive=True)), 50, priority=1),
        Proc("second", (ticks(3), *locked(semaphore.name, 9, waiting)), 25, priority=1, scheduler="s1"),
        Proc("third", locked(semaphore.name, 2, waiting), 40, 9, priority=1, scheduler="s1"),
        Proc("high_0", (ticks(2),), 11, 3, priority=2),
        Proc("high_1", (ticks(2),), 13, 8, priority=2, scheduler="s1"),
        semaphores=(semaphore,),
    )


BUDGET = (_time("capacity", 3), _time("period", 10))


def _server(policy):
    return [
        Scheduler(name="s0", policy=Policy.OSEK, cores=("c0",)),
        Scheduler(name="server", policy=policy, parent=Parent(scheduler="s0", priority=2, parameters=BUDGET)),
    ]


def _served(policy):
    return system(
        Proc("aperiodic", (Call(runnable="long"),), 40, 1, scheduler="server", priority=1),
        Proc("rival", (Call(runnable="short"),), 12, priority=3),
        Proc("rest", (ticks(4),), 20, priority=1),
        schedulers=_server(policy),
        runnables=(Runnable(name="long", activities=(ticks(11),)), Runnable(name="short", activities=(ticks(2),))),
    )


#: The events of the chain "through".
PASSED = (("first", ProcessChange.START), ("then", ProcessChange.START), ("last", ProcessChange.TERMINATE))

NESTED = (
    Runnable(name="inner", activities=(ticks(4), access("data", WRITE))),
    Runnable(name="outer", activities=(ticks(1), Call(runnable="inner"), ticks(2))),
)

CALLING_NESTED = {"runnables": NESTED, "labels": (Label(name="data"),)}

SYSTEMS = {
    "a lock without ceiling": three_on_one_lock(Semaphore(name="lock", kind=SemaphoreKind.MUTEX)),
    "a lock with ceiling": three_on_one_lock(Semaphore(name="lock", ceiling=True)),
    "a spinlock": across_cores(Semaphore(name="lock", kind=SemaphoreKind.SPINLOCK)),
    "a lock for which processes poll": across_cores(Semaphore(name="lock"), Waiting.ACTIVE),
    "a semaphore for two": three_on_one_lock(Semaphore(name="lock", kind=SemaphoreKind.COUNTING, users=2)),
    "a semaphore for three, one taken": three_on_one_lock(Semaphore(name="lock", users=3, initial_users=1)),
    "readers and writers": three_on_one_lock(Semaphore(name="lock", users=2), exclusive=True),
    "readers and a polling writer": across_cores(Semaphore(name="lock", users=3), Waiting.ACTIVE),
    "a wait for an event": system(
        Proc(
            "waits",
            (Call(runnable="outer"), WaitEvent(events=("ready",)), ClearEvent(events=("ready",)), ticks(2)),
            50,
            priority=2,
        ),
        Proc("sets", (ticks(10), SetEvent(events=("ready",), process="waits"), ticks(3)), 50, 20, priority=1),
        **CALLING_NESTED,
        os_events=(OsEvent(name="ready"),),
    ),
    "a poll for an event that is parked": system(
        Proc(
            "polls",
            (ticks(1), WaitEvent(events=("ready",), waiting=Waiting.ACTIVE), ClearEvent(events=("ready",))),
            100,
            priority=1,
        ),
        Proc("between", (Call(runnable="outer"),), 10, 5, priority=2),
        Proc("sets", (ticks(42), SetEvent(events=("ready",))), 100, priority=1, scheduler="s1"),
        **CALLING_NESTED,
        os_events=(OsEvent(name="ready"),),
    ),
    "a client and a server": system(
        Proc("client", (ticks(2), ServerCall(runnable="serve", waiting=Waiting.PASSIVE), ticks(1)), 40, priority=2),
        Proc("polling_client", (ServerCall(runnable="serve"), ticks(1)), 40, 3, priority=3, scheduler="s1"),
        Proc("server", (ticks(1), Call(runnable="serve")), 20, 7, priority=1),
        runnables=(Runnable(name="serve", activities=(ticks(3),)),),
    ),
    "interrupts in nested runnables": system(
        Proc("irq_0", (Call(runnable="handler"),), 7, 2, priority=1, is_isr=True),
        Proc("task", (Call(runnable="outer"), Call(runnable="outer")), 40, priority=1),
        runnables=(*NESTED, Runnable(name="handler", activities=(ticks(1),))),
        labels=(Label(name="data"),),
    ),
    "tasks that migrate": system(
        Proc("long", (Call(runnable="outer"), ticks(20)), 40, priority=1),
        Proc("mid", (ticks(6),), 14, 3, priority=2),
        Proc("short", (ticks(4),), 9, 1, priority=3),
        schedulers=[Scheduler(name="s0", policy=Policy.FIXED_PRIORITY_PREEMPTIVE, cores=CORES)],
        **CALLING_NESTED,
    ),
    "global earliest deadline first": system(
        Proc("long", (ticks(25),), 40, deadline=40),
        Proc("mid", (ticks(6),), 14, 3, deadline=14),
        Proc("short", (Call(runnable="inner"),), 9, 1, deadline=5),
        schedulers=[Scheduler(name="s0", policy=Policy.EARLIEST_DEADLINE_FIRST, cores=CORES)],
        **CALLING_NESTED,
    ),
    "lost and waiting activations": system(
        Proc("slow", (Call(runnable="outer"), ticks(30)), 10, priority=1, task={"activation_limit": 2}),
        Proc("busy", (ticks(4),), 9, priority=2),
        **CALLING_NESTED,
    ),
    "a deferrable server": _served(Policy.DEFERRABLE_SERVER),
    "a polling server": _served(Policy.POLLING_SERVER),
    "a sporadic server": _served(Policy.SPORADIC_SERVER),
    "cooperative tasks": system(
        Proc(
            "low",
            (ticks(8), SchedulePoint(), Call(runnable="outer"), SchedulePoint(), ticks(3)),
            60,
            priority=1,
            task={"preemption": Preemption.COOPERATIVE},
        ),
        Proc("mid", (ticks(3), SchedulePoint(), ticks(4)), 20, 2, priority=2, task={"preemption": Preemption.COOPERATIVE}),
        Proc("high", (ticks(2),), 15, 4, priority=3),
        **CALLING_NESTED,
    ),
    "non-interruptible groups": system(
        Proc("low", (Group(activities=(Call(runnable="outer"), ticks(4)), interruptible=False), ticks(5)), 40, priority=1),
        Proc("high", (ticks(2),), 6, 1, priority=2),
        Proc("whole", (ticks(3),), 20, priority=3, task={"preemption": Preemption.NON_PREEMPTIVE}),
        **CALLING_NESTED,
    ),
    "round robin": system(
        Proc("first", (ticks(7),), 30, priority=1),
        Proc("second", (Call(runnable="outer"),), 30, priority=1),
        Proc("above", (ticks(1),), 11, 2, priority=2),
        schedulers=[
            Scheduler(
                name="s0", policy=Policy.PRIORITY_BASED_ROUND_ROBIN, cores=("c0",), parameters=(_time("timeSliceLength", 2),)
            )
        ],
        **CALLING_NESTED,
    ),
    "scheduling that costs time": system(
        Proc("high", (ticks(2),), 10, 3, priority=2),
        Proc("low", (Call(runnable="outer"), ticks(5)), 30, priority=1),
        schedulers=[Scheduler(name="s0", policy=Policy.OSEK, cores=("c0",), overhead=(ticks(1),))],
        **CALLING_NESTED,
    ),
    "triggers to another core": system(
        Proc("first", (access("in", READ), ticks(4), Trigger(stimulus="go"), access("data", WRITE), ticks(2)), 20, priority=1),
        Proc(
            "then",
            (access("data", READ), ticks(7), Trigger(stimulus="on"), access("out", WRITE)),
            0,
            stimuli=("go",),
            priority=1,
            scheduler="s1",
        ),
        Proc("last", (access("out", READ), ticks(1)), 0, stimuli=("on",), priority=2),
        triggers=("go", "on"),
        labels=tuple(Label(name=name) for name in ("in", "data", "out")),
        events=tuple(ProcessEvent(name=f"{name}_{change}", process=name, change=change) for name, change in PASSED),
        chains=(chain("through", *(f"{name}_{change}" for name, change in PASSED)),),
    ),
}
