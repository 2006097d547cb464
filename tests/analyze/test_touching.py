"""What a process that cannot be analysed can touch is unknown; what it cannot touch is known nevertheless.

The unknown process is U: it waits for an OS event without a timeout, or its scheduling is unknown. Cores have 1 MHz: a tick is a
microsecond.
"""

from dataclasses import replace

import pytest
from hand_made_systems import READ, WRITE, Proc, access, chain, locked, system, ticks

from amalthea_uros.analyze.explanations.processes import origins
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Group, Incomplete, Migrate, Trigger, WaitEvent
from amalthea_uros.perf.events import ProcessChange, ProcessEvent
from amalthea_uros.perf.mapping import IsrAllocation
from amalthea_uros.perf.os import Duration, InterruptController, Parameter, Parent, Policy, Scheduler, Semaphore, SemaphoreKind
from amalthea_uros.perf.software import Isr, Label, OsEvent, Preemption
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import MICROSECOND as US

WAIT = WaitEvent(events=("E",))


def scheduler(name="s0", core="c0", policy=Policy.OSEK, **others):
    return Scheduler(name=name, policy=policy, cores=(core,), **others)


SCHEDULERS = (scheduler(), scheduler("s1", "c1"))


def built(*processes, **parts):
    return system(*processes, os_events=(OsEvent(name="E"),), **parts)


def analysed(*processes, **parts):
    return analyze_system(built(*processes, **parts))


def worst(analysis, name):
    """The worst-case response time in microseconds; None if it is unknown, and then no verdict is met."""
    process = analysis.processes[name]
    if process.response is None:
        assert process.verdict != "met"
        return None
    return process.response.worst / US


def loads(analysis):
    return [None if core.worst is None else float(core.worst) for core in analysis.processors]


def task(name, length, period, priority, **others):
    return Proc(name, (ticks(length),), period, priority=priority, **others)


def unknown(priority=2, body=(), **others):
    return Proc("U", (*body, WAIT), 100, priority=priority, **others)


class TestCores:
    def test_a_task_of_lower_priority_delays_nobody_above_it(self):
        analysis = analysed(unknown(1), task("T", 5, 50, 2), task("other", 6, 50, 1, scheduler="s1"))
        assert (worst(analysis, "T"), worst(analysis, "other")) == (5, 6)
        assert analysis.processes["T"].response.claim is Claim.BOUND
        assert analysis.processes["other"].response.claim is Claim.EXACT
        assert loads(analysis) == [None, 0.12]

    def test_one_of_higher_priority_delays_all_below(self):
        assert worst(analysed(unknown(3), task("T", 5, 50, 2)), "T") is None

    @pytest.mark.parametrize("target", ["s1", "unknown"])
    def test_a_task_that_migrates_can_be_before_all_tasks_of_the_target(self, target):
        moving = Proc("U", (ticks(1), Migrate(scheduler=target), ticks(3)), 50, priority=1)
        analysis = analysed(moving, task("T", 5, 50, 2), task("other", 6, 50, 9, scheduler="s1"))
        assert worst(analysis, "other") is None
        assert loads(analysis) == [None, None]
        # On its own core it has its priority; a target that is not defined can be a scheduler of this core, too.
        assert worst(analysis, "T") == (5 if target == "s1" else None)
        assert [origin.process for origin in origins(analysis.solution, "other")] == ["U"]

    def test_nor_is_it_known_where_a_task_goes_without_a_target(self):
        moving = Proc("U", (Incomplete(reason="an incomplete EnforcedMigration"), ticks(3)), 50, priority=1)
        assert worst(analysed(moving, task("other", 6, 50, 9, scheduler="s1")), "other") is None

    def test_interrupts_come_before_a_task_that_migrates(self):
        moving = Proc("U", (Migrate(scheduler="s0"), ticks(3)), 50, priority=1, scheduler="s1")
        interrupt = Proc("I", (ticks(2),), 50, priority=1, is_isr=True)
        analysis = analysed(moving, interrupt, task("T", 5, 50, 9))
        assert (worst(analysis, "I"), worst(analysis, "T")) == (2, None)
        assert analysis.processes["I"].response.claim is Claim.BOUND

    def test_unless_it_keeps_them_off(self):
        body = (Migrate(scheduler="s0"), Group(activities=(ticks(3),), interruptible=False))
        interrupt = Proc("I", (ticks(2),), 50, priority=1, is_isr=True)
        analysis = analysed(Proc("U", body, 50, priority=1, scheduler="s1"), interrupt)
        assert worst(analysis, "I") is None

    def test_an_isr_that_is_unknown_delays_all_tasks_and_lower_isrs_of_its_core(self):
        isrs = [Proc(name, (ticks(2),), 50, priority=p, is_isr=True) for name, p in (("high", 3), ("low", 1))]
        analysis = analysed(unknown(2, is_isr=True), *isrs, task("T", 5, 50, 9), task("other", 6, 50, 1, scheduler="s1"))
        assert [worst(analysis, name) for name in ("high", "low", "T", "other")] == [2, None, None, 6]

    def test_of_several_priorities_none_is_known(self):
        twice = built(task("U", 3, 50, 1), task("T", 5, 50, 2), task("other", 6, 50, 9, scheduler="s1"))
        allocations = (*twice.mapping.tasks, replace(twice.mapping.tasks[0], scheduler="s1"))
        analysis = analyze_system(replace(twice, mapping=replace(twice.mapping, tasks=allocations)))
        assert [worst(analysis, name) for name in ("U", "T", "other")] == [None, None, None]
        assert loads(analysis) == [None, None]


