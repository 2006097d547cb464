"""The metrics of jobs: against the thesis, by hand, and against systems that are played tick by tick."""

from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from math import lcm
from textwrap import dedent

import pytest
import unit_player as player
from hand_made_systems import of_parts, ticks
from hypothesis import assume, given
from hypothesis import strategies as st
from support import ROOT, analysis_of
from unit_player import UnitTask

from amalthea_uros.analyze.response_times import metrics
from amalthea_uros.analyze.results.processes import Metric
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.activities import Call, Chance, Loop, ProbabilitySwitch, SemaphoreAccess, SemaphoreOperation
from amalthea_uros.perf.constraints import Bound, Constraints, Requirement, TimeLimit, TimeMetric
from amalthea_uros.perf.distributions import Uniform
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Semaphore
from amalthea_uros.perf.software import Runnable, Task
from amalthea_uros.perf.stimuli import Counter, Periodic
from amalthea_uros.services.analyze import analyze
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import MICROSECOND as US

#: Figure 6.6 of S. R. Bappanadu, "Modeling and Timing Analysis of Micro-ROS Application on an Off-Road Vehicle Control Unit",
#: University of Stuttgart, 2022: minimum, average and maximum in us, from a simulation of about 5 minutes.
FIGURE_6_6 = {
    "Executor_Task": {
        JobMetric.NET_EXECUTION_TIME: ("12", "12.650", "25"),
        JobMetric.GROSS_EXECUTION_TIME: ("12", "12.650", "25"),
        JobMetric.RESPONSE_TIME: ("12", "12.650", "25"),
        JobMetric.PREEMPTION_TIME: ("0", "0", "0"),
        JobMetric.INITIAL_PENDING_TIME: ("0", "0", "0"),
        JobMetric.START_TO_START: ("1000", "1000", "1000"),
        JobMetric.SLACK_TIME: ("975", "987.349", "988"),
    },
    "Control_Function": {
        JobMetric.NET_EXECUTION_TIME: ("4", "4", "4"),
        JobMetric.GROSS_EXECUTION_TIME: ("4", "4", "4"),
        JobMetric.RESPONSE_TIME: ("16", "16.650", "29"),
        JobMetric.PREEMPTION_TIME: ("12", "12.650", "25"),
        JobMetric.INITIAL_PENDING_TIME: ("12", "12.650", "25"),
        JobMetric.START_TO_START: ("987", "999.999", "1013"),
        JobMetric.SLACK_TIME: ("971", "983.349", "984"),
    },
}
#: The averages of the figure that are not those of an endless run: of n jobs there are n - 1 distances, and the figure is cut off after
#: three digits. The mean slack is the period less the mean response time, which the figure has as 12.650 and 16.650.
ENDLESS = {
    ("Executor_Task", JobMetric.SLACK_TIME): "987.350",
    ("Control_Function", JobMetric.SLACK_TIME): "983.350",
    ("Control_Function", JobMetric.START_TO_START): "1000",
}


@pytest.mark.parametrize("process", FIGURE_6_6)
def test_figure_6_6_of_the_thesis(process):
    found = analysis_of(ROOT / "samples" / "bodas-test-advanced.yaml")[process].metrics
    for name, (minimum, average, maximum) in FIGURE_6_6[process].items():
        metric = found[name]
        assert (metric.min, metric.max) == (Fraction(minimum) * US, Fraction(maximum) * US), name
        assert metric.mean == Fraction(ENDLESS.get((process, name), average)) * US, name
        assert abs(metric.mean - Fraction(average) * US) <= Fraction("0.001") * US, name
        assert metric.claim == "exact"


# Systems


EVERY_SECOND = Counter(prescaler=2)


@dataclass(frozen=True)
class Row:
    """A task that executes from `best` to `worst`, and `extra` in jobs that a counter selects; all in us."""

    period: int
    worst: int
    best: int
    offset: int = 0
    extra: int = 0
    counter: Counter = EVERY_SECOND

    def has_extra(self, number):
        """Whether the n-th job, counted from 1, executes it."""
        return number >= max(self.counter.offset, 1) and (number - self.counter.offset) % self.counter.prescaler == 0


