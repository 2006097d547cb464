"""Whole systems: the thesis's application, the models of challenges, and what cannot be analysed."""

import json
from dataclasses import replace
from fractions import Fraction

import pytest
from hand_made_systems import of_parts, ticks
from support import ROOT, SHARED, analysis_of

from amalthea_uros import extract, load
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf import stimuli as perf_stimuli
from amalthea_uros.perf.activities import Call, Case, Chance, Demand, Execute, Loop, ProbabilitySwitch, Switch, Trigger
from amalthea_uros.perf.constraints import Bound, Constraints, CountLimit, CountMetric, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.distributions import Boundaries, Uniform
from amalthea_uros.perf.mapping import Mapping, TaskAllocation
from amalthea_uros.perf.os import OperatingSystem, Os, Policy, Scheduler
from amalthea_uros.perf.software import Preemption, Runnable, Software, Task
from amalthea_uros.perf.stimuli import InterProcess, Periodic, RelativePeriodic, Stimuli
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS

SAMPLES = ROOT / "samples"


def by_name(analysis):
    return {process.name: process for process in analysis.processes}


class TestTheThesis:
    """Section 7 of its figures: simulated values of both models, which the exact analysis meets at its ends."""

    def test_simple(self):
        analysis = analysis_of(SAMPLES / "bodas-test-simple.yaml")
        control = by_name(analysis)["Control_Function"].response
        assert (control.best, control.worst, control.claim) == (16 * US, 16 * US, "exact")

    def test_advanced(self):
        analysis = analysis_of(SAMPLES / "bodas-test-advanced.yaml")
        processes = by_name(analysis)
        executor, control = processes["Executor_Task"], processes["Control_Function"]
        assert (executor.response.best, executor.response.worst) == (12 * US, 25 * US)
        assert (control.response.best, control.response.worst) == (16 * US, 29 * US)
        # Loads of 1.27 % and 0.40 %, mean execution time 12.65 us.
        assert executor.acet / MS == Fraction("0.01265")
        assert control.acet / MS == Fraction("0.004")
        assert {requirement.verdict for requirement in analysis.requirements} == {"met"}
        assert analysis.requirements[0].margin == MS - 29 * US
        assert analysis.summary.schedulable == "yes"

    def test_the_built_model_gives_the_same_as_its_description(self):
        for sample in SAMPLES.glob("*.yaml"):
            built, described = analysis_of(sample.with_suffix(".amxmi")), analysis_of(sample)
            # Findings lie in different files.
            texts = ([(each.rule, each.message) for each in analysis.findings] for analysis in (built, described))
            assert next(texts) == next(texts)
            assert replace(built, findings=()) == replace(described, findings=())


def waters():
    path = SHARED / "vectors" / "waters2017.json"
    if not path.exists():
        pytest.skip("the figures of the challenge are not at hand")
    return json.loads(path.read_text())


def challenge(figures, preemptive):
    """The system of the figures: each task as one stretch of its upper bound of instructions."""
    stimuli, tasks, allocations = [], [], []
    for task in figures["tasks"]:
        period = round(task["period_or_min_interarrival_us"] * US)
        name = f"stimulus of {task['name']}"
        if task["stimulus"] == "sporadic":
            latest = round(task["max_interarrival_us"] * US)
            stimuli.append(RelativePeriodic(name=name, distance=Uniform(lower=period, upper=latest)))
        else:
            stimuli.append(Periodic(name=name, period=period))
        demand = Demand(Boundaries(lower=task["instructions"]["lower"], upper=task["instructions"]["upper"]))
        cooperative = task["scheduling"] == "cooperative" and not preemptive
        tasks.append(
            Task(
                name=task["name"],
                stimuli=(name,),
                activities=(Execute(demand=demand),),
                preemption=Preemption.COOPERATIVE if cooperative else Preemption.PREEMPTIVE,
            )
        )
        allocations.append(TaskAllocation(task=task["name"], scheduler=task["core"], priority=task["priority"]))
    cores = sorted({task["core"] for task in figures["tasks"]})
    return system(cores, stimuli, tasks, allocations)


