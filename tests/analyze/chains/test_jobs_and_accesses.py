"""Which jobs take part in a chain, and when they access data: counters, branches, preemptions at an access, times up to an access."""

from dataclasses import replace
from itertools import pairwise

import pytest
from effort import examples
from hand_made_systems import changed
from hypothesis import given
from hypothesis import strategies as st
from test_chain_systems import END, START, at, evaluate, read, system, ticks, write

from amalthea_uros import analyze_system
from amalthea_uros.analyze.chains import job_chains
from amalthea_uros.analyze.constraints.events import EventWindows
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.activities import Call, Chance, Communication, Count, Group, ProbabilitySwitch, Trigger
from amalthea_uros.perf.constraints import Constraints, EventSynchronization, LatencyConstraint, LatencyKind
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.events import RunnableChange, RunnableEvent
from amalthea_uros.perf.software import Preemption, Runnable
from amalthea_uros.perf.stimuli import Counter, InterProcess, Periodic, RelativePeriodic
from amalthea_uros.units import MICROSECOND as US


def with_stimuli(built, **changed):
    """The system with other stimuli of some tasks."""
    stimuli = tuple(changed.get(stimulus.name, stimulus) for stimulus in built.stimuli.stimuli)
    return replace(built, stimuli=replace(built.stimuli, stimuli=stimuli))


def with_preemption(built, preemption, *names):
    for name in names:
        built = changed(built, name, preemption=preemption)
    return built


class TestAccessesAtAPreemption:
    A = ("A", 10, [ticks(1), write("L0")], "core", 2)
    C = ("C", 20, [read("L1"), ticks(1)], "core", 3)
    B = ("B", 20, [ticks(2), read("L0"), write("L1"), ticks(1)], "core", 0)

    @pytest.mark.parametrize("order", [(A, C, B), (C, A, B)])
    def test_an_access_comes_before_or_after_who_arrives_just_then(self, order):
        built = system(order, [at("A", START), at("B", END), at("C", END)])
        _, values, claims, _ = evaluate(built, communication=Communication.EXPLICIT)
        assert claims == {"bound"}
        # B executes from 0 to 2, when A and then C arrive, and again from 4 to 5: it can read and write from 2 to 4. Reading at 2
        # and writing at 4, it takes A's value of 3 at 22, and C, which reads at 23, gets it at 43 and ends at 44. A started at 2, and
        # before that at -8; the output of 44 is replaced at 64 and is based on A's job of 12.
        assert (values["max_reduced_reaction_time"], values["max_reaction_time"]) == (44 - 2, 44 + 8)
        assert (values["max_reduced_data_age"], values["max_data_age"]) == (44 - 12, 64 - 12)
        # Always before the others, or always after them, is possible as well: A's value of 12 leaves C at 24 or at 44.
        assert values["min_first_to_first"] <= 12

    def test_it_is_certain_if_nobody_arrives_just_then(self):
        a, c = (*self.A[:4], 1), (*self.C[:4], 7)
        built = system([a, c, self.B], [at("A", START), at("B", END), at("C", END)])
        _, values, claims, _ = evaluate(built, communication=Communication.EXPLICIT)
        assert claims == {"exact"}
        # B executes from 0 to 1 and from 2 to 4, and accesses at 3; A has written at 2 and at 12, C reads at 7 and ends at 8.
        assert (values["max_reduced_reaction_time"], values["max_reaction_time"]) == (28 - 11, 28 - 1)
        assert values["min_first_to_first"] == 8 - 1

    def test_the_last_access_of_a_job_can_wait_for_those_who_arrive(self):
        tasks = [("C", 8, [ticks(1), read("L"), ticks(1), ticks(1)], "core", 4), ("A", 12, [ticks(1), write("L")], "core", 7)]
        built = system(tasks, [at("A", START), at("C", END)])
        _, values, claims, _ = evaluate(built, communication=Communication.EXPLICIT)
        assert claims == {"bound"}
        # A's job of 19 ends at 20, when C arrives, which reads at 21: it is too late for that if it writes at 23.
        assert values["max_reduced_reaction_time"] == 31 - 19