def calls(name, row):
    """What a task of a row executes: a callback in each job, and one that a counter selects."""
    return (Call(runnable=f"{name}.base"), *([Call(runnable=f"{name}.extra", counter=row.counter)] if row.extra else []))


def built(rows, requirements=(), activities=calls, limit=99, semaphores=(), jitter=None):
    """The rows as tasks T0, T1 ... of a core at 1 MHz, the first one has the highest priority."""
    names = [f"T{index}" for index in range(len(rows))]
    callbacks = {}
    for name, row in zip(names, rows, strict=True):
        callbacks |= {f"{name}.base": ticks(row.worst, row.best), f"{name}.extra": ticks(row.extra)}
    named = list(zip(names, rows, strict=True))
    return of_parts(
        [Task(name=n, stimuli=(f"every {n}",), activation_limit=limit, activities=activities(n, row)) for n, row in named],
        [TaskAllocation(task=name, scheduler="core", priority=len(names) - index) for index, name in enumerate(names)],
        [Periodic(name=f"every {n}", period=row.period * US, offset=row.offset * US, jitter=jitter) for n, row in named],
        runnables=[Runnable(name=name, activities=(need,), callback=True) for name, need in callbacks.items()],
        os_parts={"semaphores": tuple(semaphores)},
        constraints=Constraints(requirements=tuple(requirements)),
    )


def play(rows, until, choose):
    """The jobs that are activated before a time, of each task, and some later ones; and what their first callbacks executed."""
    bases = [[] for _ in rows]

    def demand(row, own):
        def of_job(number):
            own.append(choose(row.best, row.worst))
            return own[-1] + (row.extra if row.has_extra(number) else 0)

        return of_job

    tasks = [
        UnitTask(row.period, demand(row, own), row.offset, rank)
        for rank, (row, own) in enumerate(zip(rows, bases, strict=True))
    ]
    return player.play(tasks, until, to_the_end=True), bases


def measured(jobs, deadline):
    """The metrics of jobs of one task, as lists; those from job to job are one shorter."""
    jobs = [job for job in jobs if not job.left]
    pairs = list(pairwise(jobs))
    return {
        JobMetric.NET_EXECUTION_TIME: [job.demand for job in jobs],
        JobMetric.GROSS_EXECUTION_TIME: [job.end - job.start for job in jobs],
        JobMetric.RESPONSE_TIME: [job.end - job.release for job in jobs],
        JobMetric.INITIAL_PENDING_TIME: [job.start - job.release for job in jobs],
        JobMetric.READY_TIME: [job.end - job.start - job.demand for job in jobs],
        JobMetric.PREEMPTION_TIME: [job.end - job.release - job.demand for job in jobs],
        JobMetric.WAITING_TIME: [0 for _ in jobs],
        JobMetric.ACTIVATE_TO_ACTIVATE: [then.release - job.release for job, then in pairs],
        JobMetric.START_TO_START: [then.start - job.start for job, then in pairs],
        JobMetric.END_TO_END: [then.end - job.end for job, then in pairs],
        JobMetric.END_TO_START: [then.start - job.end for job, then in pairs],
        JobMetric.SLACK_TIME: [job.release + deadline - job.end for job in jobs],
        JobMetric.LATENESS: [job.end - job.release - deadline for job in jobs],
    }


def horizon(rows):
    """When the schedule repeats, and for how long it does."""
    cycle = lcm(*(row.period * (row.counter.prescaler if row.extra else 1) for row in rows))
    return max(row.offset + row.counter.offset * row.period for row in rows) + cycle, cycle


