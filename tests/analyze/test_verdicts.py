"""Verdicts: what is met, missed, lost, overloaded or unknown; all numbers are worked out by hand."""

from dataclasses import replace
from fractions import Fraction

import pytest
from hand_made_systems import Proc, changed, one_core, reallocated, system, ticks

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Call, Loop, Trigger
from amalthea_uros.perf.constraints import Bound, Constraints, CountLimit, CountMetric, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.software import Runnable
from amalthea_uros.perf.stimuli import InterProcess, Periodic, RelativePeriodic
from amalthea_uros.units import MICROSECOND as US

#: Every 20 us with a jitter of 5 us.
JITTERING = Periodic(name="every other", period=20 * US, jitter=Boundaries(lower=0, upper=5 * US))
LATE = one_core(("H", 20, [ticks(6)]), ("U", 25, [ticks(15)]))


def limited(metric=TimeMetric.RESPONSE_TIME, value=US, **stated):
    """A limit in picoseconds, of T if nothing else is stated."""
    limit = TimeLimit(metric=metric, value=value, bound=stated.pop("bound", Bound.UPPER))
    return Constraints(requirements=(Requirement(name="R", limit=limit, **(stated or {"process": "T"})),))


class TestDeadlines:
    def test_a_period_is_a_deadline(self):
        in_time = analyze_system(one_core(("H", 25, [ticks(6)]), ("U", 25, [ticks(19)])))
        assert in_time["U"].verdict == "met"
        assert any("is its period" in sentence for sentence in in_time.assumptions)
        # A job of U waits for two of H: 15 + 2 * 6 = 27 > 25.
        late = analyze_system(LATE)
        assert (late["U"].response.worst, late["U"].verdict) == (27 * US, "missed")
        assert late.summary.schedulable == "no"

    def test_a_stated_deadline_comes_first(self):
        found = analyze_system(reallocated(changed(LATE, "U", activation_limit=2), deadline=27 * US))["U"]
        assert (found.deadline, found.is_implicit, found.verdict) == (27 * US, False, "met")

    def test_sporadic_activations_have_their_minimum_distance_as_deadline(self):
        sporadic = RelativePeriodic(name="trigger S", distance=Boundaries(lower=20 * US, upper=50 * US))
        found = analyze_system(one_core(("S", None, [ticks(20)]), stimuli=[sporadic]))["S"]
        assert (found.deadline, found.verdict) == (20 * US, "met")

    def test_a_triggered_process_has_no_deadline(self):
        built = one_core(
            ("source", 100, [ticks(10), Trigger(stimulus="trigger sink")]),
            ("sink", None, [ticks(10)]),
            stimuli=[InterProcess(name="trigger sink")],
        )
        analysis = analyze_system(built)
        assert (analysis["sink"].deadline, analysis["sink"].verdict) == (None, None)
        assert (analysis.summary.judged, analysis.summary.schedulable) == (1, "yes")


class TestLostActivations:
    REASON = "2 jobs can be pending, and the activation limit is 1"

    @pytest.mark.parametrize(("limit", "expected"), [(1, ("missed", "lost", REASON)), (2, ("met", None, ""))])
    def test_more_jobs_than_the_limit(self, limit, expected):
        # At 27 us of 25 a second job is activated before the first one ends.
        found = analyze_system(reallocated(changed(LATE, "U", activation_limit=limit), deadline=50 * US))["U"]
        assert (found.verdict, found.failure, found.reason) == expected

    def test_a_bound_does_not_prove_a_loss(self):
        # Released with unknown offsets both can interfere, which gives only a bound: 15 + 2 * 6.
        built = one_core(("other", None, [ticks(6)]), ("U", 25, [ticks(15)]), stimuli=[JITTERING])
        found = analyze_system(reallocated(built, "U", deadline=50 * US))["U"]
        assert (found.response.worst, found.response.claim, found.verdict) == (27 * US, "bound", "unknown")
        assert found.reason == self.REASON


@pytest.mark.parametrize(
    ("deadline", "verdict", "reason"),
    [
        (27, "met", ""),
        (26, "unknown", "the maximum is between 15 us and 27 us"),
        (15, "unknown", "the maximum is between 15 us and 27 us"),
        (14, "missed", ""),
    ],
)
def test_between_its_execution_time_and_its_bound_a_response_time_is_unknown(deadline, verdict, reason):
    # 15 of its own, and 6 of the other one at 0 and at 15.
    tasks = ("other", None, [ticks(6)]), ("T", 100, [ticks(15, 10)])
    analysis = analyze_system(one_core(*tasks, stimuli=[JITTERING], constraints=limited(value=deadline * US)))
    requirement = analysis.requirements["R"]
    assert (analysis["T"].verdict, requirement.verdict) == (verdict, verdict)
    assert (requirement.lower, requirement.upper, requirement.value) == (15 * US, 27 * US, 27 * US)
    assert analysis["T"].reason == requirement.reason == reason


