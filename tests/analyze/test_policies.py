"""Scheduling policies, overheads of the operating system and memory, and modes; all values are computed by hand."""

from dataclasses import replace
from fractions import Fraction

import pytest
from effort import examples
from hand_made_systems import changed, locked, of_parts, read, ticks, write
from hypothesis import given
from hypothesis import strategies as st
from system_strategies import systems

from amalthea_uros.analyze.priorities.assignment import propose_priorities
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf import conditions, hardware, mapping, os
from amalthea_uros.perf.activities import (
    Call,
    Case,
    Count,
    Demand,
    ExecutionNeed,
    Group,
    RaiseEvent,
    Receive,
    SchedulePoint,
    Send,
    Switch,
    Terminate,
    WaitEvent,
)
from amalthea_uros.perf.distributions import Boundaries, Constant, Gauss
from amalthea_uros.perf.events import CustomEvent, Events, LabelChange, LabelEvent
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Duration, Overhead, Parameter, Parent, Policy, Scheduler, Service
from amalthea_uros.perf.software import Channel, Isr, IsrCategory, Label, Preemption, Runnable, Task
from amalthea_uros.perf.stimuli import EventTriggered, Periodic, RelativePeriodic
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.timing.basics.settings import MemoryModel, Settings
from amalthea_uros.units import MICROSECOND as US


def system(schedulers, tasks, stimuli=(), events=(), isrs=(), isr_allocations=(), labels=(), runnables=(), **os_parts):
    """A core of 1 MHz, and tasks of (name, minimum distance in us, activities, allocation)."""
    sporadic = [
        RelativePeriodic(name=f"every {name}", distance=Boundaries(lower=distance * US, upper=2 * distance * US))
        for name, distance, _, _ in tasks
        if distance
    ]
    return of_parts(
        [Task(name=name, stimuli=(f"every {name}",), activities=tuple(body)) for name, _, body, _ in tasks],
        [TaskAllocation(task=name, **allocation) for name, _, _, allocation in tasks],
        [*sporadic, *stimuli],
        schedulers=schedulers,
        overhead="overhead",
        isrs=isrs,
        isr_allocations=isr_allocations,
        labels=labels,
        runnables=runnables,
        os_parts=os_parts,
        events=Events(events=tuple(events)),
    )


def root(policy=Policy.OSEK, **more):
    return Scheduler(name="root", policy=policy, cores=("core",), **more)


def under(name, policy, priority=None, parent="root", **parameters):
    stated = tuple(Parameter(key, (Duration(value * US),)) for key, value in parameters.items())
    return Scheduler(name=name, policy=policy, parent=Parent(scheduler=parent, priority=priority), parameters=stated)


def on(scheduler="root", priority=1, **more):
    """An allocation."""
    return {"scheduler": scheduler, "priority": priority} | more


def stated(key, value):
    return {"parameters": (Parameter(key, (value,)),)}


def worst(built, settings=None):
    """Of each process the longest response time in us, or why there is none."""
    processes = analyze_system(built, settings).processes
    return {
        each.name: each.response.worst // US if each.response and each.response.worst else each.reason for each in processes
    }


