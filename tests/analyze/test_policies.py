"""Scheduling policies, overheads of the operating system and memory, and modes; all values are computed by hand."""

from dataclasses import replace
from fractions import Fraction

import pytest
from effort import examples
from hand_made_systems import of_parts, ticks
from hypothesis import given
from hypothesis import strategies as st
from system_strategies import systems

from amalthea_uros.analyze.priorities.assignment import propose_priorities
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf import conditions, hardware, mapping, os
from amalthea_uros.perf.activities import (
    AccessKind,
    Call,
    Case,
    Count,
    Demand,
    Group,
    LabelAccess,
    RaiseEvent,
    Receive,
    SchedulePoint,
    SemaphoreAccess,
    SemaphoreOperation,
    Send,
    Switch,
    Terminate,
    WaitEvent,
)
from amalthea_uros.perf.distributions import Boundaries, Constant, Gauss
from amalthea_uros.perf.events import CustomEvent, Events, LabelChange, LabelEvent
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure
from amalthea_uros.perf.mapping import Mapping, TaskAllocation
from amalthea_uros.perf.os import Duration, Overhead, Parameter, Parent, Policy, Scheduler, Service
from amalthea_uros.perf.software import Channel, Isr, IsrCategory, Label, Preemption, Runnable, Task
from amalthea_uros.perf.stimuli import EventTriggered, Periodic, RelativePeriodic
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.timing.basics.settings import MemoryModel, Settings
from amalthea_uros.units import MICROSECOND as US


def system(schedulers, tasks, stimuli=(), events=(), isrs=(), labels=(), runnables=(), **os_parts):
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


def worst(built, settings=None):
    analysis = analyze_system(built, settings)
    return {
        process.name: process.response.worst // US if process.response and process.response.worst else process.reason
        for process in analysis.processes
    }


class TestPolicies:
    def test_earliest_deadline_first(self):
        tasks = [
            ("short", 4, [ticks(1)], {"scheduler": "root", "deadline": 4 * US}),
            ("long", 6, [ticks(3)], {"scheduler": "root", "deadline": 5 * US}),
        ]
        # Spuri 1996: the short one, activated one after the long one, has the same deadline.
        assert worst(system([root(Policy.EARLIEST_DEADLINE_FIRST)], tasks)) == {"short": 3, "long": 4}

    def test_a_task_without_a_deadline_makes_all_others_unknown(self):
        tasks = [("T", 4, [ticks(1)], {"scheduler": "root"})]
        assert worst(system([root(Policy.EARLIEST_DEADLINE_FIRST)], tasks)) == {"T": "it has no deadline"}

    @pytest.mark.parametrize("policy", [Policy.DEADLINE_MONOTONIC, Policy.RATE_MONOTONIC])
    def test_priorities_by_deadline_or_period(self, policy):
        parameters = [(Parameter("period", (Duration(period * US),)),) for period in (20, 10)]
        tasks = [
            ("slow", 20, [ticks(3)], {"scheduler": "root", "deadline": 20 * US, "parameters": parameters[0]}),
            ("fast", 10, [ticks(2)], {"scheduler": "root", "deadline": 10 * US, "parameters": parameters[1]}),
        ]
        assert worst(system([root(policy)], tasks)) == {"slow": 5, "fast": 2}

    def test_round_robin(self):
        slices = (Parameter("timeSliceLength", (Duration(2 * US),)),)
        tasks = [
            ("A", 100, [ticks(5)], {"scheduler": "root", "priority": 1, "parameters": slices}),
            ("B", 100, [ticks(20)], {"scheduler": "root", "priority": 1, "parameters": slices}),
            ("high", 100, [ticks(3)], {"scheduler": "root", "priority": 2, "parameters": slices}),
        ]
        # A needs three slices, and B gets one before each, and another one if `high` preempts it: 5 + 3 * 2 + 2, and 3 above; B waits
        # for all of A.
        assert worst(system([root(Policy.PRIORITY_BASED_ROUND_ROBIN)], tasks)) == {"A": 16, "B": 28, "high": 3}

    def test_equal_priorities_are_served_in_the_order_of_activation(self):
        tasks = [(name, 100, [ticks(5)], {"scheduler": "root", "priority": 1}) for name in ("A", "B")]
        tasks.append(("often", 8, [ticks(2)], {"scheduler": "root", "priority": 1}))
        # Jobs that are activated later wait: each of the other tasks interferes only once.
        assert worst(system([root()], tasks)) == {"A": 12, "B": 12, "often": 12}

    def test_a_group_is_not_interrupted_from_within(self):
        group = (Parameter("taskGroup", (1,)),)
        tasks = [
            ("top", 100, [ticks(1)], {"scheduler": "root", "priority": 4}),
            ("high", 100, [ticks(2)], {"scheduler": "root", "priority": 3, "parameters": group}),
            ("other", 100, [ticks(3)], {"scheduler": "root", "priority": 2}),
            ("low", 100, [ticks(10), SchedulePoint(), ticks(5)], {"scheduler": "root", "priority": 1, "parameters": group}),
        ]
        # Those up to the ceiling of the group wait for ten of `low`; its last five are interrupted by `top` only.
        assert worst(system([root()], tasks)) == {"top": 1, "high": 13, "other": 16, "low": 21}

    def test_group_0_is_no_group(self):
        none = (Parameter("taskGroup", (0,)),)
        tasks = [
            ("high", 100, [ticks(2)], {"scheduler": "root", "priority": 2, "parameters": none}),
            ("low", 100, [ticks(10)], {"scheduler": "root", "priority": 1, "parameters": none}),
        ]
        built = system([root()], tasks)
        assert worst(built) == {"high": 2, "low": 12}
        assert "task group 0 of OSEK schedulers means that a task is in no group" in analyze_system(built).assumptions

    def test_waiting_for_events_has_no_bound(self):
        built = system([root()], [("T", 10, [ticks(1), WaitEvent(events=("e",))], {"scheduler": "root", "priority": 1})])
        assert worst(built)["T"].startswith("it waits for events")


