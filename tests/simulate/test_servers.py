"""Servers in simulations: no process gets more than the budget in a period, and nothing is later than the analysis claims."""

from collections import Counter

import pytest
from by_hand import built
from effort import examples
from hand_made_systems import Proc, ticks
from hypothesis import given
from hypothesis import strategies as st
from opponent.simulation import record

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.os import Duration, Parameter, Parent, Policy, Scheduler
from amalthea_uros.perf.stimuli import RelativePeriodic
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.trace.table import EventKind
from amalthea_uros.units import MICROSECOND as US

FIXED = [Policy.DEFERRABLE_SERVER, Policy.POLLING_SERVER, Policy.SPORADIC_SERVER]


def system(policy, capacity, period, tasks, root=Policy.OSEK):
    """Tasks of (name, minimum distance, time, scheduler, priority or deadline) under a server of priority 5, and beside it."""
    budget = tuple(Parameter(key, (Duration(time * US),)) for key, time in (("capacity", capacity), ("period", period)))
    is_edf = root is Policy.EARLIEST_DEADLINE_FIRST
    priority = None if is_edf else 5
    schedulers = (
        Scheduler(name="root", policy=root, cores=("c0",)),
        Scheduler(name="server", policy=policy, parent=Parent(scheduler="root", priority=priority), parameters=budget),
    )
    stimuli = (
        RelativePeriodic(name=name, distance=Boundaries(lower=distance * US, upper=2 * distance * US))
        for name, distance, *_ in tasks
    )
    processes = []
    for name, _, time, scheduler, rank in tasks:
        urgency = {"deadline" if is_edf and scheduler == "root" else "priority": rank}
        limit = {"activation_limit": 99}
        processes.append(Proc(name, (ticks(time),), stimuli=(name,), scheduler=scheduler, task=limit, **urgency))
    return built(*processes, schedulers=schedulers, stimuli=stimuli)


def used_by_period(run, names, period):
    """How long some processes execute in each period."""
    begun, used = {}, Counter()
    for time, kind, _, _, target, _, _ in run.events:
        if run.program.entities[target].name not in names:
            continue
        if kind in (EventKind.START, EventKind.RESUME):
            begun[target] = time
        elif kind in (EventKind.PREEMPT, EventKind.TERMINATE):
            begin = begun.pop(target)
            while begin < time:
                end = min(time, (begin // period + 1) * period)
                used[begin // period] += end - begin
                begin = end
    return used


tasks_inside = st.lists(st.tuples(st.integers(20, 60), st.integers(1, 8)), min_size=1, max_size=2)
tasks_beside = st.lists(st.tuples(st.integers(20, 60), st.integers(1, 5), st.sampled_from([1, 2, 8, 9])), max_size=2)


def drawn(inside, beside):
    return [
        *((f"in{number}", distance, time, "server", number) for number, (distance, time) in enumerate(inside)),
        *((f"out{number}", distance, time, "root", rank) for number, (distance, time, rank) in enumerate(beside)),
    ]


@examples(36)
@given(st.sampled_from(FIXED), st.integers(1, 5), st.integers(6, 15), tasks_inside, tasks_beside, st.integers(0, 99))
def test_budgets_are_kept_and_claims_hold(policy, capacity, period, inside, beside, seed):
    model, duration = system(policy, capacity, period, drawn(inside, beside)), 2000 * US
    options = (
        Options(duration=Duration(duration), mode=mode, seed=seed, traced=(0, Duration(duration)))
        for mode in (Mode.SAMPLED, Mode.WORST)
    )
    runs = [record(model, each) for each in options]
    assert not any(run.program.left_out for run in runs)
    for process in analyze_system(model).processes:
        # In an overloaded server, perhaps no job of the last one ends.
        responses = [end - activation for run in runs for activation, _, end in run.jobs_of(process.name)]
        assert process.wcrt is None or max(responses, default=0) <= process.wcrt
        assert process.response is None or min(responses, default=process.response.best) >= process.response.best
    if policy is not Policy.SPORADIC_SERVER:
        names, units = {f"in{number}" for number in range(len(inside))}, runs[0].program.units
        for run in runs:
            assert max(used_by_period(run, names, period * US * units).values(), default=0) <= capacity * US * units


@examples(18)
@given(st.integers(1, 5), st.integers(10, 15), tasks_inside, st.integers(0, 99))
def test_a_bandwidth_server_disturbs_others_no_more_than_its_bandwidth(capacity, period, inside, seed):
    # Abeni and Buttazzo 1998, theorem 1: beside a server of bandwidth U, deadlines are met if the load of the others is at most 1 - U.
    beside = ("out", 20, 10, "root", 20)
    model = system(
        Policy.CONSTANT_BANDWIDTH_SERVER, capacity, period, [*drawn(inside, []), beside], Policy.EARLIEST_DEADLINE_FIRST
    )
    run = record(model, Options(duration=Duration(2000 * US), seed=seed))
    assert not run.program.left_out
    jobs = run.jobs_of("out")
    assert max(end - activation for activation, _, end in jobs) <= 20 * US


@pytest.mark.parametrize(
    ("policy", "ends"),
    [
        # A budget of 2 in 10 for 3 units: 2 at once and the last one with the next budget, at 10, or one period after 0.
        (Policy.DEFERRABLE_SERVER, 11),
        (Policy.SPORADIC_SERVER, 11),
    ],
)
def test_a_job_that_needs_two_budgets(policy, ends):
    run = record(system(policy, 2, 10, [("T", 100, 3, "server", 1)]), Options(duration=Duration(90 * US)))
    assert run.jobs_of("T")[0] == (0, 0, ends * US)


def test_what_a_sporadic_server_uses_comes_back_a_period_after_it_had_a_budget_again():
    # 0..2 and 10..11 of the first job; what is used from 10 on comes back at 20, not a period after the budget was used up at 2.
    tasks = [("first", 100, 3, "server", 2), ("then", 100, 3, "server", 1)]
    run = record(system(Policy.SPORADIC_SERVER, 2, 10, tasks), Options(duration=Duration(90 * US)))
    assert run.jobs_of("first")[0] == (0, 0, 11 * US)
    assert run.jobs_of("then")[0] == (0, 11 * US, 22 * US)