class TestCounters:
    """A callback in every n-th job of an executor, and another one in every m-th."""

    def build(self, first, then, is_first_before):
        calls = [Call(runnable="first", counter=first), Call(runnable="then", counter=then)]
        runnables = [
            Runnable(name="first", activities=(ticks(1), write("L"))),
            Runnable(name="then", activities=(read("L"), ticks(2))),
        ]
        events = (
            RunnableEvent(name="start", runnable="first", change=RunnableChange.START),
            RunnableEvent(name="end", runnable="then", change=RunnableChange.TERMINATE),
        )
        tasks = [("executor", 10, [ticks(3), *(calls if is_first_before else calls[::-1])])]
        return system(tasks, events, runnables=runnables)

    def test_a_message_every_50_jobs_and_a_timer_every_10(self):
        _, values, claims, _ = evaluate(self.build(Counter(prescaler=50, offset=2), Counter(prescaler=10, offset=1), True))
        assert claims == {"exact"}
        # Taken in the second job at 10 + 3, used in the eleventh at 100 + 3 to 5; the message before it came 500 earlier.
        assert (values["max_reduced_reaction_time"], values["max_reaction_time"]) == (92, 592)

    @pytest.mark.parametrize("offset", [1, 1000])
    def test_the_first_jobs_of_a_counter_can_come_late(self, offset):
        # Jobs 1, 4, 7 and so on, or those from 1000 on; the other callback is in odd jobs: in the same one, or in the next one.
        _, values, claims, _ = evaluate(self.build(Counter(prescaler=3, offset=offset), Counter(prescaler=2, offset=1), True))
        assert claims == {"exact"}
        assert (values["min_first_to_first"], values["max_reduced_reaction_time"]) == (3, 12)
        assert values["max_reaction_time"] == 12 + 30

    COUNTERS = st.builds(Counter, prescaler=st.integers(1, 5), offset=st.integers(0, 7))

    @examples(36)
    @given(
        first=COUNTERS, then=COUNTERS, is_first_before=st.booleans(), communication=st.sampled_from(["implicit", "explicit"])
    )
    def test_any_two(self, first, then, is_first_before, communication):
        built = self.build(first, then, is_first_before)
        _, values, claims, _ = evaluate(built, communication=Communication(communication))
        assert claims == {"exact"}

        def occurs(counter, job):
            return job >= max(counter.offset, 1) and (job - counter.offset) % counter.prescaler == 0

        starts, ends = [], []
        for job in range(1, 400):
            now = 10 * (job - 1) + 3
            for is_first in (is_first_before, not is_first_before):
                if not occurs(first if is_first else then, job):
                    continue
                if is_first:
                    starts.append(now)
                now += 1 if is_first else 2
                if not is_first:
                    ends.append(now)
        found = []
        # No job reads before the first one.
        for before, start in pairwise([starts[0], *starts]):
            # The first that begins when it has ended.
            end = next((end for end in ends if end - 2 >= start + 1), None)
            if end is not None:
                found.append((end - before, end - start))
        assert values["max_reaction_time"] == max(found)[0]
        assert values["max_reduced_reaction_time"] == max(reduced for _, reduced in found)
        assert values["min_first_to_first"] == min(reduced for _, reduced in found)

    def test_nested_counters_compose(self):
        # Every second job calls outer, and every third of these calls inner: jobs 6, 12, and so on.
        runnables = [
            Runnable(name="outer", activities=(Call(runnable="inner", counter=Counter(prescaler=3)),)),
            Runnable(name="inner", activities=(write("L"),)),
        ]
        tasks = [("A", 10, [ticks(1), Call(runnable="outer", counter=Counter(prescaler=2))]), ("B", 10, [read("L"), ticks(1)])]
        _, values, claims, _ = evaluate(system(tasks, [at("A", START), at("B", END)], runnables=runnables))
        assert claims == {"exact"}
        assert (values["max_reduced_reaction_time"], values["max_reaction_time"]) == (2, 62)

    def test_a_counter_that_others_advance_gives_no_bound(self):
        # Every second activation counts, and that can always be one by the other task.
        tasks = [
            ("A", 10, [ticks(1), Trigger(stimulus="go")]),
            ("other", 10, [ticks(1), Trigger(stimulus="go")]),
            ("B", None, [ticks(1)]),
        ]
        stimuli = [InterProcess(name="go", counter=Counter(prescaler=2))]
        built = system(tasks, [at("A", START), at("B", END)], stimuli=stimuli)
        chain, values, _, _ = evaluate(changed(built, "B", stimuli=("go",)))
        assert chain.reason == "a counter of 'B' also counts activations by others"
        assert not values