class TestSchedulersBelowEachOther:
    TASKS = (
        ("urgent", 100, [ticks(3)], {"scheduler": "child", "priority": 1}),
        ("main", 100, [ticks(5)], {"scheduler": "root", "priority": 5}),
        ("urgent too", 100, [ticks(4)], {"scheduler": "child", "priority": 9}),
    )

    @pytest.mark.parametrize(("priority", "expected"), [(7, (7, 12, 4)), (3, (12, 5, 9))])
    def test_the_parent_decides_first(self, priority, expected):
        built = system([root(), under("child", Policy.OSEK, priority)], self.TASKS)
        assert tuple(worst(built).values()) == expected

    def test_a_grouping_delegates_to_its_parent(self):
        built = system([root(), under("child", Policy.GROUPING)], self.TASKS)
        assert worst(built) == {"urgent": 12, "main": 9, "urgent too": 4}

    def test_deadlines_below_a_priority(self):
        tasks = [
            ("first", 100, [ticks(2)], {"scheduler": "root", "priority": 5}),
            ("short", 4, [ticks(1)], {"scheduler": "child", "deadline": 4 * US}),
            ("long", 60, [ticks(3)], {"scheduler": "child", "deadline": 60 * US}),
        ]
        built = system([root(), under("child", Policy.EARLIEST_DEADLINE_FIRST, 1)], tasks)
        # `long` is held up by one job of `first` and two of `short`.
        assert worst(built) == {"first": 2, "short": 3, "long": 7}

    @pytest.mark.parametrize("policy", [Policy.OSEK, "AUTOSAR", "osek", "FPP"])
    def test_two_children_of_one_priority_are_not_analysed(self, policy):
        built = system([root(policy), under("child", Policy.OSEK, 5)], self.TASKS)
        assert "shares its priority in 'root' with others" in worst(built)["urgent"]

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
    def test_servers(self, policy, inside, below):
        # The server has the highest priority, so that it gets its budget of 2 in 10 at once.
        tasks = [
            ("inside", 100, [ticks(3)], {"scheduler": "server", "priority": 1}),
            ("below", 100, [ticks(5)], {"scheduler": "root", "priority": 1}),
        ]
        built = system([root(), under("server", policy, 5, capacity=2, period=10)], tasks)
        assert worst(built) == {"inside": inside, "below": below}

    @pytest.mark.parametrize("priorities", [(3, None), (None, 3), (None, None)])
    def test_a_server_serves_tasks_without_priority_in_any_order(self, priorities):
        # 5 of waiting, 7 of budget, 5 of waiting; both tasks in it, 2 and 6, end one after the other: 5 + 7 + 5 + 1.
        tasks = [
            (name, 100, [ticks(demand)], {"scheduler": "server", "priority": priority})
            for name, demand, priority in zip(("short", "long"), (2, 6), priorities, strict=True)
        ]
        built = system([root(), under("server", Policy.DEFERRABLE_SERVER, 5, capacity=7, period=12)], tasks)
        assert worst(built) == {"short": 18, "long": 18}

    def test_a_task_alone_in_a_server_needs_no_priority(self):
        tasks = [("inside", 100, [ticks(2)], {"scheduler": "server", "priority": None})]
        built = system([root(), under("server", Policy.DEFERRABLE_SERVER, 5, capacity=7, period=12)], tasks)
        assert worst(built) == {"inside": 7}

    @pytest.mark.parametrize(
        ("preemption", "body", "longest"),
        [
            (Preemption.PREEMPTIVE, [ticks(4)], 8 + 2 + 8 + 1),
            (Preemption.COOPERATIVE, [ticks(4)], 8 + 2 + 8 + 1),
            # The budget begins 4 late, just after one that was in time.
            (Preemption.NON_PREEMPTIVE, [ticks(4)], 8 + 4 + 2 + 8 + 1),
            (Preemption.PREEMPTIVE, [ticks(1), Group(activities=(ticks(4),), interruptible=False)], 8 + 4 + 2 + 8 + 1),
            (Preemption.NON_PREEMPTIVE, [ticks(9)], "the server 'server' is not guaranteed its budget in each period"),
            (Preemption.NON_PREEMPTIVE, [WaitEvent(events=("E",))], "'below', which could not be analysed, can block it"),
        ],
    )
    def test_what_is_not_preempted_below_a_server_delays_its_budget(self, preemption, body, longest):
        tasks = [
            ("inside", 100, [ticks(3)], {"scheduler": "server", "priority": 1}),
            ("below", 100, body, {"scheduler": "root", "priority": 1}),
        ]
        built = system([root(), under("server", Policy.DEFERRABLE_SERVER, 5, capacity=2, period=10)], tasks)
        inside, below = built.software.tasks
        software = replace(built.software, tasks=(inside, replace(below, preemption=preemption)))
        assert worst(replace(built, software=software))["inside"] == longest

    def test_a_task_of_the_priority_of_a_server_waits_for_each_of_its_budgets(self):
        # A job in the server that came first goes on in its next budget, before the task.
        tasks = [
            ("inside", 100, [ticks(10)], {"scheduler": "server", "priority": 1}),
            ("beside", 100, [ticks(15)], {"scheduler": "root", "priority": 5}),
        ]
        built = system([root(), under("server", Policy.POLLING_SERVER, 5, capacity=8, period=20)], tasks)
        assert worst(built)["beside"] == 15 + 2 * 8

    @pytest.mark.parametrize(("ends_with_access", "longest"), [(False, 22), (True, 30)])
    def test_an_access_at_the_end_of_a_budget_can_wait_for_the_next_one(self, ends_with_access, longest):
        # 10 of waiting after the polling, 2, 8 of waiting, 2: the budget ends just when the demand is served, before the access.
        body = [ticks(4), *([LabelAccess(label="L", kind=AccessKind.READ)] if ends_with_access else [])]
        tasks = [("inside", 100, body, {"scheduler": "server", "priority": 1})]
        built = system(
            [root(), under("server", Policy.POLLING_SERVER, 5, capacity=2, period=10)], tasks, labels=[Label(name="L")]
        )
        assert worst(built)["inside"] == longest

    def test_a_server_that_does_not_get_its_budget(self):
        tasks = [
            ("inside", 100, [ticks(3)], {"scheduler": "server", "priority": 1}),
            ("above", 10, [ticks(9)], {"scheduler": "root", "priority": 9}),
        ]
        built = system([root(), under("server", Policy.POLLING_SERVER, 5, capacity=2, period=10)], tasks)
        assert worst(built) == {"inside": "the server 'server' is not guaranteed its budget in each period", "above": 9}

    def test_a_task_in_a_server_that_is_not_preempted_everywhere(self):
        group = Group(activities=(ticks(2),), interruptible=False)
        tasks = [
            ("inside", 100, [group], {"scheduler": "server", "priority": 1}),
            ("above", 20, [ticks(9)], {"scheduler": "root", "priority": 9}),
            ("below", 100, [ticks(1)], {"scheduler": "root", "priority": 1}),
        ]
        model = system([root(), under("server", Policy.POLLING_SERVER, 5, capacity=2, period=10)], tasks)
        found = worst(model)
        # It may go on beyond its budget, which nobody states; then it delays what is below as well, and what is above delays it later.
        cause = "'inside' in the server 'server' cannot be preempted everywhere, and may go on beyond its budget"
        assert found == dict.fromkeys(("inside", "above", "below"), cause)
        analysis = analyze_system(model)
        # One cause, stated once, and no finding for each task.
        assert closing_line(analysis.summary).endswith(f"because of 'inside': {cause}")
        assert not any(cause in finding.message for finding in analysis.findings)

    def test_cooperative_tasks_in_a_server_and_below_it(self):
        tasks = [
            ("inside", 100, [ticks(4)], {"scheduler": "server", "priority": 1}),
            ("above", 20, [ticks(9)], {"scheduler": "root", "priority": 9}),
            ("below", 100, [ticks(30)], {"scheduler": "root", "priority": 1}),
        ]
        built = system([root(), under("server", Policy.POLLING_SERVER, 5, capacity=2, period=20)], tasks)
        cooperative = [replace(task, preemption=Preemption.COOPERATIVE) for task in built.software.tasks]
        found = worst(replace(built, software=replace(built.software, tasks=tuple(cooperative))))
        # Each can keep off the other ones up to its end, whatever the budget is.
        assert (
            found["above"] == "'inside' in the server 'server' cannot be preempted everywhere, and may go on beyond its budget"
        )
        assert found["inside"] == "'below' is cooperative, and can block cooperative tasks in the server 'server'"

    def test_decisions_above_a_server(self):
        tasks = [
            ("inside", 100, [ticks(3)], {"scheduler": "server", "priority": 1}),
            ("below", 100, [ticks(5)], {"scheduler": "root", "priority": 1}),
        ]
        built = system([root(overhead=(ticks(1),)), under("server", Policy.POLLING_SERVER, 5, capacity=2, period=10)], tasks)
        # Whether the root also decides when jobs in the server come and end, and when a budget ends, is not stated.
        found = worst(built)
        assert found["inside"] == "'root', above its scheduler, needs time to decide, and nobody states when it does"
        assert isinstance(found["below"], str)


