"""Verdicts: what is met, missed, lost, overloaded or unknown; all numbers are worked out by hand."""

from dataclasses import replace
from fractions import Fraction

import pytest
from test_system import by_name, one_core, system, ticks

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Call, Loop, Trigger
from amalthea_uros.perf.constraints import (
    Bound,
    Constraints,
    CountLimit,
    CountMetric,
    Requirement,
    TimeLimit,
    TimeMetric,
)
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import OperatingSystem, Os, Policy, Scheduler
from amalthea_uros.perf.software import Runnable, Task
from amalthea_uros.perf.stimuli import InterProcess, Periodic, RelativePeriodic
from amalthea_uros.units import MICROSECOND as US


def changed(built, name, **changes):
    """A system with one task changed."""
    tasks = tuple(replace(task, **changes) if task.name == name else task for task in built.software.tasks)
    return replace(built, software=replace(built.software, tasks=tasks))


class TestDeadlines:
    def test_a_period_is_a_deadline(self):
        # A job of U waits for two of H: 15 + 2 * 6 = 27 > 25.
        analysis = analyze_system(one_core(("H", 25, [ticks(6)]), ("U", 25, [ticks(19)])))
        late = analyze_system(one_core(("H", 20, [ticks(6)]), ("U", 25, [ticks(15)])))
        assert by_name(analysis)["U"].verdict == "met"
        assert (by_name(late)["U"].response.worst, by_name(late)["U"].verdict) == (27 * US, "missed")
        assert late.summary.schedulable == "no"
        assert any("is its period" in sentence for sentence in analysis.assumptions)

    def test_a_stated_deadline_comes_first(self):
        built = changed(one_core(("H", 20, [ticks(6)]), ("U", 25, [ticks(15)])), "U", activation_limit=2)
        allocations = tuple(replace(each, deadline=27 * US) for each in built.mapping.tasks)
        analysis = analyze_system(replace(built, mapping=replace(built.mapping, tasks=allocations)))
        assert (by_name(analysis)["U"].deadline, by_name(analysis)["U"].is_implicit) == (27 * US, False)
        assert by_name(analysis)["U"].verdict == "met"

    def test_sporadic_activations_have_their_minimum_distance_as_deadline(self):
        sporadic = RelativePeriodic(name="trigger S", distance=Boundaries(lower=20 * US, upper=50 * US))
        found = by_name(analyze_system(one_core(("S", None, [ticks(20)]), stimuli=[sporadic])))["S"]
        assert (found.deadline, found.verdict) == (20 * US, "met")

    def test_a_triggered_process_has_no_deadline(self):
        built = one_core(
            ("source", 100, [ticks(10), Trigger(stimulus="trigger sink")]),
            ("sink", None, [ticks(10)]),
            stimuli=[InterProcess(name="trigger sink")],
        )
        analysis = analyze_system(built)
        assert (by_name(analysis)["sink"].deadline, by_name(analysis)["sink"].verdict) == (None, None)
        assert (analysis.summary.judged, analysis.summary.schedulable) == (1, "yes")


class TestLostActivations:
    def respond(self, limit, deadline):
        built = changed(one_core(("H", 20, [ticks(6)]), ("U", 25, [ticks(15)])), "U", activation_limit=limit)
        allocations = tuple(replace(each, deadline=deadline * US) for each in built.mapping.tasks)
        return by_name(analyze_system(replace(built, mapping=replace(built.mapping, tasks=allocations))))["U"]

    def test_more_jobs_than_the_limit(self):
        # At 27 us of 25 a second job is activated before the first one ends.
        found = self.respond(1, 50)
        assert (found.verdict, found.failure) == ("missed", "lost")
        assert found.reason == "2 jobs can be pending, and the activation limit is 1"

    def test_as_many_as_the_limit(self):
        assert self.respond(2, 50).verdict == "met"

    def test_a_bound_does_not_prove_a_loss(self):
        # Released with unknown offsets both can interfere, which gives only a bound: 15 + 2 * 6.
        built = one_core(("U", 25, [ticks(15)]), ("other", None, [ticks(6)]), stimuli=[JITTERING])
        tasks = tuple(
            replace(task, stimuli=("every other",)) if task.name == "other" else task for task in built.software.tasks
        )
        allocations = (
            TaskAllocation(task="U", scheduler="core", priority=1, deadline=50 * US),
            TaskAllocation(task="other", scheduler="core", priority=2),
        )
        built = replace(
            built,
            software=replace(built.software, tasks=tasks),
            mapping=replace(built.mapping, tasks=allocations),
        )
        found = by_name(analyze_system(built))["U"]
        assert (found.response.worst, found.response.claim, found.verdict) == (27 * US, "bound", "unknown")
        assert found.reason == "2 jobs can be pending, and the activation limit is 1"


