"""Tasks that any core of their scheduler executes: a bound computed by hand, what is refused, and random systems that are simulated."""

from dataclasses import replace
from itertools import product
from random import Random

import pytest
from effort import examples
from fuzzing.contradictions import contradictions
from hand_made_systems import Proc, locked, of_parts, system, ticks
from hypothesis import given
from hypothesis import strategies as st
from opponent.simulation import record

from amalthea_uros import Claim, analyze_system
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.hardware import Clock, Core
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Policy, Scheduler, Semaphore
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.perf.stimuli import Periodic, Stimuli
from amalthea_uros.report.wording.closing_line import closing_line
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import Duration


def built(rows, cores=2, preemption=Preemption.PREEMPTIVE, **parts):
    """Tasks T0, T1, ... of (period, least, worst execution time, offset), the most important first, on cores of one scheduler."""
    names = [f"c{number}" for number in range(cores)]
    return of_parts(
        [
            Task(name=f"T{number}", stimuli=(f"s{number}",), activities=(ticks(row[2], row[1]),), preemption=preemption)
            for number, row in enumerate(rows)
        ],
        [TaskAllocation(task=f"T{number}", scheduler="all", priority=100 - number) for number in range(len(rows))],
        [Periodic(name=f"s{number}", period=row[0] * US, offset=row[3] * US) for number, row in enumerate(rows)],
        cores=names,
        schedulers=[Scheduler(name="all", policy=Policy.FIXED_PRIORITY_PREEMPTIVE, cores=tuple(names))],
        **parts,
    )


def bounds(found):
    return [each.response and each.response.worst and each.response.worst / US for each in found.processes]


def test_the_two_highest_have_a_core_each_and_the_third_one_waits_for_both():
    # Both cores can be busy for 2: after that T0 has ended. T2 then executes 2..6.
    found = analyze_system(built([(10, 2, 2, 0), (10, 3, 3, 0), (10, 4, 4, 0)]))
    assert bounds(found) == [2, 3, 6]
    assert closing_line(found.summary).startswith("Schedulable: yes")


def test_who_need_not_end_in_its_period_has_no_bound_and_neither_have_those_below():
    found = analyze_system(built([(10, 9, 9, 0), (10, 9, 9, 0), (10, 9, 9, 0), (100, 1, 1, 0)]))
    assert bounds(found) == [9, 9, None, None]
    assert "need not end before its next activation" in found["T2"].reason
    assert found["T3"].reason == "depends on 'T2', which has no bounded response time"


ON_BOTH = [Scheduler(name="s0", policy=Policy.OSEK, cores=("c0", "c1"))]
REST = Proc("rest", (ticks(1),), 10, priority=1)


@pytest.mark.parametrize(
    "model",
    [
        system(Proc("T", (ticks(1),), 10, priority=1), REST, schedulers=ON_BOTH),
        system(Proc("T", locked("s", 1), 10, priority=2), REST, schedulers=ON_BOTH, semaphores=(Semaphore(name="s"),)),
        system(
            Proc("T", (ticks(1),), 10, priority=2, task={"preemption": Preemption.NON_PREEMPTIVE}), REST, schedulers=ON_BOTH
        ),
        system(Proc("T", (ticks(1),), stimuli=("go",), priority=2), REST, schedulers=ON_BOTH, triggers=("go",)),
        system(
            Proc("T", (ticks(1),), 10, priority=2), Proc("irq_0", (ticks(1),), 9, priority=1, is_isr=True), schedulers=ON_BOTH
        ),
    ],
    ids=["equal priorities", "a lock", "one is not preemptive", "triggered", "an interrupt on one of the cores"],
)
def test_what_the_method_does_not_cover_is_unknown(model):
    found = analyze_system(model)["T"]
    assert (found.response, found.reason) == (None, "several cores can execute it: c0, c1")


def test_cores_of_different_clocks():
    model = built([(10, 1, 1, 0)])
    (structure,) = model.hardware.structures
    slower = replace(structure, cores=(structure.cores[0], Core(name="c1", clock="slow")))
    clocks = (*model.hardware.clocks, Clock(name="slow", frequency=model.hardware.clocks[0].frequency / 2))
    found = analyze_system(replace(model, hardware=replace(model.hardware, clocks=clocks, structures=(slower,))))
    assert found["T0"].response is None
    assert any("the same time on each of its cores" in each.message for each in found.findings)


NON_PREEMPTIVE = Preemption.NON_PREEMPTIVE