class TestCosts:
    ONE = (("T", 100, [ticks(5)], {"scheduler": "root", "priority": 1}),)

    def test_scheduling_decisions_at_activation_and_end(self):
        tasks = [*self.ONE, ("low", 100, [ticks(10)], {"scheduler": "root", "priority": 0})]
        # Of each task one decision in its own demand, and one when it arrives, whoever is running.
        assert worst(system([root(overhead=(ticks(1),))], tasks)) == {"T": 5 + 1 + 2, "low": 10 + 1 + 2 + 6}

    def test_services_and_interrupts(self):
        services = ((Service.REQUEST_RESOURCE, Demand(Constant(1))), (Service.RELEASE_RESOURCE, Demand(Constant(2))))
        overhead = Overhead(
            name="overhead",
            services=services,
            category_2=os.IsrOverhead(before=Demand(Constant(3)), after=Demand(Constant(4))),
        )
        body = [
            SemaphoreAccess(semaphore="S", operation=SemaphoreOperation.REQUEST),
            ticks(5),
            SemaphoreAccess(semaphore="S", operation=SemaphoreOperation.RELEASE),
        ]
        built = system(
            [root()],
            [("T", 100, body, {"scheduler": "root", "priority": 1})],
            isrs=[Isr(name="I", stimuli=("every T",), activities=(ticks(1),), category=IsrCategory.CATEGORY_2)],
            overheads=(overhead,),
            semaphores=(os.Semaphore(name="S", kind=os.SemaphoreKind.RESOURCE, ceiling=True),),
        )
        controller = os.InterruptController(name="controller", cores=("core",))
        (only,) = built.os.systems
        built = replace(
            built,
            os=replace(built.os, systems=(replace(only, interrupt_controllers=(controller,)),)),
            mapping=replace(built.mapping, isrs=(mapping.IsrAllocation(isr="I", controller="controller"),)),
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
        built = self.with_memory(
            LabelAccess(label="far", kind=AccessKind.READ, times=Count(least=1, mean=2.0, most=3)),
            LabelAccess(label="far", kind=AccessKind.READ),
            LabelAccess(label="near", kind=AccessKind.WRITE),
            ticks(1),
        )
        assert worst(built, Settings(memory=memory)) == {"T": expected}

    def with_memory(self, *body):
        """A memory at 2 cycles to write, and one after a bus of half the clock: 1 on the way, 2 * 3 there, 2 of its own."""
        built = system(
            [root()],
            [("T", 1000, body, {"scheduler": "root", "priority": 1})],
            labels=[Label(name="far", size=32), Label(name="near", size=8)],
        )

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

    @pytest.mark.parametrize(
        ("change", "reason"),
        [
            (
                {"mapping": Mapping(tasks=(TaskAllocation(task="T", scheduler="root", priority=1),))},
                "'far' is not mapped to a memory",
            ),
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
        built = self.with_memory(LabelAccess(label="far", kind=AccessKind.READ), ticks(1))
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
            mapping=change.get("mapping", built.mapping),
        )
        assert worst(built, Settings(memory=MemoryModel.EXPLICIT)) == {"T": reason}

    def test_several_ways_to_a_memory(self):
        built = self.with_memory(LabelAccess(label="far", kind=AccessKind.READ), ticks(1))
        (structure,) = built.hardware.structures
        (core,) = structure.cores
        quick = hardware.Access(memory="global", latency=hardware.Latency(read=Constant(4)))
        structure = replace(structure, cores=(replace(core, accesses=(*core.accesses, quick)),))
        (process,) = analyze_system(
            replace(built, hardware=replace(built.hardware, structures=(structure,))), Settings(memory=MemoryModel.EXPLICIT)
        ).processes
        # 9 by the bus, 4 without it and 2 of the memory itself; 1 for the rest.
        assert (process.bcet // US, process.wcet // US) == (7, 10)

    def test_elements_of_channels(self):
        body = (Send(channel="far", elements=3), Receive(channel="far", elements=2, at_least=1), ticks(1))
        built = self.with_memory(*body)
        built = replace(built, software=replace(built.software, labels=(), channels=(Channel(name="far", element_size=8),)))
        (process,) = analyze_system(built, Settings(memory=MemoryModel.EXPLICIT)).processes
        assert (process.bcet // US, process.wcet // US) == ((3 + 1) * 9 + 1, (3 + 2) * 9 + 1)
        assert worst(built) == {"T": 1}

    @pytest.mark.parametrize("times", [Count(least=3, mean=2.0, most=1), Count(least=-1, mean=0.0, most=1), -1.0, float("nan")])
    def test_a_number_of_calls_without_a_meaning(self, times):
        tasks = [("T", 100, [Call(runnable="R", times=times)], {"scheduler": "root", "priority": 1})]
        found = worst(system([root()], tasks, runnables=[Runnable(name="R", activities=(ticks(7),))]))
        assert found["T"].startswith("a number of calls or accesses is ")

    def test_an_average_number_of_calls_has_no_maximum(self):
        """Between 0 and any number of calls have an average of 2.5, so that no multiple of the demand is a bound."""

        def found(times):
            tasks = [("T", 100, [Call(runnable="R", times=times)], {"scheduler": "root", "priority": 1})]
            return worst(system([root()], tasks, runnables=[Runnable(name="R", activities=(ticks(7),))]))["T"]

        assert found(2.5) == "a number of calls or accesses, 2.5, is an average without a maximum"
        assert found(Count(least=0, mean=22.0, most=0)).startswith("a number of calls or accesses is ")
        assert (found(2.0), found(Count(least=0, mean=2.5, most=4))) == (14, 28)

    def test_factors_of_single_processes(self):
        built = system([root()], self.ONE)
        assert worst(built, Settings(factors={"T": Fraction(3)})) == {"T": 15}


class TestTermination:
    """A job may end at any activity that terminates it; what would follow is not executed."""

    EARLY = "it can terminate before its last activity, which cannot be analysed"

    @pytest.mark.parametrize(
        ("body", "expected"),
        [
            ([ticks(5), Terminate()], 5),
            ([ticks(5), Call(runnable="last")], 7),
            ([Terminate(), ticks(5)], EARLY),
            ([Call(runnable="last"), ticks(5)], EARLY),
            # Either 10 or 1 + 5, but never 10 + 5.
            ([Switch(cases=(Case(activities=(ticks(10), Terminate())),), default=(ticks(1),)), ticks(5)], EARLY),
            ([ticks(5), Switch(cases=(Case(activities=(ticks(10), Terminate())),), default=(ticks(1),))], 15),
        ],
    )
    def test_where_it_is(self, body, expected):
        last = Runnable(name="last", activities=(ticks(2), Terminate()))
        built = system([root()], [("T", 100, body, {"scheduler": "root", "priority": 1})], runnables=[last])
        assert worst(built) == {"T": expected}


class TestModes:
    def condition(self, relation, value):
        return conditions.Condition(((conditions.ModeValueIs(label="mode", relation=relation, value=value),),))

    @pytest.mark.parametrize(("mode", "expected"), [(None, 9), ("on", 9), ("off", 2), ("idle", 4)])
    def test_a_switch(self, mode, expected):
        switch = Switch(
            cases=(
                Case(activities=(ticks(9),), condition=self.condition(conditions.Relation.EQUAL, "on")),
                Case(activities=(ticks(2),), condition=self.condition(conditions.Relation.EQUAL, "off")),
            ),
            default=(ticks(4),),
        )
        built = system([root()], [("T", 100, [switch], {"scheduler": "root", "priority": 1})])
        assert worst(built, Settings(modes={"mode": mode} if mode else {})) == {"T": expected}

    @pytest.mark.parametrize(("level", "expected"), [(None, (1, 8)), ("3", (8, 8)), ("2", (1, 1))])
    def test_a_runnable_that_is_only_executed_in_some_modes(self, level, expected):
        runnable = Runnable(name="R", activities=(ticks(7),), condition=self.condition(conditions.Relation.GREATER, "2"))
        tasks = [("T", 100, [ticks(1), Call(runnable="R")], {"scheduler": "root", "priority": 1})]
        built = system([root()], tasks, runnables=[runnable])
        (process,) = analyze_system(built, Settings(modes={"mode": level} if level else {})).processes
        assert (process.bcet // US, process.wcet // US) == expected

    def alternatives(self, value, long, short):
        return Switch(
            cases=(Case(activities=(ticks(long),), condition=self.condition(conditions.Relation.EQUAL, value)),),
            default=(ticks(short),),
        )

    def test_branches_that_exclude_each_other_are_no_certain_overload(self):
        # 8 of 10 in one mode, 16 of 20 in the other: never both.
        tasks = [
            ("A", 10, [self.alternatives("on", 8, 1)], {"scheduler": "root", "priority": 2}),
            ("B", 20, [self.alternatives("off", 16, 1)], {"scheduler": "root", "priority": 1}),
        ]
        found = analyze_system(system([root()], tasks))
        assert [process.verdict for process in found.processes] == [Verdict.MET, Verdict.UNKNOWN]
        core = found.processors["core"]
        assert (core.worst, core.at_least, core.is_overloaded) == (Fraction(16, 10), Fraction(15, 100), False)
        assert found.summary.schedulable == "unknown"

    def test_a_branch_that_may_never_be_taken_misses_no_deadline_for_certain(self):
        tasks = [("A", 20, [self.alternatives("off", 16, 2)], {"scheduler": "root", "priority": 1, "deadline": 10 * US})]
        verdicts = {
            mode: analyze_system(system([root()], tasks), Settings(modes={"mode": mode} if mode else {})).processes["A"].verdict
            for mode in (None, "on", "off")
        }
        assert verdicts == {None: Verdict.UNKNOWN, "on": Verdict.MET, "off": Verdict.MISSED}


class TestEventsThatActivate:
    def respond(self, event, *body):
        stimulus = EventTriggered(name="every second", events=("event",))
        tasks = [
            ("first", 20, [*body, ticks(5)], {"scheduler": "root", "priority": 2}),
            ("second", None, [ticks(4)], {"scheduler": "root", "priority": 1}),
        ]
        return worst(system([root()], tasks, stimuli=[stimulus], events=[event]))["second"]

    def test_events_that_software_raises(self):
        assert self.respond(CustomEvent(name="event"), RaiseEvent(event="event")) == 9

    def test_accesses_to_labels(self):
        write = LabelAccess(label="L", kind=AccessKind.WRITE)
        assert self.respond(LabelEvent(name="event", label="L", change=LabelChange.WRITE), write) == 9
        assert "no process triggers" in self.respond(LabelEvent(name="event", label="L", change=LabelChange.READ), write)

    def test_twice_in_a_job(self):
        twice = (RaiseEvent(event="event"), RaiseEvent(event="event"))
        # Both may be there before the first one is served.
        assert self.respond(CustomEvent(name="event"), *twice) == 13

    @pytest.mark.parametrize("times", [0.5, 2.5, Count(least=0, mean=2.0, most=0)])
    def test_an_average_number_of_accesses_has_no_maximum(self, times):
        """Ten accesses in one of twenty jobs are 0.5 on average; if only a mean is stated, the maximum is not 0."""
        written = LabelEvent(name="event", label="L", change=LabelChange.WRITE)
        averaged = LabelAccess(label="L", kind=AccessKind.WRITE, times=times)
        unknown = "the maximum number of times that a job of 'first' triggers it is unknown"
        assert self.respond(written, averaged) == unknown
        assert self.respond(written, LabelAccess(label="L", kind=AccessKind.WRITE), averaged) == unknown

    def test_events_from_outside(self):
        assert "no activity in the model raises" in self.respond(CustomEvent(name="event"))

    def test_a_process_triggered_by_an_unknown_one_is_unknown(self):
        assert "could not be analysed" in self.respond(
            CustomEvent(name="event"), RaiseEvent(event="event"), WaitEvent(events=("e",))
        )


def test_periodic_releases_and_a_server_are_no_exact_schedule():
    built = system(
        [root(), under("server", Policy.POLLING_SERVER, 5, capacity=2, period=10)],
        [("T", None, [ticks(5)], {"scheduler": "root", "priority": 1}), ("I", 90, [ticks(1)], {"scheduler": "server"})],
        stimuli=[Periodic(name="every T", period=100 * US)],
    )
    claims = {process.name: process.response.claim for process in analyze_system(built).processes}
    assert claims == {"T": "bound", "I": "bound"}


@examples(36)
@given(systems(), st.sampled_from(MemoryModel))
def test_no_system_is_too_strange(system, memory):
    analysis = analyze_system(system, Settings(memory=memory))
    for process in analysis.processes:
        assert process.response is not None or process.reason
    propose_priorities(analyze_system(system))