class TestOrderWithinAJob:
    def test_runnables_of_an_unordered_group_use_each_others_data_in_the_same_job_or_in_the_next_one(self):
        runnables = [
            Runnable(name="first", activities=(ticks(1), write("L"))),
            Runnable(name="then", activities=(read("L"), ticks(1))),
        ]
        group = Group(activities=(Call(runnable="first"), Call(runnable="then")), ordered=False)
        events = (
            RunnableEvent(name="start", runnable="first", change=RunnableChange.START),
            RunnableEvent(name="end", runnable="then", change=RunnableChange.TERMINATE),
        )
        _, values, claims, _ = evaluate(system([("A", 10, [group])], events, runnables=runnables))
        assert claims == {"bound"}
        # If first comes last, its data are used in the next job, from 1 to 11; if it comes first, from 0 to 2.
        assert values["max_reduced_reaction_time"] >= 11 - 1
        assert values["min_first_to_first"] <= 2

    def test_a_branch_that_jobs_need_not_take_gives_no_bound(self):
        switch = ProbabilitySwitch(branches=(Chance(weight=1.0, activities=(write("L"),)), Chance(weight=1.0, activities=())))
        tasks = [("A", 10, [ticks(1), switch]), ("B", 10, [read("L"), ticks(1)])]
        chain, values, _, rules = evaluate(system(tasks, [at("A", START), at("B", END)]))
        assert "max_reaction_time" not in values
        assert chain.reason == "jobs of 'A' can end without the access or event of the chain"
        assert rules == ["CHN003"]

    @pytest.mark.parametrize(
        ("times", "is_certain"),
        [
            # Any number of jobs without an access can have an average of 1.5, too.
            *((times, False) for times in (0.5, 1.5, Count(least=0, mean=1.0, most=2))),
            *((times, True) for times in (None, 1.0, Count(least=1, mean=1.5, most=2))),
        ],
    )
    def test_only_an_access_that_always_occurs_gives_a_bound(self, times, is_certain):
        tasks = [("A", 10, [ticks(1), replace(write("L"), times=times)]), ("B", 10, [read("L"), ticks(1)])]
        chain, values, _, _ = evaluate(system(tasks, [at("A", START), at("B", END)]))
        assert ("max_reaction_time" in values) is is_certain
        assert (chain.reason == "jobs of 'A' can end without the access or event of the chain") is not is_certain


class TestTimesUpToAnAccess:
    @pytest.mark.parametrize("preemption", Preemption)
    def test_an_access_does_not_wait_for_the_rest_of_its_job(self, preemption):
        tasks = [
            ("high", 5, [ticks(1)], "one"),
            ("writer", 20, [ticks(2), write("L"), ticks(9)], "one"),
            ("reader", 10, [read("L"), ticks(1)], "two"),
        ]
        built = system(tasks, [at("writer", START), at("reader", END)], cores=("one", "two"))
        jitter = Boundaries(lower=0, upper=US)
        built = with_stimuli(
            built,
            high=Periodic(name="high", period=5 * US, jitter=jitter),
            writer=Periodic(name="writer", period=20 * US, jitter=jitter),
        )
        _, values, _, _ = evaluate(with_preemption(built, preemption, "writer"), communication=Communication.EXPLICIT)
        # 21 from one job to the next, written after 2 and one job of high, then 10 and 1 at the reader. The job ends after 14.
        assert values["max_reaction_time"] == 21 + 3 + 10 + 1

    def test_who_arrives_when_the_part_ends_counts(self):
        tasks = [
            ("high", 3, [ticks(1)], "one"),
            ("writer", 20, [ticks(2), write("L"), ticks(1)], "one"),
            ("reader", 10, [read("L"), ticks(1)], "two"),
        ]
        built = system(tasks, [at("writer", START), at("reader", END)], cores=("one", "two"))
        sporadic = RelativePeriodic(name="high", distance=Boundaries(lower=3 * US, upper=9 * US))
        _, values, _, _ = evaluate(with_stimuli(built, high=sporadic), communication=Communication.EXPLICIT)
        # high at 0 and at 3, when the writer has executed 2: it writes at 4, and the reader sees that up to 14 later and ends.
        assert values["max_reaction_time"] <= 20 + 4 + 10 + 1
        # Released with the writer at 0, the reader of 30 uses what was written at 24 at the latest: 31 since the job of 0 at least.
        assert values["max_reaction_time"] >= 31


