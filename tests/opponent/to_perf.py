"""A system in the plain form as one of the product: the only place that knows both."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from opponent.systems import Item, PlainSystem, items_of

from amalthea_uros.perf.activities import (
    AccessKind,
    Activity,
    Call,
    Chance,
    Communication,
    Demand,
    Execute,
    Group,
    LabelAccess,
    ProbabilitySwitch,
    SchedulePoint,
    SemaphoreAccess,
    SemaphoreOperation,
    Trigger,
    Waiting,
)
from amalthea_uros.perf.distributions import Boundaries, Constant, Distribution
from amalthea_uros.perf.events import EventChain, Events, ProcessChange, ProcessEvent, Segment, Sequence
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure, StructureKind
from amalthea_uros.perf.mapping import IsrAllocation, Mapping, TaskAllocation
from amalthea_uros.perf.os import (
    Duration,
    InterruptController,
    OperatingSystem,
    Os,
    Parameter,
    Scheduler,
    Semaphore,
    SemaphoreKind,
)
from amalthea_uros.perf.software import Isr, Label, Preemption, Runnable, Software, Task
from amalthea_uros.perf.stimuli import Counter, InterProcess, Periodic, RelativePeriodic, Stimuli, Stimulus
from amalthea_uros.perf.system import System
from amalthea_uros.units import Frequency

MICROSECOND = 10**6
POLICIES = {
    "FPP": "FixedPriorityPreemptive",
    "OSEK": "OSEK",
    "EDF": "EarliestDeadlineFirst",
    "RR": "PriorityBasedRoundRobin",
}


def to_perf(plain: PlainSystem) -> System:
    """The same system in the terms of the product."""
    communication = Communication(plain["chain"]["communication"]) if "chain" in plain else None
    processes, cores = plain["processes"], list(plain["cores"])
    tasks = [process for process in processes if process["kind"] == "task"]
    isrs = [process for process in processes if process["kind"] == "isr"]

    def activities(body: list[Item]) -> tuple[Activity, ...]:
        return tuple(_activity(item, index, activities, communication) for index, item in enumerate(body))

    return System(
        hardware=_hardware(cores),
        os=Os(
            systems=(_operating_system(plain, isrs),),
            semaphores=tuple(_semaphore(name, given) for name, given in plain["semaphores"].items()),
        ),
        stimuli=Stimuli(stimuli=tuple(_stimulus(process) for process in processes)),
        software=Software(
            tasks=tuple(
                Task(
                    name=task["name"],
                    stimuli=(_stimulus(task).name,),
                    activities=activities(task["body"]),
                    preemption=Preemption(task["preemption"]),
                    activation_limit=99,
                )
                for task in tasks
            ),
            isrs=tuple(
                Isr(name=isr["name"], stimuli=(_stimulus(isr).name,), activities=activities(isr["body"])) for isr in isrs
            ),
            runnables=tuple(Runnable(name=name, activities=activities(body)) for name, body in plain["runnables"].items()),
            labels=tuple(Label(name=name) for name in sorted({i["read"] for i in items_of(plain) if "read" in i})),
        ),
        mapping=Mapping(
            tasks=tuple(_task_allocation(plain, task) for task in tasks),
            isrs=tuple(IsrAllocation(isr=p["name"], controller=f"I{p['core']}", priority=p["priority"]) for p in isrs),
        ),
        events=_events(plain),
    )


def _hardware(cores: list[str]) -> Hardware:
    ecu = Structure(name="ECU", kind=StructureKind.ECU, cores=tuple(Core(name=name, clock="clock") for name in cores))
    return Hardware(clocks=(Clock(name="clock", frequency=Frequency(MICROSECOND)),), structures=(ecu,))


def _operating_system(plain: PlainSystem, isrs: list[dict[str, Any]]) -> OperatingSystem:
    with_isrs = [core for core in plain["cores"] if any(isr["core"] == core for isr in isrs)]
    return OperatingSystem(
        name="OS",
        schedulers=tuple(
            Scheduler(name=_scheduler(core), policy=POLICIES[policy], cores=(core,)) for core, policy in plain["cores"].items()
        ),
        interrupt_controllers=tuple(
            InterruptController(name=f"I{core}", policy="PriorityBased", cores=(core,)) for core in with_isrs
        ),
    )


def _scheduler(core: str) -> str:
    return f"S{core}"


def _semaphore(name: str, given: dict[str, bool]) -> Semaphore:
    kind = SemaphoreKind.RESOURCE if given["ceiling"] else SemaphoreKind.MUTEX
    return Semaphore(name=name, kind=kind, ceiling=given["ceiling"])


def _task_allocation(plain: PlainSystem, task: dict[str, Any]) -> TaskAllocation:
    is_edf = plain["cores"][task["core"]] == "EDF"
    time_slice = (Duration(task["slice"] * MICROSECOND),) if "slice" in task else ()
    return TaskAllocation(
        task=task["name"],
        scheduler=_scheduler(task["core"]),
        priority=None if is_edf else task["priority"],
        deadline=task["deadline"] * MICROSECOND if is_edf else None,
        parameters=(Parameter("timeSliceLength", time_slice),) if time_slice else (),
    )


def _stimulus(process: dict[str, Any]) -> Stimulus:
    (kind, given), name = next(iter(process["arrival"].items())), process["name"]
    if kind == "trigger":
        return InterProcess(name=f"go {name}", counter=_counter(given))
    offset = given.get("offset", 0) * MICROSECOND
    if kind == "sporadic":
        distance = _between(given["least"] * MICROSECOND, given["most"] * MICROSECOND)
        return RelativePeriodic(name=f"sometimes {name}", distance=distance, offset=offset)
    jitter = _between(0, given["jitter"] * MICROSECOND) if "jitter" in given else None
    return Periodic(name=f"every {name}", period=given["period"] * MICROSECOND, offset=offset, jitter=jitter)


def _between(least: int, most: int) -> Distribution[int]:
    return Constant(least) if least == most else Boundaries(lower=least, upper=most)


def _counter(given: dict[str, int]) -> Counter | None:
    return Counter(prescaler=given["prescaler"], offset=given["offset"]) if "prescaler" in given else None


def _activity(item: Item, index: int, inner: Any, communication: Communication | None) -> Activity:
    match item:
        case {"execute": [least, most]}:
            return Execute(demand=Demand(ticks=_between(least, most)))
        case {"call": runnable}:
            return Call(runnable=runnable, counter=_counter(item))
        case {"group": body}:
            ordered, interruptible = item.get("ordered", True), item.get("interruptible", True)
            return Group(activities=inner(body), name=f"g{index}", ordered=ordered, interruptible=interruptible)
        case {"switch": branches}:
            return ProbabilitySwitch(branches=tuple(Chance(weight=w, activities=inner(body)) for w, body in branches))
        case {"request": semaphore}:
            return SemaphoreAccess(semaphore=semaphore, operation=SemaphoreOperation.REQUEST, waiting=Waiting.PASSIVE)
        case {"release": semaphore}:
            return SemaphoreAccess(semaphore=semaphore, operation=SemaphoreOperation.RELEASE)
        case {"point": _}:
            return SchedulePoint()
        case {"read": label}:
            return LabelAccess(label=label, kind=AccessKind.READ, communication=communication)
        case {"write": label}:
            return LabelAccess(label=label, kind=AccessKind.WRITE, communication=communication)
        case {"trigger": process}:
            return Trigger(stimulus=f"go {process}", counter=_counter(item))
    raise ValueError(f"unknown item {item!r}")


def _events(plain: PlainSystem) -> Events:
    if "chain" not in plain:
        return Events()
    first, *others = plain["chain"]["processes"]
    begin = ProcessEvent(name="begin", process=first, change=ProcessChange.START)
    ends = [ProcessEvent(name=f"end {name}", process=name, change=ProcessChange.TERMINATE) for name in others]
    names = [begin.name, *(event.name for event in ends)]
    steps = tuple(Segment(stimulus=a, response=b) for a, b in pairwise(names))
    return Events(
        events=(begin, *ends),
        chains=(EventChain(name="chain", stimulus=names[0], response=names[-1], items=Sequence(steps)),),
    )