def system(cores, stimuli, tasks, allocations, frequency=200 * 10**6, **parts):
    return of_parts(tasks, allocations, stimuli, cores=cores, frequency=frequency, **parts)


class TestTheChallengeOf2017:
    """Figures that agree with pyCPA and with the published solutions; printed to a picosecond."""

    @pytest.mark.parametrize(
        ("variant", "frequency"),
        [("nominal_200MHz_nomem", 200), ("unimore_300MHz_nomem", 300), ("preemptive_300MHz_nomem", 300)],
    )
    def test_response_times(self, variant, frequency):
        figures = waters()
        preemptive = variant.startswith("preemptive")
        built = challenge(figures, preemptive)
        analysis = analyze_system(built, Settings(dict.fromkeys(built.cores, Fraction(frequency * 10**6))))
        found = by_name(analysis)
        for task in figures["tasks"]:
            if task["scheduling"] == "cooperative" and not preemptive:
                continue  # the figures do not tell the runnables
            expected = task["wcrt_us"][variant]
            response = found[task["name"]].response
            if expected is None:
                assert response.worst is None
                assert found[task["name"]].verdict is Verdict.UNBOUNDED
            else:
                # A third of a picosecond is printed rounded to the nearest one; a bound is rounded up.
                assert 0 <= response.worst - round(expected * US) <= (1 if frequency == 300 else 0)

    def test_loads(self):
        figures = waters()
        built = challenge(figures, preemptive=True)
        for variant, frequency in (("nominal_200MHz_nomem", 200), ("unimore_300MHz_nomem", 300)):
            analysis = analyze_system(built, Settings(dict.fromkeys(built.cores, Fraction(frequency * 10**6))))
            loads = {processor.name: round(float(processor.worst), 6) for processor in analysis.processors}
            assert loads == figures["variants"][variant]["core_utilisation"]

    def test_a_clock_and_a_factor_say_the_same(self):
        built = challenge(waters(), preemptive=True)
        faster = analyze_system(built, Settings(dict.fromkeys(built.cores, Fraction(400 * 10**6))))
        scaled = analyze_system(built, Settings(scale=Fraction(1, 2)))
        assert [p.response for p in faster.processes] == [p.response for p in scaled.processes]


def one_core(*tasks, stimuli=None, **more):
    """Tasks of (name, period in us, activities) on a core of 1 MHz, the first one first."""
    periodic = [Periodic(name=f"every {name}", period=period * US) for name, period, _ in tasks if period]
    return system(
        ["core"],
        [*periodic, *(stimuli or ())],
        [
            Task(name=name, stimuli=(f"every {name}",) if period else (f"trigger {name}",), activities=tuple(activities))
            for name, period, activities in tasks
        ],
        [TaskAllocation(task=name, scheduler="core", priority=-index) for index, (name, _, _) in enumerate(tasks)],
        frequency=10**6,
        **more,
    )


def demand_of(*activities, runnables=()):
    process = by_name(analyze_system(one_core(("T", 1000, activities), runnables=runnables)))["T"]
    return (
        None if process.bcet is None else process.bcet // US,
        None if process.wcet is None else process.wcet // US,
        process.reason,
    )