@pytest.mark.parametrize(
    ("body", "longest"),
    [
        ((ticks(3),), 3),
        # It can also wait, for nobody knows how long.
        ((*locked("S", 2), ticks(1)), None),
    ],
)
def test_the_net_execution_time_of_what_cannot_be_analysed_includes_waiting(body, longest):
    semaphore = Semaphore(name="S", users=1)
    analysis = analysed(
        Proc("U", body, 50, priority=1, scheduler="s0"), schedulers=[scheduler(policy=None)], semaphores=(semaphore,)
    )
    assert worst(analysis, "U") is None
    net = analysis.processes["U"].metrics[JobMetric.NET_EXECUTION_TIME]
    assert (net.min, net.max) == (3 * US, None if longest is None else longest * US)


class TestNobodyStatedWhere:
    """A process without an allocation can run on any core, if anything activates it."""

    def analysed(self, is_isr, stimuli):
        known = built(task("T", 5, 50, 2), Proc("I", (ticks(2),), 50, priority=1, is_isr=True))
        body = {"name": "U", "stimuli": stimuli, "activities": (ticks(3),)}
        software, tick = known.software, Periodic(name="tick", period=100 * US)
        if is_isr:
            software = replace(software, isrs=(*software.isrs, Isr(**body)))
        else:
            software = replace(software, tasks=(*software.tasks, replace(software.tasks[0], **body)))
        stimuli = replace(known.stimuli, stimuli=(*known.stimuli.stimuli, tick))
        return analyze_system(replace(known, software=software, stimuli=stimuli))

    def test_an_isr_comes_before_everything(self):
        analysis = self.analysed(True, ("tick",))
        assert [worst(analysis, name) for name in "UIT"] == [None, None, None]
        assert loads(analysis) == [None, None]

    def test_a_task_comes_before_tasks(self):
        analysis = self.analysed(False, ("tick",))
        assert [worst(analysis, name) for name in "UIT"] == [None, 2, None]
        assert loads(analysis) == [None, None]

    @pytest.mark.parametrize("is_isr", [False, True])
    def test_what_nothing_activates_touches_nothing(self, is_isr):
        analysis = self.analysed(is_isr, ())
        assert [worst(analysis, name) for name in "UIT"] == [None, 2, 7]
        assert loads(analysis) == [0.14, 0]

    def test_a_controller_without_a_core(self):
        known = built(task("T", 5, 50, 2), unknown(is_isr=True))
        (operating_system,) = known.os.systems
        nowhere = replace(operating_system, interrupt_controllers=(InterruptController(name="irq"),))
        analysis = analyze_system(replace(known, os=replace(known.os, systems=(nowhere,))))
        assert (worst(analysis, "T"), loads(analysis)) == (None, [None, None])

    def test_a_controller_that_is_not_defined(self):
        known = built(task("T", 5, 50, 2), unknown(is_isr=True))
        elsewhere = replace(known.mapping, isrs=(IsrAllocation(isr="U", controller="elsewhere", priority=1),))
        assert worst(analyze_system(replace(known, mapping=elsewhere)), "T") is None