class TestLogicalExecutionTimes:
    def evaluate(self, stimulus):
        tasks = [("A", 20, [ticks(1), write("L")]), ("B", 10, [read("L"), ticks(1)])]
        built = with_stimuli(system(tasks, [at("A", START), at("B", END)]), A=stimulus)
        return evaluate(built, communication=Communication.LET)

    def test_a_task_with_jitter(self):
        _, values, claims, _ = self.evaluate(Periodic(name="A", period=20 * US, jitter=Boundaries(lower=0, upper=3 * US)))
        assert claims == {"bound"}
        # Up to 23 to the next job, whose output is visible 20 after its release; the reader waits up to 10 and takes 10.
        assert values["max_reaction_time"] == 23 + 20 + 10 + 10

    def test_a_sporadic_task_has_no_period_after_which_its_output_is_visible(self):
        chain, values, _, _ = self.evaluate(RelativePeriodic(name="A", distance=Boundaries(lower=20 * US, upper=50 * US)))
        assert chain.reason == "'A' has no period, as LET communication requires"
        assert not values


class TestLongResponses:
    @pytest.mark.parametrize("communication", [Communication.IMPLICIT, Communication.EXPLICIT])
    def test_jobs_that_are_released_before_earlier_ones_have_ended(self, communication):
        tasks = [
            ("T2", 20, [ticks(10)]),
            ("T0", 30, [ticks(6)]),
            ("T4", 20, [ticks(1, 0), read("L0"), ticks(1)]),
            ("T3", 10, [write("L0"), ticks(1)]),
            ("T1", 60, [ticks(2)]),
        ]
        built = with_preemption(system(tasks, [at("T3", START), at("T4", END)]), Preemption.COOPERATIVE, "T1", "T3", "T4")
        _, values, claims, rules = evaluate(built, communication=communication)
        assert claims == {"bound"}
        assert not rules
        # T2, T0, T4, T3 and T1 are released at 0: T4 reads at 16 at the earliest, T3 writes before 20.
        assert values["max_reaction_time"] >= 20


class TestFailures:
    def test_an_error_in_one_evaluation_leaves_the_others(self, monkeypatch):
        def fail(*_):
            raise IndexError("index 7 is out of bounds")

        tasks = [("A", 10, [ticks(1), write("L")]), ("B", 10, [read("L"), ticks(1)])]
        built = system(tasks, [at("A", START), at("B", END)])
        limit = LatencyConstraint(name="limit", chain="chain", kind=LatencyKind.REACTION, maximum=50 * US)
        spread = EventSynchronization(name="spread", events=("A start", "B terminate"), tolerance=5 * US)
        built = replace(built, constraints=Constraints(constraints=(limit, spread)))
        monkeypatch.setattr(job_chains, "build_job_chains", fail)
        monkeypatch.setattr(EventWindows, "spread", fail)
        analysis = analyze_system(built)
        assert [process.verdict for process in analysis.processes] == [Verdict.MET, Verdict.MET]
        (chain,) = analysis.chains
        assert chain.values == ()
        assert "IndexError: index 7 is out of bounds" in chain.reason
        assert [requirement.verdict for requirement in analysis.requirements] == [Verdict.UNKNOWN, Verdict.UNKNOWN]
        assert [(finding.rule, finding.object) for finding in analysis.findings] == [("CHN006", "chain"), ("CHN006", "spread")]