#: Every 20 us with a jitter of 5 us.
JITTERING = Periodic(name="every other", period=20 * US, jitter=Boundaries(lower=0, upper=5 * US))


class TestBounds:
    def with_jitter(self, wcet, deadline):
        built = one_core(("U", 100, [ticks(wcet, 10)]), ("other", None, [ticks(6)]), stimuli=[JITTERING])
        tasks = tuple(
            replace(task, stimuli=("every other",)) if task.name == "other" else task for task in built.software.tasks
        )
        allocations = (
            TaskAllocation(task="U", scheduler="core", priority=1),
            TaskAllocation(task="other", scheduler="core", priority=2),
        )
        limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=deadline * US)
        built = replace(
            built,
            software=replace(built.software, tasks=tasks),
            mapping=replace(built.mapping, tasks=allocations),
            constraints=Constraints(requirements=(Requirement(name="R", process="U", limit=limit),)),
        )
        analysis = analyze_system(built)
        return by_name(analysis)["U"], analysis.requirements["R"]

    @pytest.mark.parametrize(("deadline", "verdict"), [(27, "met"), (26, "unknown"), (15, "unknown"), (14, "missed")])
    def test_between_its_execution_time_and_its_bound_a_response_time_is_unknown(self, deadline, verdict):
        # 15 of its own, and 6 of the other one at 0 and at 15.
        process, requirement = self.with_jitter(15, deadline)
        assert (process.verdict, requirement.verdict) == (verdict, verdict)
        assert (requirement.lower, requirement.upper, requirement.value) == (15 * US, 27 * US, 27 * US)

    def test_the_reason_shows_both_ends(self):
        process, requirement = self.with_jitter(15, 20)
        assert process.reason == requirement.reason == "the maximum is between 15 us and 27 us"


class TestOverload:
    def test_a_core_whose_tasks_cannot_be_analysed(self):
        built = one_core(("a", 100, [ticks(70)]), ("b", 100, [ticks(84)]))
        scheduler = Scheduler(name="core", policy="PfairPD2", cores=("core",))
        analysis = analyze_system(replace(built, os=Os(systems=(OperatingSystem(name="OS", schedulers=(scheduler,)),))))
        (core,) = analysis.processors
        assert (core.worst, core.at_least) == (None, Fraction("1.54"))
        assert {process.verdict for process in analysis.processes} == {"unknown"}
        assert analysis.summary.schedulable == "no"
        assert [core.name for core in analysis.summary.overloaded] == ["core"]

    def test_the_part_of_a_load_that_is_known(self):
        analysis = analyze_system(one_core(("loop", 100, [Loop(activities=())]), ("b", 100, [ticks(40)])))
        (core,) = analysis.processors
        assert (core.worst, core.at_least, core.is_overloaded) == (None, Fraction("0.4"), False)
        assert analysis.summary.schedulable == "unknown"

    def test_a_response_that_is_unbounded_for_another_reason_is_unknown(self):
        # 500 of 1000 and of 1001 us are less than all. But the backlog of a jitter of 100 ms decreases by 0.5 us in a millisecond,
        # so that the busy window has 100,000 jobs, which are not examined.
        late = Periodic(name="every H", period=1000 * US, jitter=Boundaries(lower=0, upper=100_000 * US))
        built = one_core(("H", None, [ticks(500)]), ("S", 1001, [ticks(500)]), stimuli=[late])
        found = by_name(analyze_system(changed(built, "H", stimuli=("every H",))))["S"]
        assert (found.verdict, found.response.worst, found.failure) == ("unknown", None, None)
        assert "nearly all of the core" in found.reason


