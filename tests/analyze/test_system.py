"""Whole systems: the thesis's application, the models of challenges, and what cannot be analysed."""

from dataclasses import replace

import pytest
from effort import every
from hand_made_systems import Proc, changed, of_parts, one_core, system, ticks
from support import ROOT, SHARED, analysis_of

from amalthea_uros import extract, load
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.activities import Call, Case, Chance, Loop, ProbabilitySwitch, Switch, Trigger
from amalthea_uros.perf.constraints import Bound, Constraints, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.mapping import Mapping, TaskAllocation
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.software import Preemption, Runnable, Task
from amalthea_uros.perf.stimuli import Custom, InterProcess, Periodic, Stimuli
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS

SAMPLES = ROOT / "samples"


class TestTheThesis:
    """Section 7 of its figures; those of the advanced model, figure 6.6, are in `test_metrics`."""

    def test_simple(self):
        control = analysis_of(SAMPLES / "bodas-test-simple.yaml")["Control_Function"].response
        assert (control.best, control.worst, control.claim) == (16 * US, 16 * US, "exact")

    def test_advanced(self):
        analysis = analysis_of(SAMPLES / "bodas-test-advanced.yaml")
        assert {requirement.verdict for requirement in analysis.requirements} == {"met"}
        assert analysis.requirements[0].margin == MS - 29 * US
        assert analysis.summary.schedulable == "yes"

    @pytest.mark.parametrize("sample", every(3, sorted(SAMPLES.glob("*.yaml"))[1:]), ids=lambda path: path.stem)
    def test_the_built_model_gives_the_same_as_its_description(self, sample):
        built, described = analysis_of(sample.with_suffix(".amxmi")), analysis_of(sample)
        # Findings lie in different files.
        texts = ([(each.rule, each.message) for each in analysis.findings] for analysis in (built, described))
        assert next(texts) == next(texts)
        assert replace(built, findings=()) == replace(described, findings=())


CIRCLE = [Runnable(name="A", activities=(Call(runnable="B"),)), Runnable(name="B", activities=(Call(runnable="A"),))]
RUNNABLES = [Runnable(name="R", activities=(ticks(5, 3), ticks(2))), *CIRCLE]
CHANCES = tuple(Chance(weight=weight, activities=tuple(body)) for weight, body in ((1, [ticks(10)]), (9, [ticks(2)]), (0, [])))
CASES = Case(activities=(ticks(7),)), Case(activities=(ticks(4),))


@pytest.mark.parametrize(
    ("activities", "best", "worst", "reason"),
    [
        pytest.param([ticks(1), Call(runnable="R"), Call(runnable="R")], 11, 15, "", id="calls"),
        pytest.param([ProbabilitySwitch(branches=CHANCES)], 0, 10, "", id="chances"),
        pytest.param([ticks(1), ProbabilitySwitch(branches=())], 1, 1, "", id="no chances"),
        pytest.param([Switch(cases=CASES)], 0, 7, "", id="a switch without a default"),
        pytest.param([Switch(cases=CASES[:1], default=(ticks(4),))], 4, 7, "", id="a default"),
        pytest.param([Loop(activities=(ticks(1),))], None, None, "it contains a loop", id="a loop"),
        pytest.param([Call(runnable="A")], None, None, "the runnable 'A' calls itself", id="a circle"),
        pytest.param(
            [Call(runnable="?")], None, None, "the runnable '?' is not defined in the model", id="an undefined runnable"
        ),
    ],
)
def test_demand(activities, best, worst, reason):
    process = analyze_system(one_core(("T", 1000, activities), runnables=RUNNABLES))["T"]
    assert (process.bcet, process.wcet) == (best if best is None else best * US, worst and worst * US)
    assert process.reason.startswith(reason)
    assert bool(process.reason) == bool(reason)