def test_without_preemption_the_highest_one_waits_for_a_core():
    # T1 and T2 have begun when T0 is activated; T1 ends at 4. T3 begins after T2, at 6.
    found = analyze_system(built([(20, 3, 3, 1), (20, 4, 4, 0), (20, 6, 6, 0), (20, 2, 2, 0)], preemption=NON_PREEMPTIVE))
    assert bounds(found) == [6, 4, 6, 8]
    assert {each.response.claim for each in found.processes} == {Claim.BOUND}
    assert all(sum(each.response.terms.values()) == each.response.worst for each in found.processes)
    assert closing_line(found.summary).startswith("Schedulable: yes")
    assert "periodic tasks are released at their offsets; the default offset is 0" in found.assumptions


def test_who_is_never_preempted_and_need_not_end_in_its_period_leaves_all_unknown():
    found = analyze_system(built([(4, 1, 1, 0), (10, 8, 8, 0), (10, 8, 8, 0)], preemption=NON_PREEMPTIVE))
    assert {each.reason for each in found.processes} == {
        "a task on its 2 cores need not end before its next activation, and is never preempted"
    }
    assert bounds(found) == [None] * 3
    found = analyze_system(built([(10, 9, 9, 0)] * 3, preemption=NON_PREEMPTIVE))
    assert found["T0"].reason == "the jobs of its tasks need up to 135.0 % of its 2 cores"


def test_who_is_never_preempted_has_no_bound_if_its_activations_are_not_known_but_for_a_jitter():
    model = built([(10, 1, 1, 0)] * 3, preemption=NON_PREEMPTIVE)
    first, *rest = model.stimuli.stimuli
    spaced = replace(first, jitter=Boundaries(lower=0, upper=10 * US), min_distance=5 * US)
    found = analyze_system(replace(model, stimuli=Stimuli(stimuli=(spaced, *rest))))
    assert any("'T0' is not preempted, and when it is activated is unknown" in each.message for each in found.findings)


def play(rows, cores, until, rng, preemption=Preemption.PREEMPTIVE):
    """Longest response times, unit of time by unit of time; execution times are drawn."""
    pending, longest, running = {}, [0] * len(rows), []
    for now in range(until):
        for number, (period, least, worst, offset) in enumerate(rows):
            if now >= offset and (now - offset) % period == 0:
                pending.setdefault(number, []).append([now, rng.choice((least, worst, worst))])
        kept = running if preemption is NON_PREEMPTIVE else []
        ready = sorted(number for number, jobs in pending.items() if jobs and number not in kept)
        running = [*kept, *ready][:cores]
        for number in list(running):
            job = pending[number][0]
            job[1] -= 1
            if not job[1]:
                longest[number] = max(longest[number], now + 1 - job[0])
                pending[number].pop(0)
                running.remove(number)
    return longest


ROWS = st.integers(4, 12).flatmap(
    lambda period: st.tuples(
        st.just(period), st.integers(1, 2), st.integers(2, max(2, period * 2 // 3)), st.integers(0, period - 1)
    )
)


#: Periods of which the least common multiple is small, so that all schedules are explored.
HARMONIC_ROWS = st.sampled_from([6, 8, 12, 24]).flatmap(
    lambda period: st.tuples(
        st.just(period), st.integers(1, 2), st.integers(2, max(2, period // 3)), st.integers(0, period - 1)
    )
)


@given(st.lists(HARMONIC_ROWS, min_size=3, max_size=6), st.integers(2, 3), st.integers(0, 99))
@examples(20)
def test_no_job_that_is_never_preempted_is_later_than_its_bound(rows, cores, seed):
    model = built(rows, cores, NON_PREEMPTIVE)
    analysis, options = analyze_system(model), Options(duration=Duration(200 * US), seed=seed)
    assert list(contradictions(analysis, simulate_system(model, options))) == []
    run = play(rows, cores, 200, Random(seed), NON_PREEMPTIVE)
    assert all(bound is None or time <= bound for time, bound in zip(run, bounds(analysis), strict=True))


@given(st.lists(ROWS, min_size=3, max_size=6), st.integers(2, 4), st.integers(0, 99))
@examples(60)
def test_no_job_is_later_than_its_bound(rows, cores, seed):
    model = built(rows, cores)
    analysis = analyze_system(model)
    found = bounds(analysis)
    runs = [play(rows, cores, 400, Random(seed))]
    for shift in product((0, 1), repeat=2):
        moved = [(*row[:3], (row[3] + shift[number % 2] * number) % row[0]) for number, row in enumerate(rows)]
        runs.append(play(moved, cores, 400, Random(seed)))
    options = Options(duration=Duration(300 * US), seed=seed)
    recording = record(model, options)
    assert list(contradictions(analysis, simulate_system(model, options))) == []
    simulated = [[end - begin for begin, _, end in recording.jobs_of(f"T{number}")] for number in range(len(rows))]
    runs.append([max(times, default=0) / US for times in simulated])
    for run in runs:
        assert all(bound is None or time <= bound for time, bound in zip(run, found, strict=True)), (run, found)