@st.composite
def task_sets(draw, is_constant=False):
    found = []
    for _ in range(draw(st.integers(1, 3))):
        worst = draw(st.integers(1, 3))
        found.append(
            Row(
                period=draw(st.sampled_from([3, 4, 6, 8, 12])),
                worst=worst,
                best=worst if is_constant else draw(st.integers(1, worst)),
                offset=draw(st.integers(0, 7)),
                extra=draw(st.integers(0, 2)),
                counter=Counter(prescaler=draw(st.integers(2, 3)), offset=draw(st.integers(0, 4))),
            )
        )
    load = sum(Fraction(row.worst, row.period) + Fraction(row.extra, row.period * row.counter.prescaler) for row in found)
    assume(load <= 1)
    return found


def with_deadlines(rows):
    """A limit of the response time of 10 us for each task: the deadline for slack and lateness."""
    limit = TimeLimit(metric=TimeMetric.RESPONSE_TIME, value=10 * US)
    return [Requirement(name=f"R{index}", process=f"T{index}", limit=limit) for index in range(len(rows))]


@given(task_sets(is_constant=True))
def test_all_metrics_of_constant_execution_times_are_exact(rows):
    analysis = analyze_system(built(rows, with_deadlines(rows)))
    start, cycle = horizon(rows)
    played, _ = play(rows, start + 2 * cycle, max)
    for index, row in enumerate(rows):
        found = analysis[f"T{index}"].metrics
        jobs = [job for job in played[index] if job.release < start + 2 * cycle]
        everything = measured(jobs, 10)
        # One more job than in a cycle, for the times from job to job.
        last = measured([job for job in jobs if job.release >= start], 10)
        count = cycle // row.period
        assert set(found) == set(everything)
        for name, metric in found.items():
            assert metric.claim == "exact", name
            assert (metric.min, metric.max) == (min(everything[name]) * US, max(everything[name]) * US), name
            assert metric.mean == Fraction(sum(last[name][:count]), count) * US, name


@given(task_sets(), st.randoms(use_true_random=False))
def test_no_job_is_beyond_the_metrics_of_varying_execution_times(rows, random):
    analysis = analyze_system(built(rows, with_deadlines(rows)))
    start, cycle = horizon(rows)
    plays = [play(rows, start + 2 * cycle, choose)[0] for choose in (min, max, random.randint)]
    for index in range(len(rows)):
        found = analysis[f"T{index}"].metrics
        worst, best, drawn = (measured(jobs[index], 10) for jobs in plays)
        for name, metric in found.items():
            seen = [*worst[name], *best[name], *drawn[name]]
            assert metric.min <= min(seen) * US, name
            assert metric.max >= max(seen) * US, name
            if metric.claim == "exact":
                assert (metric.min, metric.max) == (min(seen) * US, max(seen) * US), name
        for name in (JobMetric.RESPONSE_TIME, JobMetric.INITIAL_PENDING_TIME, JobMetric.PREEMPTION_TIME):
            assert found[name].claim == "exact"


class TestByHand:
    """A task of 20 us every 100, below one of 10 to 30 us that comes 5 us later."""

    ROWS = (Row(100, 30, 10, offset=5), Row(100, 20, 20))

    def metric(self, name, rows=ROWS, process="T1"):
        found = analyze_system(built(rows))[process].metrics[name]
        mean = None if found.mean is None else found.mean / US
        return found.min // US, mean, found.max // US, found.claim

    def test_a_start_that_is_known_makes_the_gross_execution_time_exact(self):
        assert self.metric(JobMetric.GROSS_EXECUTION_TIME) == (30, None, 50, "exact")

    def test_a_start_that_varies_leaves_bounds(self):
        # It starts after 10 us at the earliest and ends after 80 us at the latest, but not in the same job.
        rows = (Row(100, 30, 10, offset=15), Row(100, 30, 10), Row(100, 20, 20))
        assert self.metric(JobMetric.GROSS_EXECUTION_TIME, rows, "T2") == (20, None, 80 - 10, "bound")

    def test_means_of_varying_execution_times(self):
        # The mean of bounds is their middle: 20 us of the other task.
        assert self.metric(JobMetric.NET_EXECUTION_TIME, process="T0") == (10, 20, 30, "exact")
        assert self.metric(JobMetric.RESPONSE_TIME, process="T0") == (10, 20, 30, "exact")
        # What the preemption takes in the mean is not known from bounds alone.
        assert self.metric(JobMetric.PREEMPTION_TIME) == (10, None, 30, "exact")
        # The sum over n jobs of what lies between them is n periods.
        assert self.metric(JobMetric.END_TO_END) == (100 - 20, 100, 100 + 20, "bound")