class TestDemand:
    def test_calls_and_what_they_contain(self):
        runnable = Runnable(name="R", activities=(ticks(5, 3), ticks(2)))
        assert demand_of(ticks(1), Call(runnable="R"), Call(runnable="R"), runnables=[runnable]) == (11, 15, "")

    def test_branches(self):
        branches = ProbabilitySwitch(
            branches=(
                Chance(weight=1, activities=(ticks(10),)),
                Chance(weight=9, activities=(ticks(2),)),
                Chance(weight=0, activities=()),
            )
        )
        assert demand_of(branches) == (0, 10, "")
        assert demand_of(Switch(cases=(Case(activities=(ticks(7),)), Case(activities=(ticks(4),))))) == (0, 7, "")
        assert demand_of(Switch(cases=(Case(activities=(ticks(7),)),), default=(ticks(4),))) == (4, 7, "")

    def test_what_has_no_bound(self):
        assert demand_of(Loop(activities=(ticks(1),)))[2].startswith("it contains a loop")
        circle = [Runnable(name="A", activities=(Call(runnable="B"),)), Runnable(name="B", activities=(Call(runnable="A"),))]
        assert demand_of(Call(runnable="A"), runnables=circle) == (None, None, "the runnable 'A' calls itself")
        assert demand_of(Call(runnable="nothing"))[2] == "the runnable 'nothing' is not defined in the model"


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
        first, *others = built.software.tasks
        tasks = (first, *(replace(task, preemption=preemption) for task in others))
        built = replace(built, software=replace(built.software, tasks=tasks))
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
    def test_a_triggered_task_arrives_as_irregularly_as_its_trigger_ends(self):
        built = one_core(
            ("fast", 100, [ticks(20)]),
            ("source", 200, [ticks(30, 10), Trigger(stimulus="trigger sink")]),
            ("sink", None, [ticks(40)]),
            stimuli=[InterProcess(name="trigger sink")],
        )
        found = by_name(analyze_system(built))
        assert found["source"].response.worst == 50 * US
        # A job of each of the others can come first: 20 + 30, and 40 of its own.
        assert found["sink"].response.worst == 90 * US

    def test_what_arrives_irregularly_interferes_more(self):
        def worst(best):
            built = one_core(
                ("fast", 100, [ticks(40)]),
                ("source", 100, [ticks(50, best), Trigger(stimulus="trigger sink")]),
                ("sink", None, [ticks(1)]),
                ("last", 1000, [ticks(5)]),
                stimuli=[InterProcess(name="trigger sink")],
            )
            return by_name(analyze_system(built))["last"].response.worst

        # The ends of jobs of 1 to 50 us come closer together than those of jobs of 50 us.
        assert worst(1) >= worst(50)

    def test_a_cycle_of_triggers_has_no_bound(self):
        built = one_core(
            ("one", None, [ticks(1), Trigger(stimulus="trigger two")]),
            ("two", None, [ticks(1), Trigger(stimulus="trigger one")]),
            stimuli=[InterProcess(name="trigger one"), InterProcess(name="trigger two")],
        )
        assert [process.verdict for process in analyze_system(built).processes] == ["unknown", "unknown"]


class TestWhatIsNotKnown:
    def test_an_unknown_policy_is_never_taken_for_fixed_priorities(self):
        built = system(
            ["core"],
            [Periodic(name="s", period=MS)],
            [Task(name="T", stimuli=("s",), activities=(ticks(1),))],
            [TaskAllocation(task="T", scheduler="core", priority=1)],
            policy="PfairPD2",
        )
        analysis = analyze_system(built)
        assert analysis.processes[0].verdict is Verdict.UNKNOWN
        assert analysis.processes[0].response is None
        assert [finding.rule for finding in analysis.findings] == ["ANA002"]

    @pytest.mark.parametrize(
        ("change", "reason"),
        [
            ({"stimuli": Stimuli()}, "the stimulus 'every low' is not defined in the model"),
            (
                {"stimuli": Stimuli(stimuli=(perf_stimuli.Custom(name="every low"),))},
                "the rate of the stimulus 'every low' is unbounded",
            ),
            ({"mapping": Mapping()}, "it is not allocated to a scheduler"),
        ],
    )
    def test_reasons(self, change, reason):
        built = one_core(("low", 1000, [ticks(1)]))
        assert analyze_system(replace(built, **change)).processes[0].reason == reason

    def test_lower_priorities_than_an_unknown_process_are_unknown(self):
        built = one_core(("loop", 1000, [Loop(activities=())]), ("lower", 1000, [ticks(1)]))
        found = by_name(analyze_system(built))
        assert found["lower"].response is None
        assert "depends on 'loop', which could not be analysed" in found["lower"].reason

    def test_a_task_that_may_run_on_several_cores_makes_the_others_there_unknown(self):
        tasks = [Task(name=name, stimuli=("s",), activities=(ticks(1),)) for name in ("fixed", "free", "elsewhere")]
        built = system(
            ["one", "two", "three"],
            [Periodic(name="s", period=MS)],
            tasks,
            [
                TaskAllocation(task="fixed", scheduler="global", priority=3, cores=("one",)),
                TaskAllocation(task="free", scheduler="global", priority=2),
                TaskAllocation(task="elsewhere", scheduler="three", priority=1),
            ],
        )
        schedulers = (
            Scheduler(name="global", policy=Policy.OSEK, cores=("one", "two")),
            Scheduler(name="three", policy=Policy.OSEK, cores=("three",)),
        )
        analysis = analyze_system(replace(built, os=Os(systems=(OperatingSystem(name="OS", schedulers=schedulers),))))
        found = by_name(analysis)
        assert found["free"].reason == "several cores can execute it: one, two"
        assert found["fixed"].reason == "depends on 'free', which could not be analysed"
        assert found["elsewhere"].response.worst is not None
        assert [processor.worst is None for processor in analysis.processors] == [True, True, False]

    @pytest.mark.parametrize("path", sorted((SHARED / "vectors" / "am2inc").glob("*.amxmi")), ids=lambda path: path.name)
    def test_no_model_is_too_defective(self, path):
        from amalthea_uros.errors import ReadError

        try:
            model = load(path)
        except ReadError:
            return
        analyze_system(extract(model).system)