def alone(*body, settings=None, runnables=()):
    """What is known of one task with some activities: its shortest and longest execution time in us, or why they are not known."""
    (process,) = analyze_system(system([root()], [("T", 1000, body, on())], runnables=runnables), settings).processes
    return process.reason or (process.bcet // US, process.wcet // US)


EDF, RR = Policy.EARLIEST_DEADLINE_FIRST, Policy.PRIORITY_BASED_ROUND_ROBIN
SLICE = stated("timeSliceLength", Duration(2 * US))


@pytest.mark.parametrize(
    ("policy", "tasks", "expected"),
    [
        pytest.param(
            EDF,
            # The short one, activated one after the long one, has the same deadline.
            [("short", 4, [ticks(1)], on(deadline=4 * US)), ("long", 6, [ticks(3)], on(deadline=5 * US))],
            {"short": 3, "long": 4},
            id="Spuri 1996",
        ),
        pytest.param(EDF, [("T", 4, [ticks(1)], on())], {"T": 1}, id="EDF without a deadline"),
        *(
            pytest.param(
                policy,
                [
                    ("slow", 20, [ticks(3)], on(deadline=20 * US, **stated("period", Duration(20 * US)))),
                    ("fast", 10, [ticks(2)], on(deadline=10 * US, **stated("period", Duration(10 * US)))),
                ],
                {"slow": 5, "fast": 2},
                id=policy,
            )
            for policy in (Policy.DEADLINE_MONOTONIC, Policy.RATE_MONOTONIC)
        ),
        pytest.param(
            RR,
            # A needs three slices, and B gets one before each, and another one if `high` preempts it: 5 + 3 * 2 + 2, and 3 above;
            # B waits for all of A.
            [
                ("A", 100, [ticks(5)], on(**SLICE)),
                ("B", 100, [ticks(20)], on(**SLICE)),
                ("high", 100, [ticks(3)], on(priority=2, **SLICE)),
            ],
            {"A": 16, "B": 28, "high": 3},
            id="round robin",
        ),
        pytest.param(
            Policy.OSEK,
            # Jobs that are activated later wait: each of the other tasks interferes only once.
            [("A", 100, [ticks(5)], on()), ("B", 100, [ticks(5)], on()), ("often", 8, [ticks(2)], on())],
            {"A": 12, "B": 12, "often": 12},
            id="equal priorities",
        ),
        pytest.param(
            Policy.OSEK,
            # Those up to the ceiling of the group wait for ten of `low`; its last five are interrupted by `top` only.
            [
                ("top", 100, [ticks(1)], on(priority=4)),
                ("high", 100, [ticks(2)], on(priority=3, **stated("taskGroup", 1))),
                ("other", 100, [ticks(3)], on(priority=2)),
                ("low", 100, [ticks(10), SchedulePoint(), ticks(5)], on(**stated("taskGroup", 1))),
            ],
            {"top": 1, "high": 13, "other": 16, "low": 21},
            id="a group is not interrupted from within",
        ),
    ],
)
def test_policies(policy, tasks, expected):
    assert worst(system([root(policy)], tasks)) == expected


def test_group_0_is_no_group():
    none = stated("taskGroup", 0)
    tasks = [("high", 100, [ticks(2)], on(priority=2, **none)), ("low", 100, [ticks(10)], on(**none))]
    built = system([root()], tasks)
    assert worst(built) == {"high": 2, "low": 12}
    assert "task group 0 of OSEK schedulers means that a task is in no group" in analyze_system(built).assumptions


def test_waiting_for_events_has_no_bound():
    assert alone(ticks(1), WaitEvent(events=("e",))).startswith("it waits for events")


class TestSchedulersBelowEachOther:
    TASKS = (
        ("urgent", 100, [ticks(3)], on("child", 1)),
        ("main", 100, [ticks(5)], on("root", 5)),
        ("urgent too", 100, [ticks(4)], on("child", 9)),
    )

    @pytest.mark.parametrize(
        ("policy", "priority", "expected"),
        [(Policy.OSEK, 7, (7, 12, 4)), (Policy.OSEK, 3, (12, 5, 9)), (Policy.GROUPING, None, (12, 9, 4))],
        ids=["above", "below", "a grouping delegates to its parent"],
    )
    def test_the_parent_decides_first(self, policy, priority, expected):
        assert tuple(worst(system([root(), under("child", policy, priority)], self.TASKS)).values()) == expected

    def test_deadlines_below_a_priority(self):
        tasks = [
            ("first", 100, [ticks(2)], on(priority=5)),
            ("short", 4, [ticks(1)], on("child", deadline=4 * US)),
            ("long", 60, [ticks(3)], on("child", deadline=60 * US)),
        ]
        # `long` is held up by one job of `first` and two of `short`.
        assert worst(system([root(), under("child", EDF, 1)], tasks)) == {"first": 2, "short": 3, "long": 7}

    @pytest.mark.parametrize("policy", [Policy.OSEK, "AUTOSAR", "osek", "FPP"])
    def test_two_children_of_one_priority_are_not_analysed(self, policy):
        built = system([root(policy), under("child", Policy.OSEK, 5)], self.TASKS)
        assert "shares its priority in 'root' with others" in worst(built)["urgent"]


class TestServers:
    """Servers that have the highest priority if nothing else is said, so that they get their budgets at once."""

    NOT_GUARANTEED = "the server 'server' is not guaranteed its budget in each period"
    BEYOND = "'inside' in the server 'server' cannot be preempted everywhere, and may go on beyond its budget"

    def served(self, policy, *tasks, capacity=2, period=10, preemption=None, **parts):
        schedulers = [root(**parts.pop("root", {})), under("server", policy, 5, capacity=capacity, period=period)]
        return changed(system(schedulers, tasks, **parts), **(preemption or {}))

    @pytest.mark.parametrize(
        ("policy", "inside", "below"),
        [
            # The job is activated when the budget has just been used up: 8 of waiting, 2, 8 of waiting, 1. A deferred budget can be
            # used just before the next one, so that the task below waits for two of them.
            (Policy.DEFERRABLE_SERVER, 8 + 2 + 8 + 1, 5 + 2 + 2),
            (Policy.SPORADIC_SERVER, 8 + 2 + 8 + 1, 5 + 2),
            # The job is activated just after the polling: it waits for the whole period.
            (Policy.POLLING_SERVER, 10 + 2 + 8 + 1, 5 + 2),
        ],
    )
    def test_two_in_ten(self, policy, inside, below):
        built = self.served(policy, ("inside", 100, [ticks(3)], on("server")), ("below", 100, [ticks(5)], on()))
        assert worst(built) == {"inside": inside, "below": below}

    @pytest.mark.parametrize("priorities", [(3, None), (None, 3), (None, None)])
    def test_tasks_without_priority_are_served_in_any_order(self, priorities):
        # 5 of waiting, 7 of budget, 5 of waiting; both tasks in it, 2 and 6, end one after the other: 5 + 7 + 5 + 1.
        first, second = priorities
        tasks = ("short", 100, [ticks(2)], on("server", first)), ("long", 100, [ticks(6)], on("server", second))
        assert worst(self.served(Policy.DEFERRABLE_SERVER, *tasks, capacity=7, period=12)) == {"short": 18, "long": 18}

    def test_a_task_alone_in_a_server_needs_no_priority(self):
        inside = ("inside", 100, [ticks(2)], on("server", None))
        assert worst(self.served(Policy.DEFERRABLE_SERVER, inside, capacity=7, period=12)) == {"inside": 7}

    @pytest.mark.parametrize(
        ("preemption", "body", "longest"),
        [
            (Preemption.PREEMPTIVE, [ticks(4)], 8 + 2 + 8 + 1),
            (Preemption.COOPERATIVE, [ticks(4)], 8 + 2 + 8 + 1),
            # The budget begins 4 late, just after one that was in time.
            (Preemption.NON_PREEMPTIVE, [ticks(4)], 8 + 4 + 2 + 8 + 1),
            (Preemption.PREEMPTIVE, [ticks(1), Group(activities=(ticks(4),), interruptible=False)], 8 + 4 + 2 + 8 + 1),
            (Preemption.NON_PREEMPTIVE, [ticks(9)], NOT_GUARANTEED),
            (Preemption.NON_PREEMPTIVE, [WaitEvent(events=("E",))], "'below', which could not be analysed, can block it"),
        ],
    )
    def test_what_is_not_preempted_below_a_server_delays_its_budget(self, preemption, body, longest):
        built = self.served(Policy.DEFERRABLE_SERVER, ("inside", 100, [ticks(3)], on("server")), ("below", 100, body, on()))
        assert worst(changed(built, "below", preemption=preemption))["inside"] == longest

    def test_a_task_of_the_priority_of_a_server_waits_for_each_of_its_budgets(self):
        # A job in the server that came first goes on in its next budget, before the task.
        tasks = ("inside", 100, [ticks(10)], on("server")), ("beside", 100, [ticks(15)], on(priority=5))
        assert worst(self.served(Policy.POLLING_SERVER, *tasks, capacity=8, period=20))["beside"] == 15 + 2 * 8

    @pytest.mark.parametrize(("ends_with_access", "longest"), [(False, 22), (True, 30)])
    def test_an_access_at_the_end_of_a_budget_can_wait_for_the_next_one(self, ends_with_access, longest):
        # 10 of waiting after the polling, 2, 8 of waiting, 2: the budget ends just when the demand is served, before the access.
        body = [ticks(4), *([read("L")] if ends_with_access else [])]
        built = self.served(Policy.POLLING_SERVER, ("inside", 100, body, on("server")), labels=[Label(name="L")])
        assert worst(built) == {"inside": longest}

    def test_a_server_that_does_not_get_its_budget(self):
        tasks = ("inside", 100, [ticks(3)], on("server")), ("above", 10, [ticks(9)], on(priority=9))
        assert worst(self.served(Policy.POLLING_SERVER, *tasks)) == {"inside": self.NOT_GUARANTEED, "above": 9}

    def test_a_task_in_a_server_that_is_not_preempted_everywhere(self):
        group = Group(activities=(ticks(2),), interruptible=False)
        built = self.served(
            Policy.POLLING_SERVER,
            ("inside", 100, [group], on("server")),
            ("above", 20, [ticks(9)], on(priority=9)),
            ("below", 100, [ticks(1)], on()),
        )
        # It may go on beyond its budget, which nobody states; then it delays what is below as well, and what is above delays it later.
        assert worst(built) == dict.fromkeys(("inside", "above", "below"), self.BEYOND)
        analysis = analyze_system(built)
        # One cause, stated once, and no finding for each task.
        assert closing_line(analysis.summary).endswith(f"because of 'inside': {self.BEYOND}")
        assert not any(self.BEYOND in finding.message for finding in analysis.findings)

    def test_cooperative_tasks_in_a_server_and_below_it(self):
        built = self.served(
            Policy.POLLING_SERVER,
            ("inside", 100, [ticks(4)], on("server")),
            ("above", 20, [ticks(9)], on(priority=9)),
            ("below", 100, [ticks(30)], on()),
            period=20,
        )
        found = worst(changed(built, preemption=Preemption.COOPERATIVE))
        # Each can keep off the other ones up to its end, whatever the budget is.
        assert found["above"] == self.BEYOND
        assert found["inside"] == "'below' is cooperative, and can block cooperative tasks in the server 'server'"

    def test_decisions_above_a_server(self):
        tasks = ("inside", 100, [ticks(3)], on("server")), ("below", 100, [ticks(5)], on())
        found = worst(self.served(Policy.POLLING_SERVER, *tasks, root={"overhead": (ticks(1),)}))
        # Whether the root also decides when jobs in the server come and end, and when a budget ends, is not stated.
        assert found["inside"] == "'root', above its scheduler, needs time to decide, and nobody states when it does"
        assert isinstance(found["below"], str)

    def test_periodic_releases_and_a_server_are_no_exact_schedule(self):
        tasks = ("T", None, [ticks(5)], on()), ("I", 90, [ticks(1)], on("server", None))
        built = self.served(Policy.POLLING_SERVER, *tasks, stimuli=[Periodic(name="every T", period=100 * US)])
        claims = {process.name: process.response.claim for process in analyze_system(built).processes}
        assert claims == {"T": "bound", "I": "bound"}


class TestCosts:
    def test_scheduling_decisions_at_activation_and_end(self):
        tasks = [("T", 100, [ticks(5)], on()), ("low", 100, [ticks(10)], on(priority=0))]
        # Of each task one decision in its own demand, and one when it arrives, whoever is running.
        assert worst(system([root(overhead=(ticks(1),))], tasks)) == {"T": 5 + 1 + 2, "low": 10 + 1 + 2 + 6}

    def test_services_and_interrupts(self):
        services = ((Service.REQUEST_RESOURCE, Demand(Constant(1))), (Service.RELEASE_RESOURCE, Demand(Constant(2))))
        around = os.IsrOverhead(before=Demand(Constant(3)), after=Demand(Constant(4)))
        built = system(
            [root()],
            [("T", 100, locked("S", 5), on())],
            isrs=[Isr(name="I", stimuli=("every T",), activities=(ticks(1),), category=IsrCategory.CATEGORY_2)],
            isr_allocations=[mapping.IsrAllocation(isr="I", controller="controller")],
            interrupt_controllers=[os.InterruptController(name="controller", cores=("core",))],
            overheads=(Overhead(name="overhead", services=services, category_2=around),),
            semaphores=(os.Semaphore(name="S", kind=os.SemaphoreKind.RESOURCE, ceiling=True),),
        )
        assert worst(built) == {"T": 1 + 5 + 2 + 8, "I": 3 + 1 + 4}

    @pytest.mark.parametrize(
        ("memory", "expected"),
        [
            (MemoryModel.NONE, 1),
            (MemoryModel.EXPLICIT, 1 + 4 * 9 + 2),
            # Copies of both labels at the start, of the one that is written at the end, and the accesses to them.
            (MemoryModel.IMPLICIT, 1 + 4 * 9 + 2 + 9 + 2 + 2),
        ],
    )
    def test_memory(self, memory, expected):
        several = replace(read("far"), times=Count(least=1, mean=2.0, most=3))
        built = self.with_memory(several, read("far"), write("near"), ticks(1))
        assert worst(built, Settings(memory=memory)) == {"T": expected}

    def with_memory(self, *body):
        """A memory at 2 cycles to write, and one after a bus of half the clock: 1 on the way, 2 * 3 there, 2 of its own."""
        labels = [Label(name="far", size=32), Label(name="near", size=8)]
        built = system([root()], [("T", 1000, body, on())], labels=labels)

        def latency(cycles):
            return hardware.Latency(read=Constant(cycles), write=Constant(cycles))

        accesses = (
            hardware.Access(memory="local", latency=latency(2)),
            hardware.Access(memory="global", latency=latency(100), path=("wire", "bus")),
        )
        structure = Structure(
            name="ECU",
            cores=(Core(name="core", clock="clock", accesses=accesses),),
            memories=(hardware.Memory(name="local"), hardware.Memory(name="global", clock="clock", latency=Constant(2))),
            interconnects=(hardware.Interconnect(name="bus", clock="slow", latency=latency(3)),),
            connections=(hardware.Connection(name="wire", source="core", target="bus", latency=latency(1)),),
        )
        clocks = (Clock(name="clock", frequency=Fraction(10**6)), Clock(name="slow", frequency=Fraction(10**6, 2)))
        placements = tuple(mapping.Placement(element=e, memory=m) for e, m in (("far", "global"), ("near", "local")))
        return replace(
            built,
            hardware=Hardware(clocks=clocks, structures=(structure,)),
            mapping=replace(built.mapping, placements=placements),
        )

    def test_an_access_with_cycles_and_a_data_rate_takes_the_shorter_one_at_least_and_both_at_most(self):
        # 8 bits at 2 Mbit/s take 4 us, and the cycles of the access 2 us.
        built = self.with_memory(write("near"), ticks(1))
        (structure,) = built.hardware.structures
        (core,) = structure.cores
        local = replace(core.accesses[0], latency=replace(core.accesses[0].latency, rate=2 * 10**6))
        structure = replace(structure, cores=(replace(core, accesses=(local, core.accesses[1])),))
        built = replace(built, hardware=replace(built.hardware, structures=(structure,)))
        process = analyze_system(built, Settings(memory=MemoryModel.EXPLICIT))["T"]
        assert (process.bcet / US, process.wcet / US) == (1 + 2, 1 + 2 + 4)

    @pytest.mark.parametrize(
        ("change", "reason"),
        [
            ({"placements": ()}, "'far' is not mapped to a memory"),
            ({"accesses": ()}, "the core 'core' has no access element for the memory 'global'"),
            ({"clock": None}, "the clock frequency of 'bus' is unknown"),
            ({"latency": hardware.Latency(rate=8)}, "the size of data that pass 'bus' is unknown"),
            ({"latency": hardware.Latency(rate=8), "size": -8}, "the size of data that pass 'bus' is negative"),
            ({"latency": hardware.Latency(rate=-8), "size": 8}, "the data rate of 'bus' is negative"),
            ({"latency": hardware.Latency(read=Gauss(mean=1.0, deviation=1.0))}, "the memory latency of 'bus' has no bounds"),
        ],
        ids=["no memory", "no access", "no clock", "no size", "negative size", "negative rate", "no bounds"],
    )
    def test_an_access_of_unknown_latency_takes_an_unknown_time(self, change, reason):
        built = self.with_memory(read("far"), ticks(1))
        (structure,) = built.hardware.structures
        (core,), (bus,) = structure.cores, structure.interconnects
        structure = replace(
            structure,
            cores=(replace(core, accesses=change.get("accesses", core.accesses)),),
            interconnects=(replace(bus, clock=change.get("clock", bus.clock), latency=change.get("latency", bus.latency)),),
        )
        built = replace(
            built,
            hardware=replace(built.hardware, structures=(structure,)),
            software=replace(built.software, labels=(Label(name="far", size=change.get("size")),)),
            mapping=replace(built.mapping, placements=change.get("placements", built.mapping.placements)),
        )
        assert worst(built, Settings(memory=MemoryModel.EXPLICIT)) == {"T": reason}

    def test_several_ways_to_a_memory(self):
        built = self.with_memory(read("far"), ticks(1))
        (structure,) = built.hardware.structures
        (core,) = structure.cores
        quick = hardware.Access(memory="global", latency=hardware.Latency(read=Constant(4)))
        structure = replace(structure, cores=(replace(core, accesses=(*core.accesses, quick)),))
        built = replace(built, hardware=replace(built.hardware, structures=(structure,)))
        (process,) = analyze_system(built, Settings(memory=MemoryModel.EXPLICIT)).processes
        # 9 by the bus, 4 without it and 2 of the memory itself; 1 for the rest.
        assert (process.bcet // US, process.wcet // US) == (7, 10)

    def test_elements_of_channels(self):
        body = (Send(channel="far", elements=3), Receive(channel="far", elements=2, at_least=1), ticks(1))
        built = self.with_memory(*body)
        built = replace(built, software=replace(built.software, labels=(), channels=(Channel(name="far", element_size=8),)))
        (process,) = analyze_system(built, Settings(memory=MemoryModel.EXPLICIT)).processes
        assert (process.bcet // US, process.wcet // US) == ((3 + 1) * 9 + 1, (3 + 2) * 9 + 1)
        assert worst(built) == {"T": 1}

    @pytest.mark.parametrize(
        ("times", "expected"),
        [
            (2.0, (14, 14)),
            (Count(least=0, mean=2.5, most=4), (0, 28)),
            # Between 0 and any number of calls have an average of 2.5, so that no multiple of the demand is a bound.
            (2.5, "a number of calls or accesses, 2.5, is an average without a maximum"),
            (Count(least=0, mean=22.0, most=0), "a number of calls or accesses is "),
            (Count(least=3, mean=2.0, most=1), "a number of calls or accesses is "),
            (Count(least=-1, mean=0.0, most=1), "a number of calls or accesses is "),
            (-1.0, "a number of calls or accesses is "),
            (float("nan"), "a number of calls or accesses is "),
        ],
    )
    def test_numbers_of_calls(self, times, expected):
        found = alone(Call(runnable="R", times=times), runnables=[Runnable(name="R", activities=(ticks(7),))])
        assert found == expected or (isinstance(found, str) and found.startswith(expected))

    @pytest.mark.parametrize(
        ("need", "expected"),
        [
            ("Matrix", (2 * 6, 2 * 6)),
            # The inverse of instructions per cycle.
            ("Vector", (4 * 6, 4 * 6)),
            ("Other", "the type of the core 'core' does not define the ticks for 'Other'"),
        ],
    )
    def test_needs_that_features_of_the_core_meet(self, need, expected):
        features = (
            hardware.Feature(category="Matrix", name="cost", value=2.0),
            hardware.Feature(category="Vector", name="IPC_1", value=0.25),
        )
        built = system([root()], [("T", 1000, [ExecutionNeed(needs=((need, Constant(6)),))], on())])
        whole = Hardware(
            clocks=built.hardware.clocks,
            core_types=(hardware.CoreType(name="type", features=features),),
            structures=(Structure(name="ECU", cores=(Core(name="core", type="type", clock="clock"),)),),
        )
        (process,) = analyze_system(replace(built, hardware=whole)).processes
        assert (process.reason or (process.bcet // US, process.wcet // US)) == expected

    def test_factors_of_single_processes(self):
        assert alone(ticks(5), settings=Settings(factors={"T": Fraction(3)})) == (5, 15)


EARLY = "it can terminate before its last activity, which cannot be analysed"
#: Either 10 or 1.
ENDING = Switch(cases=(Case(activities=(ticks(10), Terminate())),), default=(ticks(1),))


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ([ticks(5), Terminate()], (5, 5)),
        ([ticks(5), Call(runnable="last")], (7, 7)),
        ([Terminate(), ticks(5)], EARLY),
        ([Call(runnable="last"), ticks(5)], EARLY),
        # Never 10 + 5.
        ([ENDING, ticks(5)], EARLY),
        ([ticks(5), ENDING], (6, 15)),
    ],
)
def test_a_job_may_end_at_any_activity_that_terminates_it(body, expected):
    assert alone(*body, runnables=[Runnable(name="last", activities=(ticks(2), Terminate()))]) == expected


def in_mode(mode):
    return Settings(modes={"mode": mode} if mode else {})


class TestModes:
    def condition(self, value, relation=conditions.Relation.EQUAL):
        return conditions.Condition(((conditions.ModeValueIs(label="mode", relation=relation, value=value),),))

    def alternatives(self, short, **by_mode):
        cases = (Case(activities=(ticks(time),), condition=self.condition(mode)) for mode, time in by_mode.items())
        return Switch(cases=tuple(cases), default=(ticks(short),))

    @pytest.mark.parametrize(("mode", "expected"), [(None, (2, 9)), ("on", (9, 9)), ("off", (2, 2)), ("idle", (4, 4))], ids=str)
    def test_a_switch(self, mode, expected):
        assert alone(self.alternatives(4, on=9, off=2), settings=in_mode(mode)) == expected

    @pytest.mark.parametrize(("level", "expected"), [(None, (1, 8)), ("3", (8, 8)), ("2", (1, 1))])
    def test_a_runnable_that_is_only_executed_in_some_modes(self, level, expected):
        runnable = Runnable(name="R", activities=(ticks(7),), condition=self.condition("2", conditions.Relation.GREATER))
        assert alone(ticks(1), Call(runnable="R"), runnables=[runnable], settings=in_mode(level)) == expected

    def test_branches_that_exclude_each_other_are_no_certain_overload(self):
        # 8 of 10 in one mode, 16 of 20 in the other: never both.
        tasks = [("A", 10, [self.alternatives(1, on=8)], on(priority=2)), ("B", 20, [self.alternatives(1, off=16)], on())]
        found = analyze_system(system([root()], tasks))
        assert [process.verdict for process in found.processes] == [Verdict.MET, Verdict.UNKNOWN]
        core = found.processors["core"]
        assert (core.worst, core.at_least, core.is_overloaded) == (Fraction(16, 10), Fraction(15, 100), False)
        assert found.summary.schedulable == "unknown"

    @pytest.mark.parametrize(
        ("mode", "verdict"), [(None, Verdict.UNKNOWN), ("on", Verdict.MET), ("off", Verdict.MISSED)], ids=str
    )
    def test_a_branch_that_may_never_be_taken_misses_no_deadline_for_certain(self, mode, verdict):
        tasks = [("A", 20, [self.alternatives(2, off=16)], on(deadline=10 * US))]
        assert analyze_system(system([root()], tasks), in_mode(mode))["A"].verdict is verdict


class TestEventsThatActivate:
    def respond(self, event, *body):
        stimulus = EventTriggered(name="every second", events=("event",))
        tasks = [("first", 20, [*body, ticks(5)], on(priority=2)), ("second", None, [ticks(4)], on())]
        return worst(system([root()], tasks, stimuli=[stimulus], events=[event]))["second"]

    def test_events_that_software_raises(self):
        assert self.respond(CustomEvent(name="event"), RaiseEvent(event="event")) == 9

    def test_accesses_to_labels(self):
        written, was_read = (
            LabelEvent(name="event", label="L", change=change) for change in (LabelChange.WRITE, LabelChange.READ)
        )
        assert self.respond(written, write("L")) == 9
        assert "no process triggers" in self.respond(was_read, write("L"))

    def test_twice_in_a_job(self):
        twice = (RaiseEvent(event="event"), RaiseEvent(event="event"))
        # Both may be there before the first one is served.
        assert self.respond(CustomEvent(name="event"), *twice) == 13

    @pytest.mark.parametrize("times", [0.5, 2.5, Count(least=0, mean=2.0, most=0)])
    def test_an_average_number_of_accesses_has_no_maximum(self, times):
        """Ten accesses in one of twenty jobs are 0.5 on average; if only a mean is stated, the maximum is not 0."""
        written = LabelEvent(name="event", label="L", change=LabelChange.WRITE)
        averaged = replace(write("L"), times=times)
        unknown = "the maximum number of times that a job of 'first' triggers it is unknown"
        assert self.respond(written, averaged) == unknown
        assert self.respond(written, write("L"), averaged) == unknown

    def test_events_from_outside(self):
        assert "no activity in the model raises" in self.respond(CustomEvent(name="event"))

    def test_a_process_triggered_by_an_unknown_one_is_unknown(self):
        assert "could not be analysed" in self.respond(
            CustomEvent(name="event"), RaiseEvent(event="event"), WaitEvent(events=("e",))
        )


@examples(10)
@given(systems(most=1), st.sampled_from(MemoryModel))
def test_no_system_is_too_strange(system, memory):
    analysis = analyze_system(system, Settings(memory=memory))
    for process in analysis.processes:
        assert process.response is not None or process.reason
    propose_priorities(analysis)


def sliced(slices, body=None, **more):
    """Tasks of a policy without a name, every 100 us, with the time slices that are given as text."""
    rows = [
        (
            name,
            100,
            body or (ticks(4),),
            {"scheduler": "root", "parameters": (Parameter(f"TimeSlice_{name}", (text,)),) if text else ()},
        )
        for name, text in slices.items()
    ]
    return system([root("UserSpecificSchedulingAlgorithm")], rows, **more)


def test_time_slices_bound_the_tasks_of_a_policy_without_a_name():
    found = analyze_system(sliced({"A": "2 us", "B": "3us"}))
    # Two slices of 3 us before the two of A, two of 2 us before the two of B.
    assert [found[name].response.worst / US for name in "AB"] == [4 + 2 * 3, 4 + 2 * 2]


@pytest.mark.parametrize("slices", [{"A": "2 us", "B": ""}, {"A": "2 us", "B": "soon"}, {"A": "2 us"}])
def test_a_policy_without_a_name_is_unknown_unless_several_tasks_all_have_time_slices(slices):
    reason = analyze_system(sliced(slices))["A"].reason
    assert reason == "there is no analysis for the policy UserSpecificSchedulingAlgorithm of its scheduler 'root'"


def test_what_precedes_or_prolongs_time_slices_leaves_them_unknown():
    isr = Isr(name="I", stimuli=("every I",), activities=(ticks(1),))
    found = analyze_system(
        sliced(
            {"A": "2 us", "B": "3 us"},
            stimuli=[RelativePeriodic(name="every I", distance=Boundaries(lower=50 * US, upper=99 * US))],
            isrs=[isr],
            isr_allocations=[mapping.IsrAllocation(isr="I", controller="controller")],
            interrupt_controllers=(os.InterruptController(name="controller", cores=("core",)),),
        )
    )
    assert found["A"].reason == "what precedes it may take a part of its time slices"
    locking = analyze_system(sliced({"A": "2 us", "B": "3 us"}, locked("lock", 4), semaphores=(os.Semaphore(name="lock"),)))
    assert locking["A"].reason == "what cannot be preempted everywhere may prolong time slices on its core"


def test_parameters_as_text_are_kept_in_versions_that_have_them():
    slices = sliced({"A": "2 us", "B": "3us"}, overheads=(Overhead(name="overhead"),))
    written = build_model(slices, "1.2.0")
    assert [each.parameters for each in extract(written).system.mapping.tasks] == [
        (Parameter("TimeSlice_A", ("2 us",)),),
        (Parameter("TimeSlice_B", ("3us",)),),
    ]


def test_round_robin_needs_slices_only_where_a_priority_is_shared():
    rows = [(name, 100, [ticks(4)], {"scheduler": "root", "priority": number}) for number, name in enumerate("CBA")]
    found = analyze_system(system([root(Policy.PRIORITY_BASED_ROUND_ROBIN)], rows))
    assert [found[name].response.worst / US for name in "ABC"] == [4, 8, 12]
    shared = [*rows, ("D", 100, [ticks(4)], {"scheduler": "root", "priority": 0})]
    assert analyze_system(system([root(Policy.PRIORITY_BASED_ROUND_ROBIN)], shared))["D"].reason == "it has no timeSliceLength"


def test_schedulers_of_different_priorities_below_round_robin_need_no_slices():
    # As the example of APP4MC for hierarchical scheduling: B is below A, whatever the priorities of their tasks are.
    schedulers = [root(Policy.PRIORITY_BASED_ROUND_ROBIN), under("A", Policy.OSEK, 20), under("B", Policy.OSEK, 15)]
    rows = [
        ("low", 100, [ticks(4)], {"scheduler": "A", "priority": 1}),
        ("high", 100, [ticks(4)], {"scheduler": "B", "priority": 50}),
    ]
    found = analyze_system(system(schedulers, rows))
    assert [found[name].response.worst / US for name in ("low", "high")] == [4, 8]
    same = [schedulers[0], *(under(name, Policy.OSEK, 20) for name in "AB")]
    assert "shares its priority in 'root' with others" in analyze_system(system(same, rows))["low"].reason