class TestSchedulers:
    def test_a_scheduler_without_a_policy_can_do_anything(self):
        schedulers = [scheduler(policy=None), scheduler("s1", "c1")]
        interrupt = Proc("I", (ticks(2),), 50, priority=1, is_isr=True)
        analysis = analysed(task("T", 5, 50, 2), interrupt, task("other", 6, 50, 1, scheduler="s1"), schedulers=schedulers)
        assert [worst(analysis, name) for name in ("T", "I", "other")] == [None, 2, 6]
        assert loads(analysis) == [None, 0.12]

    @pytest.mark.parametrize("policy", [None, "PfairPD2"])
    def test_beside_another_scheduler(self, policy):
        schedulers = [scheduler(), scheduler("s1", "c0", policy=policy)]
        analysis = analysed(task("T", 5, 50, 2), task("U", 6, 50, 1, scheduler="s1"), schedulers=schedulers)
        assert [worst(analysis, name) for name in "TU"] == [None, None]

    def test_below_another_scheduler(self):
        below = Scheduler(name="below", policy="PfairPD2", parent=Parent(scheduler="s0", priority=1))
        analysis = analysed(task("T", 5, 50, 9), task("U", 6, 50, 1, scheduler="below"), schedulers=[scheduler(), below])
        assert worst(analysis, "T") is None

    def test_under_earliest_deadline_first_everything_depends_on_everything(self):
        edf = scheduler(policy=Policy.EARLIEST_DEADLINE_FIRST)
        analysis = analysed(
            unknown(None, deadline=100), task("T", 5, 50, None, deadline=10), schedulers=[edf, scheduler("s1", "c1")]
        )
        assert worst(analysis, "T") is None

    def test_a_server_protects_others_from_what_it_serves(self):
        # 2 us in each 10 us for the server: T waits for 4 us of it at most (in 9 us: 5 us of its own).
        server = _server(Parameter(name="capacity", values=(Duration(2 * US),)))
        analysis = analysed(unknown(1, scheduler="server"), task("T", 5, 50, 1), schedulers=[scheduler(), server])
        assert worst(analysis, "T") == 5 + 2 * 2
        assert loads(analysis)[0] is None

    def test_unless_its_budget_is_unknown(self):
        analysis = analysed(unknown(1, scheduler="server"), task("T", 5, 50, 1), schedulers=[scheduler(), _server()])
        assert worst(analysis, "T") is None


def _server(*parameters):
    period = Parameter(name="period", values=(Duration(10 * US),))
    association = Parent(scheduler="s0", priority=9, parameters=(*parameters, period))
    return Scheduler(name="server", policy=Policy.DEFERRABLE_SERVER, parent=association)