class TestWithoutAnExecutionTime:
    def test_it_is_unknown_and_so_are_those_below_it(self):
        analysis = analyze_system(one_core(("above", 100, [ticks(1)]), ("empty", 100, []), ("below", 100, [ticks(1)])))
        found = by_name(analysis)
        assert found["above"].verdict == "met"
        assert (found["empty"].wcet, found["empty"].verdict) == (None, "unknown")
        assert found["empty"].reason == "it has no execution time, and neither have the runnables that it calls"
        assert found["below"].verdict == "unknown"

    def test_a_stated_zero_is_an_execution_time(self):
        assert by_name(analyze_system(one_core(("zero", 100, [ticks(0)]))))["zero"].verdict == "met"

    def test_that_of_a_runnable_counts(self):
        runnables = [
            Runnable(name="outer", activities=(Call(runnable="inner"),)),
            Runnable(name="inner", activities=(ticks(1),)),
        ]
        assert (
            by_name(analyze_system(one_core(("T", 100, [Call(runnable="outer")]), runnables=runnables)))["T"].verdict == "met"
        )


class TestRequirements:
    def judge(self, **stated):
        built = one_core(("T", 100, [ticks(10)]), constraints=Constraints(requirements=(Requirement(name="R", **stated),)))
        analysis = analyze_system(built)
        return analysis.requirements["R"], analysis.summary

    def test_one_that_is_not_evaluated_is_unknown(self):
        found, summary = self.judge(process="T", limit=CountLimit(metric=CountMetric.PREEMPTIONS, value=3))
        assert (found.verdict, found.reason) == ("unknown", "it limits preemptions, which is not a time")
        assert summary.schedulable == "unknown"

    @pytest.mark.parametrize(
        ("stated", "reason"),
        [
            ({"process": "none"}, "the process that it limits is not defined, or was left out when reading"),
            ({"runnable": "r"}, "no process of the model calls 'r'"),
        ],
    )
    def test_one_on_something_else_is_unknown(self, stated, reason):
        found, _ = self.judge(limit=TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=US), **stated)
        assert (found.verdict, found.reason) == ("unknown", reason)

    @pytest.mark.parametrize(
        ("bound", "value", "verdict"),
        [
            (Bound.UPPER, -1, "missed"),
            (Bound.LOWER, -1, "met"),
            (Bound.UPPER, 10**400, "met"),
            (Bound.LOWER, 10**400, "missed"),
        ],
    )
    def test_absurd_limits(self, bound, value, verdict):
        limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=value * US, bound=bound)
        built = one_core(
            ("T", 100, [ticks(10)]),
            constraints=Constraints(requirements=(Requirement(name="R", process="T", limit=limit),)),
        )
        analysis = analyze_system(built)
        assert analysis.requirements["R"].verdict == verdict
        assert [finding.rule for finding in analysis.findings] == ["ANA010"]


class TestSummary:
    def test_what_uses_up_most_of_its_limit_is_the_tightest(self):
        # 50 of 1000 us is more room in time, but less in share: 20 of 40 us is tighter than 70 of 1000.
        summary = analyze_system(one_core(("short", 40, [ticks(20)]), ("long", 1000, [ticks(30)]))).summary
        assert (summary.tightest.name, summary.tightest.margin, summary.judged) == ("short", 20 * US, 2)

    def test_nothing_is_not_schedulable(self):
        summary = analyze_system(system(["core"], [], [], [])).summary
        assert (summary.judged, summary.schedulable) == (0, "unknown")

    def test_an_unknown_policy_leaves_everything_unknown(self):
        built = system(
            ["core"],
            [Periodic(name="s", period=100 * US)],
            [Task(name="T", stimuli=("s",), activities=(ticks(1),))],
            [TaskAllocation(task="T", scheduler="core", priority=1)],
            policy=Policy.PFAIR,
        )
        summary = analyze_system(built).summary
        assert (summary.schedulable, [item.name for item in summary.unknown]) == ("unknown", ["T"])
