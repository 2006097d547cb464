"""What operating system, memory and hardware add to jobs: times by hand, which the simulation has and the analysis covers."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hand_made_systems import Proc, system, ticks

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import (
    AccessKind,
    ClearEvent,
    Demand,
    Execute,
    ExecutionNeed,
    Group,
    LabelAccess,
    SchedulePoint,
    SemaphoreAccess,
    SemaphoreOperation,
    SenderReceiverAccess,
    SetEvent,
    Terminate,
    Trigger,
    WaitEvent,
)
from amalthea_uros.perf.distributions import Boundaries, Constant
from amalthea_uros.perf.hardware import Access, CoreType, Feature, Latency, Memory, Structure
from amalthea_uros.perf.mapping import Placement
from amalthea_uros.perf.os import IsrOverhead, Overhead, Policy, Scheduler, Semaphore, SemaphoreKind, Service
from amalthea_uros.perf.software import IsrCategory, Label, OsEvent
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.settings import MemoryModel as MemoryCost
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import Duration

SCHEDULER = Scheduler(name="s0", policy=Policy.OSEK, cores=("c0",))


def job(name, body, priority=1, period=10_000, offset=0):
    return Proc(name, tuple(body), period, offset, priority=priority)


def interrupt(name, number, priority=0, category=None, offset=0):
    return Proc(name, (ticks(number),), 10_000, offset, priority=priority, is_isr=True, task={"category": category})


def with_overhead(*processes, overhead, **parts):
    """A system of some processes whose operating system has an overhead."""
    model = system(*processes, **parts)
    (running,) = model.os.systems
    return replace(model, os=replace(model.os, systems=(replace(running, overhead=overhead.name),), overheads=(overhead,)))


def microseconds(found):
    return Fraction(found) / US


def responses(system, mode=Mode.WORST, **settings):
    """The longest simulated response times in microseconds, which must be within the bounds of the analysis."""
    settings = Settings(**settings)
    found = simulate_system(system, Options(duration=Duration(100 * MS), mode=mode, settings=settings))
    bounds = analyze_system(system, settings).processes
    for process in found.processes:
        bound = bounds[process.name].response
        assert bound.best <= process.response_time.min, process.name
        assert process.response_time.max <= bound.worst, process.name
    return {process.name: microseconds(process.response_time.max) for process in found.processes}


# Decisions of the scheduler.

DECIDING = replace(SCHEDULER, overhead=(ticks(5),))


def test_a_scheduler_decides_when_a_task_is_activated_and_when_it_ends():
    assert responses(system(job("only", [ticks(100)]), schedulers=[DECIDING])) == {"only": 5 + 100 + 5}


def test_decisions_precede_all_tasks():
    high = job("high", [ticks(20)], priority=2, offset=100)
    low = job("low", [ticks(200)], priority=1)
    found = responses(system(high, low, schedulers=[DECIDING]))
    # The decision for "high" and its job delay "low", too.
    assert found == {"high": 5 + 20 + 5, "low": (5 + 200 + 5) + (5 + 20 + 5)}


def test_a_decision_for_a_task_of_lower_priority_delays_the_running_one():
    high = job("high", [ticks(50)], priority=2)
    low = job("low", [ticks(10)], priority=1, offset=20)
    found = responses(system(high, low, schedulers=[DECIDING]))
    assert found == {"high": 5 + 50 + 5 + 5, "low": 5 + (65 - 20 - 5) + 10 + 5}


def test_the_load_of_a_core_includes_decisions():
    model = system(job("only", [ticks(90)], period=1000), schedulers=[DECIDING])
    found = simulate_system(model, Options(duration=Duration(100 * MS)))
    assert (found.cores["c0"].load, found["only"].load) == (Fraction(1, 10), Fraction(95, 1000))


# Services.

_LOCKED = [
    SemaphoreAccess(semaphore="lock", operation=operation) for operation in SemaphoreOperation if operation != "exclusive"
]


@pytest.mark.parametrize(
    ("activities", "services", "kind"),
    [
        ([Trigger(stimulus="other")], [Service.ACTIVATE_TASK], None),
        ([Terminate()], [Service.TERMINATE_TASK], None),
        ([SchedulePoint()], [Service.SCHEDULE], None),
        ([SetEvent(events=("event",), process="task")], [Service.SET_EVENT], None),
        ([ClearEvent(events=("event",))], [Service.CLEAR_EVENT], None),
        (
            [SetEvent(events=("event",), process="task"), WaitEvent(events=("event",)), ClearEvent(events=("event",))],
            [Service.SET_EVENT, Service.WAIT_EVENT, Service.CLEAR_EVENT],
            None,
        ),
        (_LOCKED, [Service.REQUEST_RESOURCE, Service.RELEASE_RESOURCE], SemaphoreKind.RESOURCE),
        (_LOCKED, [Service.REQUEST_SPINLOCK, Service.RELEASE_SPINLOCK], SemaphoreKind.SPINLOCK),
        ([Group(activities=(ticks(7),), interruptible=False)], [Service.SUSPEND_INTERRUPTS, Service.RESUME_INTERRUPTS], None),
        ([SenderReceiverAccess(label="label", kind=AccessKind.READ)], [Service.SENDER_RECEIVER_READ], None),
        ([SenderReceiverAccess(label="label", kind=AccessKind.WRITE)], [Service.SENDER_RECEIVER_WRITE], None),
    ],
    ids=lambda value: "+".join(map(str, value)) if isinstance(value, list) and isinstance(value[0], Service) else "",
)
def test_services_add_to_the_time_of_their_callers(activities, services, kind):
    costs = {service: 2**number for number, service in enumerate(Service)}
    overhead = Overhead(name="overhead", services=tuple((service, ticks(cost).demand) for service, cost in costs.items()))
    model = with_overhead(
        job("task", [ticks(100), *activities], period=2**24),
        overhead=overhead,
        triggers=("other",),
        os_events=(OsEvent(name="event"),),
        labels=(Label(name="label"),),
        semaphores=(Semaphore(name="lock", kind=kind),),
    )
    inside = sum(7 for activity in activities if isinstance(activity, Group))
    found = simulate_system(model, Options(duration=Duration(2000 * MS)))
    expected = 100 + inside + sum(costs[service] for service in services)
    assert microseconds(found["task"].response_time.max) == expected
    response = analyze_system(model).processes["task"].response
    assert response is None or microseconds(response.worst) == expected


# Interrupts.

AROUND = Overhead(
    name="overhead",
    category_1=IsrOverhead(before=ticks(1).demand, after=ticks(2).demand),
    category_2=IsrOverhead(before=ticks(8).demand, after=ticks(16).demand),
)


@pytest.mark.parametrize(
    ("category", "expected"),
    [(IsrCategory.CATEGORY_1, 1 + 10 + 2), (IsrCategory.CATEGORY_2, 8 + 10 + 16), (None, 8 + 10 + 16)],
)
def test_entry_and_exit_of_an_interrupt_delay_the_interrupted_task(category, expected):
    model = with_overhead(job("task", [ticks(100)]), interrupt("isr", 10, category=category, offset=50), overhead=AROUND)
    assert responses(model) == {"task": 100 + expected, "isr": expected}


def test_an_interrupt_of_lower_priority_waits_for_the_exit_of_the_other():
    isrs = interrupt("second", 10, category=IsrCategory.CATEGORY_1), interrupt("first", 10, 1, IsrCategory.CATEGORY_2)
    assert responses(with_overhead(*isrs, overhead=AROUND)) == {"second": 34 + 13, "first": 34}


# Memory.

_LATENCY = Latency(read=Constant(7), write=Constant(3))


def with_labels(*activities):
    model = system(job("task", activities), labels=(Label(name="in"), Label(name="out")))
    ecu, *_ = model.hardware.structures
    cores = tuple(replace(core, accesses=(Access(memory="RAM", latency=_LATENCY),)) for core in ecu.cores)
    structures = (replace(ecu, cores=cores), Structure(name="memories", memories=(Memory(name="RAM"),)))
    placements = (Placement(element="in", memory="RAM"), Placement(element="out", memory="RAM"))
    hardware, mapping = replace(model.hardware, structures=structures), replace(model.mapping, placements=placements)
    return replace(model, hardware=hardware, mapping=mapping)


READ_AND_WRITE = with_labels(
    LabelAccess(label="in", kind=AccessKind.READ), ticks(100), LabelAccess(label="out", kind=AccessKind.WRITE)
)


@pytest.mark.parametrize(
    ("memory", "mode", "expected"),
    [
        (MemoryCost.NONE, Mode.WORST, 100),
        (MemoryCost.EXPLICIT, Mode.WORST, 7 + 100 + 3),
        (MemoryCost.EXPLICIT, Mode.BEST, 7 + 100 + 3),
        # Both labels are copied at the start, and "out" at the end; an access to a copy takes no longer than one to the label.
        (MemoryCost.IMPLICIT, Mode.WORST, (7 + 7) + (7 + 100 + 3) + 3),
        (MemoryCost.IMPLICIT, Mode.BEST, (7 + 7) + 100 + 3),
    ],
)
def test_accesses_take_time(memory, mode, expected):
    assert responses(READ_AND_WRITE, mode, memory=memory) == {"task": expected}


def test_several_accesses_take_several_times():
    system = with_labels(ticks(100), LabelAccess(label="in", kind=AccessKind.READ, times=4))
    assert responses(system, memory=MemoryCost.EXPLICIT) == {"task": 100 + 4 * 7}


# Ticks.

_FEATURES = (
    Feature(category="Instructions", name="IPC_1.0", value=0.5),
    Feature(category="Pixels", name="ticks", value=3.0),
)


def on_typed_core(activity):
    model = system(job("task", [activity]))
    ecu, *_ = model.hardware.structures
    structures = (replace(ecu, cores=tuple(replace(core, type="type") for core in ecu.cores)),)
    hardware = replace(model.hardware, structures=structures, core_types=(CoreType(name="type", features=_FEATURES),))
    return replace(model, hardware=hardware)


@pytest.mark.parametrize(
    ("need", "amount", "expected"),
    [("Instructions", 50, 100), ("Pixels", 50, 150)],
)
def test_execution_needs_become_ticks_by_the_type_of_the_core(need, amount, expected):
    assert responses(on_typed_core(ExecutionNeed(needs=((need, Constant(amount)),)))) == {"task": expected}


def test_ticks_for_the_type_of_the_core_replace_the_others():
    demand = Demand(ticks=Constant(1), by_core_type=(("type", Constant(60)), ("another type", Constant(70))))
    assert responses(on_typed_core(Execute(demand=demand))) == {"task": 60}


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ({"frequencies": {"c0": Fraction(2_000_000)}}, Fraction(100 + 8 + 10 + 16, 2)),
        # A tick is 1/300 us, which no whole number of picoseconds is.
        ({"frequencies": {"c0": Fraction(300_000_000)}}, Fraction(100 + 8 + 10 + 16, 300)),
        ({"scale": Fraction(3, 2)}, Fraction(3 * (100 + 8 + 10 + 16), 2)),
    ],
)
def test_clocks_and_scale_apply_to_work_and_overheads(settings, expected):
    model = with_overhead(job("task", [ticks(100)]), interrupt("isr", 10), overhead=AROUND)
    found = simulate_system(model, Options(duration=Duration(100 * MS), settings=Settings(**settings)))
    assert microseconds(found["task"].response_time.max) == expected
    # In whole picoseconds, a bound is rounded up.
    worst = microseconds(analyze_system(model, Settings(**settings)).processes["task"].response.worst)
    assert 0 <= worst - expected < Fraction(1, 10**6)


def test_overheads_that_vary_are_longest_in_the_worst_case_and_shortest_in_the_best():
    varying = Demand(ticks=Boundaries(lower=1, upper=9))
    overhead = Overhead(name="overhead", category_2=IsrOverhead(before=varying, after=varying))
    scheduler = replace(SCHEDULER, overhead=(Execute(demand=varying),))
    processes = job("task", [ticks(100)], offset=50), interrupt("isr", 10)
    model = with_overhead(*processes, overhead=overhead, schedulers=[scheduler])
    assert responses(model) == {"task": 9 + 100 + 9, "isr": 9 + 10 + 9}
    assert responses(model, Mode.BEST) == {"task": 1 + 100 + 1, "isr": 1 + 10 + 1}