class TestDecisions:
    """A decision of 1 us at each activation and each end."""

    SCHEDULERS = (scheduler(overhead=(ticks(1),)), scheduler("s1", "c1"))

    def test_about_a_task_of_unknown_demand_delay_those_above(self):
        # T: 5 us and the decision at its end, after the decisions about both activations.
        analysis = analysed(unknown(1), task("T", 5, 50, 2), schedulers=self.SCHEDULERS)
        assert worst(analysis, "T") == 8

    def test_about_a_task_of_unknown_activation_are_any_number(self):
        silent = Proc("U", (ticks(1),), priority=1)
        interrupt = Proc("I", (ticks(2),), 50, priority=1, is_isr=True)
        analysis = analysed(silent, interrupt, task("T", 5, 50, 2), schedulers=self.SCHEDULERS)
        assert [worst(analysis, name) for name in "TI"] == [None, None]

    def test_about_a_task_that_migrates_are_any_number(self):
        moving = Proc("U", (Migrate(scheduler="s1"), ticks(1)), 50, priority=1)
        assert worst(analysed(moving, task("T", 5, 50, 2), schedulers=self.SCHEDULERS), "T") is None

    def test_on_another_core_delay_everything_there(self):
        remote = (scheduler(overhead=(ticks(1),), executing_core="c1"), scheduler("s1", "c1"))
        analysis = analysed(task("T", 5, 50, 2), task("other", 6, 50, 1, scheduler="s1"), schedulers=remote)
        assert [worst(analysis, name) for name in ("T", "other")] == [None, None]
        assert loads(analysis)[1] is None

    def test_are_part_of_the_load(self):
        # 5 us and two decisions in 50 us.
        assert loads(analysed(task("T", 5, 50, 2), schedulers=self.SCHEDULERS)) == [0.14, 0]


class TestOtherProcesses:
    def test_a_task_that_it_triggers_and_those_below(self):
        triggering = unknown(1, body=(Trigger(stimulus="go"),))
        triggered = Proc("T", (ticks(5),), stimuli=("go",), priority=2, scheduler="s1")
        analysis = analysed(
            triggering,
            triggered,
            task("above", 3, 50, 3, scheduler="s1"),
            task("below", 3, 50, 1, scheduler="s1"),
            triggers=("go",),
        )
        assert [worst(analysis, name) for name in ("T", "above", "below")] == [None, 3, None]

    @pytest.mark.parametrize("kind", [None, SemaphoreKind.SPINLOCK])
    def test_those_that_wait_for_its_semaphore_on_another_core(self, kind):
        # It holds the lock where it migrates to, or where its scheduler serves it: nobody knows for how long.
        processes = [
            Proc("T", locked("lock", 5), 50, priority=2, scheduler="s1"),
            task("above", 3, 50, 3, scheduler="s1"),
            Proc("U", locked("lock", 2), 50, priority=1, scheduler="other"),
        ]
        schedulers = [*SCHEDULERS, Scheduler(name="other", policy="PfairPD2", cores=("c0",))]
        semaphores = (Semaphore(name="lock", kind=kind, ceiling=True),)
        analysis = analysed(*processes, schedulers=schedulers, semaphores=semaphores)
        assert worst(analysis, "T") is None
        lock = "semaphore" if kind is None else "spinlock"
        assert analysis.processes["T"].reason == f"it shares the {lock} 'lock' with 'U', which could not be analysed"
        # With a ceiling, T can keep off whoever is above it, but only those up to the ceiling, which is its own priority.
        assert worst(analysis, "above") == 3

    @pytest.mark.parametrize("preemption", [Preemption.NON_PREEMPTIVE, Preemption.PREEMPTIVE])
    def test_those_above_that_it_blocks(self, preemption):
        analysis = analysed(unknown(1, task={"preemption": preemption}), task("T", 5, 50, 2))
        assert worst(analysis, "T") == (None if preemption is Preemption.NON_PREEMPTIVE else 5)


class TestChains:
    EVENTS = tuple(ProcessEvent(name=f"{name} ends", process=name, change=ProcessChange.TERMINATE) for name in "WR")

    def latencies(self, *others, **parts):
        writer = Proc("W", (ticks(1), access("L", WRITE)), 20, priority=9)
        reader = Proc("R", (access("L", READ), ticks(1)), 20, priority=8)
        parts |= {"labels": (Label(name="L"),), "events": self.EVENTS, "chains": (chain("way", "W ends", "R ends"),)}
        (found,) = analysed(writer, reader, *others, **parts).chains
        return found

    def test_what_an_unknown_process_also_writes(self):
        found = self.latencies(unknown(1, body=(access("L", WRITE),)))
        assert not found.values
        assert found.reason == "'U', which could not be analysed, writes 'L'"

    def test_what_it_only_reads(self):
        assert self.latencies(unknown(1, body=(access("L", READ),))).values