class TestTasksThatCannotAlwaysBeInterrupted:
    """A preemptive task, and below it two of runnables of 5 + 5 and 8 + 3 us; all values worked out by hand."""

    def respond(self, preemption):
        runnables = [Runnable(name=name, activities=(ticks(us),)) for name, us in (("b1", 5), ("b2", 5), ("c1", 8), ("c2", 3))]
        built = one_core(
            ("A", 20, [ticks(2)]),
            ("B", 100, [Call(runnable="b1"), Call(runnable="b2")]),
            ("C", 200, [Call(runnable="c1"), Call(runnable="c2")]),
            runnables=runnables,
        )
        built = changed(changed(built, "B", preemption=preemption), "C", preemption=preemption)
        return [process.response.worst // US for process in analyze_system(built).processes]

    def test_preemptive(self):
        # C: 11 of its own, 10 of B, 2 of A at 0 and at 20.
        assert self.respond(Preemption.PREEMPTIVE) == [2, 12, 25]

    def test_cooperative(self):
        # All are released together at 0: A until 2, B until 12, c1 until 20, A until 22, c2 until 25. When B comes again, C has ended.
        assert self.respond(Preemption.COOPERATIVE) == [2, 12, 25]

    def test_non_preemptive(self):
        # All are released together at 0: A until 2, B until 12, C until 23, so that the job of A at 20 waits for 3.
        assert self.respond(Preemption.NON_PREEMPTIVE) == [5, 12, 23]


class TestTriggers:
    def analysed(self, *tasks):
        stimuli = [InterProcess(name=f"trigger {name}") for name, period, _ in tasks if not period]
        return analyze_system(one_core(*tasks, stimuli=stimuli))

    def test_a_triggered_task_arrives_as_irregularly_as_its_trigger_ends(self):
        found = self.analysed(
            ("fast", 100, [ticks(20)]),
            ("source", 200, [ticks(30, 10), Trigger(stimulus="trigger sink")]),
            ("sink", None, [ticks(40)]),
        )
        assert found["source"].response.worst == 50 * US
        # A job of each of the others can come first: 20 + 30, and 40 of its own.
        assert found["sink"].response.worst == 90 * US

    def test_what_arrives_irregularly_interferes_more(self):
        regular, irregular = (
            self.analysed(
                ("fast", 100, [ticks(40)]),
                ("source", 100, [ticks(50, best), Trigger(stimulus="trigger sink")]),
                ("sink", None, [ticks(1)]),
                ("last", 1000, [ticks(5)]),
            )["last"].response.worst
            for best in (50, 1)
        )
        # The ends of jobs of 1 to 50 us come closer together than those of jobs of 50 us.
        assert irregular >= regular

    def test_a_cycle_of_triggers_has_no_bound(self):
        found = self.analysed(
            ("one", None, [ticks(1), Trigger(stimulus="trigger two")]),
            ("two", None, [ticks(1), Trigger(stimulus="trigger one")]),
        )
        assert [process.verdict for process in found.processes] == ["unknown", "unknown"]

    def test_tasks_that_make_each_other_grow_leave_the_others_alone(self):
        # The sink interferes with its source, which then triggers it still less regularly: at this load that has no end.
        built = system(
            Proc("sink", (ticks(3),), stimuli=("go",), priority=2),
            Proc("source", (ticks(2), Trigger(stimulus="go")), 6, priority=1),
            Proc("free", (ticks(200),), 10, priority=1, scheduler="s1"),
            triggers=("go",),
        )
        found = analyze_system(built)
        assert "increase each other without limit" in found["source"].reason
        assert found["sink"].response is None
        assert found["free"].response is not None


class TestWhatIsNotKnown:
    @pytest.mark.parametrize(
        ("change", "reason"),
        [
            ({"stimuli": Stimuli()}, "the stimulus 'every low' is not defined in the model"),
            ({"stimuli": Stimuli(stimuli=(Custom(name="every low"),))}, "the rate of the stimulus 'every low' is unbounded"),
            ({"mapping": Mapping()}, "it is not allocated to a scheduler"),
        ],
    )
    def test_reasons(self, change, reason):
        built = one_core(("low", 1000, [ticks(1)]))
        assert analyze_system(replace(built, **change)).processes[0].reason == reason

    def test_lower_priorities_than_an_unknown_process_are_unknown(self):
        built = one_core(("loop", 1000, [Loop(activities=())]), ("lower", 1000, [ticks(1)]))
        lower = analyze_system(built)["lower"]
        assert lower.response is None
        assert "depends on 'loop', which could not be analysed" in lower.reason

    def test_a_task_that_may_run_on_several_cores_makes_the_others_there_unknown(self):
        built = of_parts(
            [Task(name=name, stimuli=("s",), activities=(ticks(1),)) for name in ("fixed", "free", "elsewhere")],
            [
                TaskAllocation(task="fixed", scheduler="global", priority=3, cores=("one",)),
                TaskAllocation(task="free", scheduler="global", priority=2),
                TaskAllocation(task="elsewhere", scheduler="three", priority=1),
            ],
            [Periodic(name="s", period=MS)],
            cores=["one", "two", "three"],
            schedulers=[
                Scheduler(name="global", policy=Policy.OSEK, cores=("one", "two")),
                Scheduler(name="three", policy=Policy.OSEK, cores=("three",)),
            ],
        )
        found = analyze_system(built)
        assert found["free"].reason == "several cores can execute it: one, two"
        assert found["fixed"].reason == "depends on 'free', which could not be analysed"
        assert found["elsewhere"].response.worst is not None
        assert [processor.worst is None for processor in found.processors] == [True, True, False]

    @pytest.mark.parametrize("path", sorted((SHARED / "vectors" / "am2inc").glob("*.amxmi")), ids=lambda path: path.name)
    def test_no_model_is_too_defective(self, path):
        try:
            model = load(path)
        except ReadError:
            return
        analyze_system(extract(model).system)


class TestRequirements:
    """A task of 20 us below one of 30 with a period of 100 and a jitter of 10, all at 1 MHz."""

    JITTER = (Periodic(name="every high", period=100 * US, jitter=Uniform(lower=0, upper=10 * US)),)

    def value_of(self, metric, bound=Bound.UPPER, process="low"):
        limit = TimeLimit(metric=metric, value=0, bound=bound)
        requirement = Requirement(name="R", process=process, limit=limit)
        built = one_core(
            ("high", None, [ticks(30)]),
            ("low", 200, [ticks(20, 15)]),
            stimuli=self.JITTER,
            constraints=Constraints(requirements=(requirement,)),
        )
        (result,) = analyze_system(built).requirements
        return None if result.value is None else result.value // US

    @pytest.mark.parametrize(
        ("metric", "minimum", "maximum"),
        [
            (TimeMetric.RESPONSE_TIME, 15, 50),
            (TimeMetric.NET_EXECUTION_TIME, 15, 20),
            (TimeMetric.GROSS_EXECUTION_TIME, 15, 50),
            # Of 50 us a job executes 15 at least.
            (TimeMetric.START_DELAY, 0, 35),
            (TimeMetric.READY_TIME, 0, 35),
            (TimeMetric.WAITING_TIME, 0, 0),
            (TimeMetric.ACTIVATE_TO_ACTIVATE, 200, 200),
            # Starts vary by 35, ends by 50 - 15.
            (TimeMetric.START_TO_START, 200 - 35, 200 + 35),
            (TimeMetric.END_TO_END, 200 - 35, 200 + 35),
            # From an end 50 after the activation to the next start at once; from one after 15 to a start 35 late.
            (TimeMetric.END_TO_START, 200 - 50, 200 + 35 - 15),
            (TimeMetric.LATENESS, None, None),
            (TimeMetric.OS_OVERHEAD, None, None),
        ],
    )
    def test_metrics(self, metric, minimum, maximum):
        assert (self.value_of(metric, Bound.LOWER), self.value_of(metric)) == (minimum, maximum)

    def test_jitter_moves_activations(self):
        assert self.value_of(TimeMetric.ACTIVATE_TO_ACTIVATE, Bound.LOWER, "high") == 90
        assert self.value_of(TimeMetric.ACTIVATE_TO_ACTIVATE, process="high") == 110