class TestVerdicts:
    def requirement(self, worst):
        limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=worst * US)
        return Constraints(requirements=(Requirement(name="R", process="low", limit=limit),))

    @pytest.mark.parametrize(("limit", "verdict"), [(31, "met"), (30, "met"), (29, "missed")])
    def test_a_response_time(self, limit, verdict):
        built = one_core(("high", 100, [ticks(20)]), ("low", 100, [ticks(10)]), constraints=self.requirement(limit))
        analysis = analyze_system(built)
        assert analysis.requirements[0].verdict == by_name(analysis)["low"].verdict == verdict
        assert (analysis.summary.schedulable == "no") == (verdict == "missed")

    def test_overload(self):
        built = one_core(("high", 100, [ticks(70)]), ("low", 100, [ticks(40)]), constraints=self.requirement(100))
        analysis = analyze_system(built)
        assert by_name(analysis)["high"].response.worst == 70 * US
        low = by_name(analysis)["low"]
        assert (low.verdict, low.failure, analysis.requirements[0].verdict) == ("unbounded", "overload", "missed")
        assert analysis.processors[0].worst == Fraction("1.1")
        assert analysis.summary.schedulable == "no"


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
        tasks = (replace(built.software.tasks[0], stimuli=("every high",)), built.software.tasks[1])
        (result,) = analyze_system(replace(built, software=replace(built.software, tasks=tasks))).requirements
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

    def test_other_limits_are_reported(self):
        limit = CountLimit(metric=CountMetric.PREEMPTIONS, value=3)
        built = one_core(
            ("low", 100, [ticks(1)]), constraints=Constraints(requirements=(Requirement(name="R", process="low", limit=limit),))
        )
        assert [finding.rule for finding in analyze_system(built).findings] == ["ANA009"]


def test_tasks_that_make_each_other_grow_leave_the_others_alone():
    # The sink interferes with its source, which then triggers it still less regularly: at this load that has no end.
    built = one_core(
        ("sink", None, [ticks(3)]),
        ("source", 6, [ticks(2), Trigger(stimulus="trigger sink")]),
        stimuli=[InterProcess(name="trigger sink")],
    )
    other = system(
        ["other"],
        [Periodic(name="every free", period=10 * US)],
        [Task(name="free", stimuli=("every free",), activities=(ticks(200),))],
        [TaskAllocation(task="free", scheduler="other", priority=1)],
    )
    both = replace(
        built,
        hardware=replace(built.hardware, structures=(*built.hardware.structures, *other.hardware.structures)),
        os=Os(systems=(*built.os.systems, *other.os.systems)),
        stimuli=Stimuli(stimuli=(*built.stimuli.stimuli, *other.stimuli.stimuli)),
        software=Software(tasks=(*built.software.tasks, *other.software.tasks)),
        mapping=Mapping(tasks=(*built.mapping.tasks, *other.mapping.tasks)),
    )
    found = by_name(analyze_system(both))
    assert "increase each other without limit" in found["source"].reason
    assert found["sink"].response is None
    assert found["free"].response is not None