class TestSimulation:
    """What depends on something that is not simulated is not observed, whatever is seen of it."""

    OPTIONS = Options(duration=Duration(1000 * US))

    def verdicts(self, *processes, **parts):
        simulation = simulate_system(built(*processes, **parts), self.OPTIONS)
        return {process.name: str(process.verdict) for process in simulation.processes}

    def test_on_its_core(self):
        # Without U, T is too late; with it, who knows.
        schedulers = [*SCHEDULERS, Scheduler(name="none", policy="PfairPD2", cores=("c0",))]
        late = task("other", 9, 50, 1, scheduler="s1", deadline=5)
        found = self.verdicts(task("U", 2, 50, 2, scheduler="none"), task("T", 9, 50, 1), late, schedulers=schedulers)
        assert found["other"] == "observed_missed"
        assert found.get("T", "not_observed") == "not_observed"

    def test_where_it_migrates_to(self):
        moving = Proc("U", (ticks(1), Migrate(scheduler="s1"), ticks(3)), 50, priority=1)
        late = task("T", 9, 50, 1, scheduler="s1", deadline=5)
        assert self.verdicts(moving, late) == {"T": "not_observed"}

    def test_what_it_triggers(self):
        moving = Proc("U", (Trigger(stimulus="go"), Migrate(scheduler="s0")), 50, priority=1)
        triggered = Proc("T", (ticks(5),), 50, stimuli=("go",), priority=1, scheduler="s1", deadline=50)
        assert self.verdicts(moving, triggered, triggers=("go",)) == {"T": "not_observed"}

    def test_who_waits_for_its_semaphore(self):
        moving = Proc("U", (*locked("lock", 1), Migrate(scheduler="s0")), 50, priority=1)
        waiting = Proc("T", locked("lock", 5), 50, priority=1, scheduler="s1")
        assert self.verdicts(moving, waiting, semaphores=(Semaphore(name="lock"),)) == {"T": "not_observed"}

    def test_nothing_else(self):
        moving = Proc("U", (Migrate(scheduler="s0"), ticks(1)), 50, priority=1)
        assert self.verdicts(moving, task("T", 5, 50, 1, scheduler="s1")) == {"T": "observed_ok"}


def test_the_work_of_an_interrupt_controller_leaves_its_core_unknown():
    """Nobody analyses what the controller executes at each interrupt, so that neither the routine nor what it delays is known."""
    found = built(Proc("I", (ticks(2),), 50, priority=1, is_isr=True), task("T", 5, 50, 9))
    (operating_system,) = found.os.systems
    controllers = tuple(replace(each, overhead=(ticks(1),)) for each in operating_system.interrupt_controllers)
    working = replace(found, os=replace(found.os, systems=(replace(operating_system, interrupt_controllers=controllers),)))
    assert [worst(analyze_system(found), name) for name in "IT"] == [2, 7]
    assert [worst(analyze_system(working), name) for name in "IT"] == [None, None]


def test_what_an_unknown_process_activates_is_activated_at_unknown_times():
    """U, which has no allocation, can delay T, so that the distances of what the end of T activates are not those of T."""
    chained = (
        Proc("T", (ticks(5), Trigger(stimulus="by T")), 50, priority=9),
        Proc("R", (ticks(1),), stimuli=("by T",), priority=2),
    )
    found = built(*chained, task("U", 3, 100, 1), triggers=("by T",))
    kept = tuple(each for each in found.mapping.tasks if each.task != "U")
    unallocated = replace(found, mapping=replace(found.mapping, tasks=kept))
    assert analyze_system(found).processes["R"].min_interarrival == 50 * US
    assert analyze_system(unallocated).processes["R"].min_interarrival is None