class TestMerging:
    """Phases that nobody stated: any of them can be the one of the system."""

    SHORT = Metric(min=1, max=4, mean=Fraction(2), attained=(1, 4))
    LONG = Metric(min=3, max=8, mean=Fraction(5), attained=(3, 8))

    def merged(self, *variants):
        return metrics.merged([{JobMetric.RESPONSE_TIME: variant} for variant in variants])[JobMetric.RESPONSE_TIME]

    def test_the_mean_is_that_over_all_phases(self):
        assert self.merged(self.SHORT, self.LONG) == Metric(min=1, max=8, mean=Fraction(7, 2), attained=(1, 8))

    def test_what_is_unknown_in_one_phase_is_unknown(self):
        unbounded = Metric(min=0, max=None)
        assert self.merged(self.SHORT, unbounded) == Metric(min=0, max=None, attained=(1, 4))

    def test_a_bound_beyond_what_occurs_is_a_bound(self):
        assert self.merged(self.SHORT, Metric(min=1, max=9)).claim == "bound"
        assert self.merged(self.SHORT, Metric(min=2, max=3)).claim == "exact"


class TestCallbacks:
    @given(task_sets(), st.booleans(), st.randoms(use_true_random=False))
    def test_against_systems_that_are_played(self, rows, is_constant, random):
        rows = [replace(row, best=row.worst) for row in rows] if is_constant else rows
        analysis = analyze_system(built(rows))
        start, cycle = horizon(rows)
        plays = [play(rows, start + 2 * cycle, choose) for choose in (min, max, random.randint)]
        for index, row in enumerate(rows):
            seen = {"base": [], "extra": []}
            for jobs, bases in plays:
                for job in (job for job in jobs[index] if not job.left):
                    seen["base"].append(job.reached[bases[index][job.number - 1] - 1] - job.release)
                    if row.extra and row.has_extra(job.number):
                        seen["extra"].append(job.response)
            for name in ["base", "extra"] if row.extra else ["base"]:
                response = analysis.callbacks[f"T{index}.{name}"].response
                assert (response.best, response.worst) == (min(seen[name]) * US, max(seen[name]) * US), name
                assert response.claim == "exact"

    def test_the_executor_of_rclc(self):
        # Of 20 us for spinning, 4 us for Blink in each 50th job, 51 us to take a message of On_Imu, 23.8 us one of On_Command in each
        # 10th job, 4 us for Control in each 2nd; then On_Imu 90 us, On_Command 40 us, Control 150 to 220 us and 27.4 us to publish.
        callbacks = analysis_of(ROOT / "samples" / "rclc-in-executor.yaml").callbacks
        found = {c.name: (c.response.best / US, c.response.worst / US, c.response.claim, c.deadline / US) for c in callbacks}
        every = 20 + 51 + 90
        assert found == {
            "On_Imu_Callback": (every, every + 4 + 23.8 + 4, "exact", 10_000),
            "On_Command_Callback": (every + 23.8 + 40, every + 4 + 23.8 + 4 + 40, "exact", 100_000),
            "Control_Callback": (every + 4 + 150 + 27.4, every + 4 + 23.8 + 4 + 40 + 220 + 27.4, "exact", 20_000),
        }
        means = {c.name: c.metrics[JobMetric.RESPONSE_TIME].mean for c in callbacks}
        # Of 50 jobs one notifies Blink, 5 take a command, and 25 notify Control; over all phases, one of the 5 is the one with Blink in
        # a tenth of them, and half of them notify Control.
        assert means["On_Imu_Callback"] == (every + Fraction(4 + 5 * Fraction("23.8") + 25 * 4, 50)) * US
        assert means["On_Command_Callback"] == (every + Fraction("23.8") + Fraction(4, 2) + 40 + Fraction(4, 50)) * US
        assert means["Control_Callback"] is None

    ROWS = (Row(100, 30, 30), Row(200, 20, 15, extra=10))
    JITTER = Uniform(lower=0, upper=10 * US)

    def response(self, name, **options):
        response = analyze_system(built(self.ROWS, **options)).callbacks[name].response
        return response.best / US, response.worst / US, response.claim

    def test_unknown_releases(self):
        # The job of 30 us below another one of 30: at most 60 us. In jobs of both callbacks the first one ends 10 us earlier, but
        # what most jobs do not execute does not shorten the bound.
        assert self.response("T1.base", jitter=self.JITTER) == (15, 60, "bound")
        assert self.response("T1.extra", jitter=self.JITTER) == (25, 60, "bound")

    def test_what_each_job_still_executes_shortens_the_bound(self):
        def with_rest(name, row):
            return (*calls(name, row), ticks(8, 6)) if name == "T1" else calls(name, row)

        # At most 30 + 20 + 10 + 8 us for the process.
        assert self.response("T1.base", jitter=self.JITTER, activities=with_rest) == (15, 68 - 6, "bound")

    def test_callbacks_whose_phases_are_too_many(self):
        application = """
            amuros: 1
            name: slow-topics
            hardware: {platform: generic}
            middleware:
              executor: {name: Spin, period: 5 ms, callbacks: in-executor, execution_time: {base: 18 us, per_message: 22 us}}
            application:
              nodes:
                - name: robot
                  subscriptions:
                    - {name: Often, topic: a, rate: 20 Hz, message_size: 4 B, execution_time: {min: 21 us, max: 44 us}}
                    - {name: Seldom, topic: b, rate: 1 Hz, message_size: 4 B, execution_time: {min: 5 us, max: 9 us}}
                  timers:
                    - {name: Each, period: 5 ms, execution_time: {min: 310 us, max: 520 us}}
                    - {name: Fourth, period: 20 ms, execution_time: {min: 180 us, max: 260 us}}
            """
        # A job takes 18 + 22 + 44 + 22 + 9 + 520 + 260 us at most; after the messages, it executes Each in any case.
        found = {
            each.name: (each.response.best / US, each.response.worst / US) for each in analyze(dedent(application)).callbacks
        }
        assert found == {
            "Often_Callback": (21, 895 - 310),
            "Seldom_Callback": (5, 895 - 310),
            "Each_Callback": (18 + 310, 895),
            "Fourth_Callback": (180, 895),
        }

    def test_a_call_in_a_branch(self):
        def by_chance(name, row):
            taken = Chance(weight=1, activities=(ticks(5), *calls(name, row)[:1]))
            branching = (ProbabilitySwitch(branches=(taken, Chance(weight=1, activities=()))), ticks(2))
            return branching if name == "T1" else calls(name, row)

        # Executed in 15 us at least; the process responds after 30 + 5 + 20 + 2 us at most.
        assert self.response("T1.base", activities=by_chance) == (30 + 15, 57, "bound")

    def test_a_process_that_is_unknown(self):
        def forever(name, row):
            return (*calls(name, row), Loop(activities=(ticks(1),)))

        found = analyze_system(built(self.ROWS, activities=forever)).callbacks["T1.base"]
        assert found.response is None
        assert found.reason.startswith("the response time of 'T1' is unknown: ")