class TestOverload:
    def test_it_misses_every_limit(self):
        tasks = ("high", 100, [ticks(70)]), ("T", 100, [ticks(40)])
        analysis = analyze_system(one_core(*tasks, constraints=limited(value=100 * US)))
        assert analysis["high"].response.worst == 70 * US
        assert (analysis["T"].verdict, analysis["T"].failure) == ("unbounded", "overload")
        assert (analysis.requirements[0].verdict, analysis.summary.schedulable) == ("missed", "no")
        assert analysis.processors[0].worst == Fraction("1.1")

    def test_a_core_whose_tasks_cannot_be_analysed(self):
        analysis = analyze_system(one_core(("a", 100, [ticks(70)]), ("b", 100, [ticks(84)]), policy="PfairPD2"))
        (core,) = analysis.processors
        assert (core.worst, core.at_least) == (None, Fraction("1.54"))
        assert {process.verdict for process in analysis.processes} == {"unknown"}
        assert [finding.rule for finding in analysis.findings] == ["ANA002"]
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
        found = analyze_system(built)["S"]
        assert (found.verdict, found.response.worst, found.failure) == ("unknown", None, None)
        assert "nearly all of the core" in found.reason


class TestWithoutAnExecutionTime:
    def test_it_is_unknown_and_so_are_those_below_it(self):
        found = analyze_system(one_core(("above", 100, [ticks(1)]), ("empty", 100, []), ("below", 100, [ticks(1)])))
        assert [process.verdict for process in found.processes] == ["met", "unknown", "unknown"]
        assert found["empty"].wcet is None
        assert found["empty"].reason == "it has no execution time, and neither have the runnables that it calls"

    @pytest.mark.parametrize("activity", [ticks(0), Call(runnable="outer")], ids=["a stated zero", "that of a runnable"])
    def test_what_counts_as_one(self, activity):
        runnables = [
            Runnable(name="outer", activities=(Call(runnable="inner"),)),
            Runnable(name="inner", activities=(ticks(1),)),
        ]
        assert analyze_system(one_core(("T", 100, [activity]), runnables=runnables))["T"].verdict == "met"


class TestRequirements:
    @pytest.mark.parametrize(
        ("stated", "reason"),
        [
            ({"process": "none"}, "the process that it limits is not defined, or was left out when reading"),
            ({"runnable": "r"}, "no process of the model calls 'r'"),
            (
                {"process": "T", "limit": CountLimit(metric=CountMetric.PREEMPTIONS, value=3)},
                "it limits preemptions, which is not a time",
            ),
        ],
    )
    def test_one_that_is_not_evaluated_is_unknown(self, stated, reason):
        limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=US)
        constraints = Constraints(requirements=(Requirement(name="R", **{"limit": limit} | stated),))
        analysis = analyze_system(one_core(("T", 100, [ticks(10)]), constraints=constraints))
        found = analysis.requirements["R"]
        assert (found.verdict, found.reason) == ("unknown", reason)
        assert analysis.summary.schedulable == "unknown"
        assert [finding.rule for finding in analysis.findings] == (["ANA009"] if "limit" in stated else [])

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
        analysis = analyze_system(one_core(("T", 100, [ticks(10)]), constraints=limited(value=value * US, bound=bound)))
        assert analysis.requirements["R"].verdict == verdict
        assert [finding.rule for finding in analysis.findings] == ["ANA010"]


class TestSummary:
    def test_what_uses_up_most_of_its_limit_is_the_tightest(self):
        # 50 of 1000 us is more room in time, but less in share: 20 of 40 us is tighter than 70 of 1000.
        summary = analyze_system(one_core(("short", 40, [ticks(20)]), ("long", 1000, [ticks(30)]))).summary
        assert (summary.tightest.name, summary.tightest.margin, summary.judged) == ("short", 20 * US, 2)

    def test_nothing_is_not_schedulable(self):
        summary = analyze_system(one_core()).summary
        assert (summary.judged, summary.schedulable) == (0, "unknown")

    def test_an_unknown_policy_leaves_everything_unknown(self):
        summary = analyze_system(one_core(("T", 100, [ticks(1)]), policy=Policy.PFAIR)).summary
        assert (summary.schedulable, [item.name for item in summary.unknown]) == ("unknown", ["T"])


# A scheduler serves by the deadlines that allocations state; limits only judge.


@pytest.mark.parametrize("policy", [Policy.DEADLINE_MONOTONIC, Policy.EARLIEST_DEADLINE_FIRST])
@pytest.mark.parametrize(
    ("deadline", "limits_in_us", "verdicts"), [(None, (5, 7), ["unknown", "met"]), (10, (6, 7), ["met", "met"])]
)
def test_a_response_time_limit_is_no_deadline_of_the_scheduler(policy, deadline, limits_in_us, verdicts):
    """A stricter limit of A changes nothing in the order of A and B, each of which executes 3: both respond within 6.

    Without deadlines, any order is possible, also one in which A responds after 6.
    """
    tasks = [Proc(name, (ticks(3),), period, deadline=deadline) for name, period in (("A", 20), ("B", 30))]
    found = system(*tasks, schedulers=(Scheduler(name="s0", policy=policy, cores=("c0",)),))
    limits = [TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=value * US, bound=Bound.UPPER) for value in limits_in_us]
    requirements = tuple(Requirement(name=name, process=name, limit=limit) for name, limit in zip("AB", limits, strict=True))
    analysis = analyze_system(replace(found, constraints=Constraints(requirements=requirements)))
    assert [str(each.verdict) for each in analysis.requirements] == verdicts