class TestRequirements:
    def result(self, rows, metric, value, bound=Bound.UPPER, process=None, runnable=None, **options):
        limit = TimeLimit(metric=metric, value=value * US, bound=bound)
        requirement = Requirement(name="R", limit=limit, process=process, runnable=runnable)
        (result,) = analyze_system(built(rows, [requirement], **options)).requirements
        return result

    ROWS = (Row(100, 12, 12, extra=13, counter=Counter(prescaler=20)), Row(100, 4, 4))

    @pytest.mark.parametrize(
        ("metric", "minimum", "maximum"),
        [
            # The task of 4 us starts when the one above ends, after 12 or 25 us, and is not interrupted.
            (TimeMetric.GROSS_EXECUTION_TIME, 4, 4),
            (TimeMetric.READY_TIME, 0, 0),
            (TimeMetric.START_DELAY, 12, 25),
            (TimeMetric.START_TO_START, 100 - 13, 100 + 13),
            (TimeMetric.END_TO_END, 100 - 13, 100 + 13),
            (TimeMetric.END_TO_START, 100 - 13 - 4, 100 + 13 - 4),
            (TimeMetric.POLLING_TIME, 0, 0),
        ],
    )
    def test_of_processes(self, metric, minimum, maximum):
        upper = self.result(self.ROWS, metric, maximum, process="T1")
        lower = self.result(self.ROWS, metric, minimum, Bound.LOWER, process="T1")
        assert (lower.value, lower.verdict, upper.value, upper.verdict) == (minimum * US, "met", maximum * US, "met")
        assert self.result(self.ROWS, metric, maximum - 1, process="T1").verdict == "missed"
        assert self.result(self.ROWS, metric, minimum + 1, Bound.LOWER, process="T1").verdict == "missed"

    @pytest.mark.parametrize(("limit", "verdict"), [(12, "met"), (11, "missed")])
    def test_of_runnables(self, limit, verdict):
        # The first callback of the executor never waits for the second one.
        result = self.result(self.ROWS, TimeMetric.RESPONSE_TIME, limit, runnable="T0.base")
        assert (result.object, result.value, result.verdict) == ("T0.base", 12 * US, verdict)

    def test_a_runnable_of_several_processes_is_judged_by_all_of_them(self):
        def shared(name, row):
            return (ticks(row.worst), Call(runnable="T0.base"))

        rows = (Row(100, 12, 12), Row(200, 4, 4))
        # 12 + 12 us, and below that 4 + 12.
        assert self.result(rows, TimeMetric.RESPONSE_TIME, 40, runnable="T0.base", activities=shared).value == 40 * US

    def test_a_metric_that_runnables_do_not_have(self):
        result = self.result(self.ROWS, TimeMetric.LATENESS, 10, runnable="T0.base")
        assert (result.verdict, result.reason) == ("unknown", "the lateness of 'T0.base' is not computed")

    def test_lost_activations_leave_the_times_between_jobs_unknown(self):
        # The second job of T1 is activated after 10 us, when the first one has 3 us left: with a limit of 1 it is lost.
        rows = (Row(20, 8, 8), Row(10, 5, 5))
        kept = self.result(rows, TimeMetric.START_TO_START, 100, process="T1")
        lost = self.result(rows, TimeMetric.START_TO_START, 100, process="T1", limit=1)
        assert (kept.verdict, lost.verdict) == ("met", "unknown")

    def test_who_can_wait_for_a_semaphore_has_no_polling_time_of_zero(self):
        def locking(name, row):
            return tuple(
                SemaphoreAccess(semaphore="S", operation=operation) if operation else ticks(row.worst)
                for operation in (SemaphoreOperation.REQUEST, None, SemaphoreOperation.RELEASE)
            )

        rows = (Row(100, 10, 10), Row(100, 20, 20))
        for ceiling, verdict in ((True, "met"), (False, "unknown")):
            semaphore = Semaphore(name="S", ceiling=ceiling)
            result = self.result(rows, TimeMetric.WAITING_TIME, 0, process="T0", activities=locking, semaphores=[semaphore])
            assert result.verdict == verdict
