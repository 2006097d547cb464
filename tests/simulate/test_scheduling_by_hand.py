"""Scheduling policies, preemption and lost activations: schedules derived by hand, and published ones."""

import json
from dataclasses import replace

import pytest
from by_hand import allocated, built, play
from hand_made_systems import CORES, Proc, locked, release, request, system, ticks
from support import SHARED

from amalthea_uros.perf.activities import Call, Group, SchedulePoint, Terminate, Waiting
from amalthea_uros.perf.os import Duration, Parameter, Parent, Policy, Scheduler, Semaphore, SemaphoreKind
from amalthea_uros.perf.software import Preemption, Runnable
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.observed.job_times import JobColumn
from amalthea_uros.trace.table import EventKind
from amalthea_uros.units import MICROSECOND as US


def on(policy, cores=("c0",), **more):
    return Scheduler(name="s0", policy=policy, cores=cores, **more)


def time(name, microseconds):
    return Parameter(name=name, values=(Duration(microseconds * US),))


def test_rate_monotonic_serves_the_shortest_period_first():
    slow, fast = Proc("slow", (ticks(4),), 20), Proc("fast", (ticks(2),), 5)
    found = play(built(slow, fast, schedulers=[on(Policy.RATE_MONOTONIC)]), 20)
    assert found["fast"] == [(0, 0, 2), (5, 5, 7), (10, 10, 12), (15, 15, 17)]
    # 2..5 and 7..8
    assert found["slow"] == [(0, 2, 8)]


def test_deadline_monotonic_serves_the_shortest_deadline_first():
    early, late = Proc("early", (ticks(2),), 20, 1, deadline=4), Proc("late", (ticks(3),), 10, deadline=9)
    found = play(built(late, early, schedulers=[on(Policy.DEADLINE_MONOTONIC)]), 20)
    assert found["early"] == [(1, 1, 3)]
    assert found["late"] == [(0, 0, 5), (10, 10, 13)]


def test_of_equal_deadlines_the_earlier_activation_goes_first():
    # `first` and `then` have the deadline 10; that of `last`, 12, is later. At 3 `then` does not preempt.
    first, then = Proc("first", (ticks(4),), 1000, deadline=10), Proc("then", (ticks(2),), 1000, 3, deadline=7)
    last = Proc("last", (ticks(1),), 1000, 1, deadline=11)
    found = play(built(last, then, first, schedulers=[on(Policy.EARLIEST_DEADLINE_FIRST)]), 100)
    assert (found["first"], found["then"], found["last"]) == ([(0, 0, 4)], [(3, 4, 6)], [(1, 6, 7)])


def test_time_slices_of_different_lengths():
    # a (3 at a time) and b (2 at a time): a 0..3, b 3..5, a 5..8, b 8..10, a 10..11, b 11..12.
    model = built(
        Proc("a", (ticks(7),), 1000, priority=1),
        Proc("b", (ticks(5),), 1000, priority=1),
        schedulers=[on(Policy.PRIORITY_BASED_ROUND_ROBIN)],
    )
    slices = {name: {"parameters": (time("timeSliceLength", length),)} for name, length in (("a", 3), ("b", 2))}
    found = play(allocated(model, **slices), 100)
    assert (found["a"], found["b"]) == ([(0, 0, 11)], [(0, 3, 12)])
    assert (found.column("a", JobColumn.PREEMPTIONS), found.column("b", JobColumn.PREEMPTIONS)) == ([2], [2])


def server(policy, capacity, period, priority=2):
    parameters = (time("capacity", capacity), time("period", period))
    return Scheduler(name="server", policy=policy, parent=Parent(scheduler="s0", priority=priority), parameters=parameters)


@pytest.mark.parametrize(
    ("policy", "end", "rest"),
    [
        # A budget of 3 in 10, a job of 5 at 4. Deferrable: 4..7, then with the budget of 10: 10..12. `rest` executes in between.
        (Policy.DEFERRABLE_SERVER, 12, [(0, 0, 14)]),
        # At 0 the polling server has nothing to serve and loses its budget: 10..13, 20..22.
        (Policy.POLLING_SERVER, 22, [(0, 0, 9)]),
        # 3 used from 4 on come back at 14: 4..7, 14..16.
        (Policy.SPORADIC_SERVER, 16, [(0, 0, 12)]),
    ],
)
def test_a_server_spends_its_budget_and_gets_it_back(policy, end, rest):
    job = Proc("job", (ticks(5),), 1000, 4, scheduler="server", priority=1)
    # Below the server; 9 ticks.
    low = Proc("low", (ticks(9),), 1000, priority=1)
    found = play(built(job, low, schedulers=[on(Policy.OSEK), server(policy, 3, 10)]), 100)
    assert found["job"][0][2] == end
    assert found["low"] == rest


def test_a_polling_server_loses_what_is_left_when_it_has_nothing_to_serve():
    # `a` is served 0..1 and leaves 2, which `b` at 3 does not get before 10.
    a, b = (Proc(name, (ticks(1),), 1000, at, scheduler="server", priority=1) for name, at in (("a", 0), ("b", 3)))
    found = play(built(a, b, schedulers=[on(Policy.OSEK), server(Policy.POLLING_SERVER, 3, 10)]), 100)
    assert (found["a"], found["b"]) == ([(0, 0, 1)], [(3, 10, 11)])


def test_a_bandwidth_server_goes_on_with_a_later_deadline():
    # Budget 2 in 8: the job of 5 at 0 has the deadlines 8, 16, 24. `rival` with deadline 12 (4 ticks) goes between the first two.
    parameters = (time("capacity", 2), time("period", 8))
    cbs = Scheduler(
        name="server", policy=Policy.CONSTANT_BANDWIDTH_SERVER, parent=Parent(scheduler="s0"), parameters=parameters
    )
    job = Proc("job", (ticks(5),), 1000, scheduler="server", priority=1)
    rival, last = Proc("rival", (ticks(4),), 1000, deadline=12), Proc("last", (ticks(1),), 1000, deadline=20)
    found = play(built(job, rival, last, schedulers=[on(Policy.EARLIEST_DEADLINE_FIRST), cbs]), 100)
    # job 0..2, rival 2..6, job 6..8, last 8..9, job 9..10.
    assert (found["job"], found["rival"], found["last"]) == ([(0, 0, 10)], [(0, 2, 6)], [(0, 8, 9)])


def test_fixed_priorities_of_a_parent_above_deadlines_of_a_child_with_a_server_beside():
    # s0: child `edf` at 2, `server` at 3 (1 in 4), task `low` at 1. In `edf`: x (deadline 9) before y (deadline 12).
    schedulers = [
        on(Policy.OSEK),
        Scheduler(name="edf", policy=Policy.EARLIEST_DEADLINE_FIRST, parent=Parent(scheduler="s0", priority=2)),
        server(Policy.DEFERRABLE_SERVER, 1, 4, priority=3),
    ]
    y = Proc("y", (ticks(3),), 1000, scheduler="edf", deadline=12)
    x = Proc("x", (ticks(2),), 1000, 2, scheduler="edf", deadline=9)
    served = Proc("served", (ticks(2),), 1000, 1, scheduler="server", priority=1)
    low = Proc("low", (ticks(1),), 1000, priority=1)
    found = play(built(y, x, served, low, schedulers=schedulers), 100)
    # y 0..1, served 1..2 (budget used up), x 2..4, served 4..5, y 5..7, low 7..8.
    assert (found["y"], found["x"]) == ([(0, 0, 7)], [(2, 2, 4)])
    assert (found["served"], found["low"]) == ([(1, 1, 5)], [(0, 7, 8)])


def test_children_of_a_parent_with_fixed_priorities_are_compared_by_their_own_priorities_first():
    # The task of priority 1 below the more urgent child precedes that of priority 9 below the other one.
    schedulers = [
        on(Policy.FIXED_PRIORITY_PREEMPTIVE),
        *(
            Scheduler(name=name, policy=Policy.FIXED_PRIORITY_PREEMPTIVE, parent=Parent(scheduler="s0", priority=priority))
            for name, priority in (("upper", 2), ("lower", 1))
        ),
    ]
    nine, one = (
        Proc("nine", (ticks(3),), 1000, scheduler="lower", priority=9),
        Proc("one", (ticks(2),), 1000, 1, scheduler="upper", priority=1),
    )
    found = play(built(nine, one, schedulers=schedulers), 100)
    assert (found["nine"], found["one"]) == ([(0, 0, 5)], [(1, 1, 3)])


def test_a_server_within_a_server_is_bound_by_both_budgets():
    # The outer one has 4 in 10, the inner one 3 in 5: 0..3 inner budget, 5..6 outer budget, then 10..13, 15..16.
    inner = replace(server(Policy.DEFERRABLE_SERVER, 3, 5), name="inner", parent=Parent(scheduler="server", priority=1))
    job = Proc("job", (ticks(8),), 1000, scheduler="inner", priority=1)
    found = play(built(job, schedulers=[on(Policy.OSEK), server(Policy.DEFERRABLE_SERVER, 4, 10), inner]), 100)
    assert found["job"] == [(0, 0, 16)]


GLOBAL = [on(Policy.FIXED_PRIORITY_PREEMPTIVE, CORES)]


def test_who_has_a_core_stays_there_if_somebody_else_has_to_give_way():
    # Two cores: `mid` on c0 and `low` on c1 when `high` comes at 2. `low` gives way, and `mid` is not disturbed.
    mid, low = Proc("mid", (ticks(6),), 1000, priority=2), Proc("low", (ticks(6),), 1000, priority=1)
    high = Proc("high", (ticks(3),), 1000, 2, priority=3)
    found = play(built(mid, low, high, schedulers=GLOBAL), 100, traced=True)
    assert (found["mid"], found["high"], found["low"]) == ([(0, 0, 6)], [(2, 2, 5)], [(0, 0, 9)])
    assert (found.column("mid", JobColumn.PREEMPTIONS), found.column("mid", JobColumn.MIGRATIONS)) == ([0], [0])
    assert found.events("high", EventKind.START) == [(2, EventKind.START, "c1", 0)]
    assert found.column("low", JobColumn.MIGRATIONS) == [0]


def test_a_job_resumes_on_another_core_and_that_is_counted():
    # `low` is preempted on c1 at 2; c0 is free at 4, so that it goes on there.
    mid, low = Proc("mid", (ticks(4),), 1000, priority=2), Proc("low", (ticks(6),), 1000, priority=1)
    high = Proc("high", (ticks(9),), 1000, 2, priority=3)
    found = play(built(mid, low, high, schedulers=GLOBAL), 100, traced=True)
    assert found["low"] == [(0, 0, 8)]
    assert found.column("low", JobColumn.MIGRATIONS) == [1]
    assert found.events("low", EventKind.RESUME) == [(4, EventKind.RESUME, "c0", 0)]


def test_a_task_with_an_affinity_does_not_migrate():
    # `low` may use c1 only: it waits there until 11, although c0 is idle from 4 on.
    mid, low = Proc("mid", (ticks(4),), 1000, priority=2), Proc("low", (ticks(6),), 1000, priority=1)
    high = Proc("high", (ticks(9),), 1000, 2, priority=3)
    only = {"cores": ("c1",)}
    found = play(allocated(built(mid, low, high, schedulers=GLOBAL), low=only, high=only), 100)
    assert (found["mid"], found["high"], found["low"]) == ([(0, 0, 4)], [(2, 2, 11)], [(0, 0, 15)])


COOPERATIVE = {"preemption": Preemption.COOPERATIVE}


def test_tasks_of_a_group_preempt_each_other_at_schedule_points_only():
    # OSEK OS 2.2.3, 4.6.3: `low` runs at the priority of `mid`, its group. `high` at 2 preempts it; `mid` waits for the point at 4.
    low = Proc("low", (ticks(3), SchedulePoint(), ticks(3)), 1000, priority=1)
    mid = Proc("mid", (ticks(2),), 1000, 1, priority=2)
    high = Proc("high", (ticks(1),), 1000, 2, priority=3)
    group = {"parameters": (Parameter(name="taskGroup", values=(1,)),)}
    found = play(allocated(built(low, mid, high), low=group, mid=group), 100)
    assert (found["low"], found["mid"], found["high"]) == ([(0, 0, 9)], [(1, 4, 6)], [(2, 2, 3)])


def test_cooperative_tasks_preempt_each_other_at_schedule_points_and_after_runnables():
    # `mid` comes at 1 and waits until 2; `again` comes at 6 and waits for the end of the call at 8; `high` preempts at once.
    low = Proc("low", (ticks(2), SchedulePoint(), Call(runnable="r"), ticks(1)), 1000, priority=1, task=COOPERATIVE)
    mid = Proc("mid", (ticks(2),), 1000, 1, priority=2, task=COOPERATIVE)
    again = Proc("again", (ticks(1),), 1000, 6, priority=3, task=COOPERATIVE)
    high = Proc("high", (ticks(1),), 1000, 3, priority=4)
    found = play(built(low, mid, again, high, runnables=(Runnable(name="r", activities=(ticks(3),)),)), 100)
    # low 0..2, mid 2..3, high 3..4, mid 4..5, low 5..8, again 8..9, low 9..10.
    assert (found["low"], found["mid"]) == ([(0, 0, 10)], [(1, 2, 5)])
    assert (found["again"], found["high"]) == ([(6, 8, 9)], [(3, 3, 4)])


def test_a_job_that_terminates_within_a_non_interruptible_group_lets_others_in():
    # Every second job terminates after 2 ticks; the others execute the group of 5 ticks, 0..5, and one tick more after `high`.
    stop = Terminate(counter=Counter(prescaler=2, offset=2))
    group = Group(activities=(ticks(2), stop, ticks(3)), interruptible=False)
    low, high = Proc("low", (group, ticks(1)), 10, priority=1), Proc("high", (ticks(1),), 10, 1, priority=2)
    found = play(built(low, high), 30)
    assert found["low"] == [(0, 0, 7), (10, 10, 12), (20, 20, 27)]
    assert found["high"] == [(1, 5, 6), (11, 12, 13), (21, 25, 26)]


@pytest.mark.parametrize(
    ("limit", "jobs", "numbers", "lost"),
    [
        # A job takes 12, activations come every 5. One at a time: of 0, 5, 10, ..., each third one.
        (1, [(0, 0, 12), (15, 15, 27)], [0, 3], [(5, 1), (10, 2), (20, 4), (25, 5)]),
        # Two at a time: 5 waits until 12, 15 until 24.
        (2, [(0, 0, 12), (5, 12, 24)], [0, 1], [(10, 2), (20, 4)]),
    ],
)
def test_activations_beyond_the_limit_are_lost_and_keep_their_numbers(limit, jobs, numbers, lost):
    model = built(Proc("T", (ticks(12),), 5, priority=1, task={"activation_limit": limit}))
    found = play(model, 28, traced=True)
    assert found["T"] == jobs
    assert found.column("T", JobColumn.INSTANCE) == numbers
    assert [(time, number) for time, _, _, number in found.events("T", EventKind.ACTIVATION_LOST)] == lost


def test_interrupts_are_nested_by_priority_and_interrupt_non_preemptive_tasks():
    # task 0..1, lower 1..2, higher 2..3, lower 3..6, equal 6..7, task 7..9; `urgent` waits for the end of the task.
    task = Proc("task", (ticks(3),), 1000, priority=1, task={"preemption": Preemption.NON_PREEMPTIVE})
    urgent = Proc("urgent", (ticks(1),), 1000, 1, priority=9)
    lower = Proc("lower", (ticks(4),), 1000, 1, priority=1, is_isr=True)
    higher = Proc("higher", (ticks(1),), 1000, 2, priority=2, is_isr=True)
    # It does not preempt `lower`.
    equal = Proc("equal", (ticks(1),), 1000, 4, priority=1, is_isr=True)
    found = play(built(task, urgent, lower, higher, equal), 100)
    assert (found["lower"], found["higher"], found["equal"]) == ([(1, 1, 6)], [(2, 2, 3)], [(4, 6, 7)])
    assert (found["task"], found["urgent"]) == ([(0, 0, 9)], [(1, 9, 10)])


def test_decisions_of_a_scheduler_take_time_at_activations_and_at_ends():
    # decision 0..1, low 1..3, decision 3..4, high 4..6 with a decision 6..7 at its end, low 7..10 with a decision 10..11.
    high, low = Proc("high", (ticks(2),), 1000, 3, priority=2), Proc("low", (ticks(5),), 1000, priority=1)
    scheduler = Scheduler(name="s0", policy=Policy.OSEK, cores=("c0",), overhead=(ticks(1),))
    found = play(built(high, low, schedulers=[scheduler]), 100)
    assert (found["high"], found["low"]) == ([(3, 4, 7)], [(0, 1, 11)])


# Who goes first where several things happen at one instant, or somebody comes back from waiting.


def masked(*body):
    return Group(activities=body, interruptible=False)


def test_equals_go_in_the_order_of_their_activations():
    # The second job of `twice` is activated at 5, before `once` at 7, although it cannot begin before the first one has ended.
    high = Proc("high", (ticks(4),), 100, priority=2)
    twice = Proc("twice", (ticks(6),), 5, priority=1, task={"activation_limit": 99})
    once = Proc("once", (ticks(1),), 100, 7, priority=1)
    found = play(built(high, twice, once), 18)
    assert found["twice"][:2] == [(0, 4, 10), (5, 10, 16)]
    assert found["once"] == [(7, 16, 17)]


def test_a_job_ends_with_its_last_group_although_somebody_has_waited_for_the_group_to_end():
    low, high = Proc("low", (masked(ticks(4)),), 100, priority=1), Proc("high", (ticks(2),), 100, 1, priority=2)
    found = play(built(low, high), 20)
    assert (found["low"], found["high"]) == ([(0, 0, 4)], [(1, 4, 6)])


def test_a_group_does_not_keep_off_who_arrives_at_the_instant_at_which_it_would_begin():
    low = Proc("low", (ticks(1), masked(ticks(4))), 100, priority=1)
    found = play(built(low, Proc("high", (ticks(2),), 100, 1, priority=2)), 20)
    assert (found["low"], found["high"]) == ([(0, 0, 7)], [(1, 1, 3)])


def test_a_ceiling_is_a_deadline_where_deadlines_decide():
    # The holder gets the deadline of the other user at most: who has an earlier one, and does not use it, goes first.
    holder, user = Proc("holder", locked("s", 5), 100, deadline=90), Proc("user", locked("s", 1), 100, 60, deadline=50)
    other = Proc("other", (ticks(1),), 100, 2, deadline=10)
    semaphores = (Semaphore(name="s", kind=SemaphoreKind.RESOURCE, ceiling=True),)
    found = play(built(holder, user, other, schedulers=[on(Policy.EARLIEST_DEADLINE_FIRST)], semaphores=semaphores), 59)
    assert (found["holder"], found["user"], found["other"]) == ([(0, 0, 6)], [], [(2, 2, 3)])


MUTEX = (Semaphore(name="s", kind=SemaphoreKind.MUTEX),)


def test_who_comes_back_from_waiting_keeps_nobody_off_before_it_has_its_core():
    # While `first` waits, `last` goes on from its schedule point; its release makes `first` ready, which it does not keep off.
    passive = request("s", Waiting.PASSIVE)
    body = (passive, ticks(2), SchedulePoint(), ticks(1), release("s"), ticks(1))
    last = Proc("last", body, 100, priority=1, task=COOPERATIVE)
    first = Proc("first", locked("s", 1, Waiting.PASSIVE), 100, 1, priority=2, task=COOPERATIVE)
    found = play(built(last, first, semaphores=MUTEX), 50)
    assert (found["last"], found["first"]) == ([(0, 0, 4)], [(1, 2, 5)])


def test_a_job_ends_with_its_last_release_although_somebody_more_urgent_has_waited_for_it():
    low = Proc("low", locked("s", 3, Waiting.PASSIVE), 100, priority=1)
    high = Proc("high", locked("s", 2, Waiting.PASSIVE), 100, 1, priority=2)
    found = play(built(low, high, semaphores=MUTEX), 20)
    assert (found["low"], found["high"]) == ([(0, 0, 3)], [(1, 1, 5)])


def test_only_a_call_that_takes_place_lets_others_go_first():
    # The first occurrence of the call is skipped.
    call = Call(runnable="r", counter=Counter(prescaler=2, offset=0))
    low = Proc("low", (ticks(2), call, ticks(2)), 20, priority=1, task=COOPERATIVE)
    high = Proc("high", (ticks(1),), 100, 1, priority=2, task=COOPERATIVE)
    found = play(built(low, high, runnables=(Runnable(name="r", activities=(ticks(1),)),)), 20)
    assert found["high"] == [(1, 4, 5)]


def test_who_has_used_up_its_slice_ends_if_nothing_is_left():
    a, b = (Proc(name, (ticks(2),), 100, priority=1) for name in "ab")
    slices = {name: {"parameters": (time("timeSliceLength", 2),)} for name in "ab"}
    found = play(allocated(built(a, b, schedulers=[on(Policy.PRIORITY_BASED_ROUND_ROBIN)]), **slices), 20)
    assert (found["a"], found["b"]) == ([(0, 0, 2)], [(0, 2, 4)])


# Published schedules are simulated job by job; other people's simulations found them.


SCHEDULES = SHARED / "vectors" / "schedules.json"
CASES = json.loads(SCHEDULES.read_text())["cases"] if SCHEDULES.exists() else []


@pytest.mark.skipif(not CASES, reason="the vectors are not at hand")
@pytest.mark.parametrize("case", CASES, ids=lambda case: case["id"])
def test_every_job_starts_and_ends_as_published(case):
    """A unit of time of a vector is a microsecond here; 0 is its highest priority."""
    limit, until = {"activation_limit": 99}, case["simulated_until"]
    processes = [
        Proc(t["name"], (ticks(t["wcet"]),), t["period"], t["offset"], priority=1000 - t["priority"], task=limit)
        for t in case["tasks"]
    ]
    # The last jobs of a vector end after the time up to which jobs are released.
    last = max(end for jobs in case["jobs"].values() for _, _, end in jobs)
    found = play(system(*processes), max(until, last) + 1)
    for name, jobs in case["jobs"].items():
        assert [job for job in found[name] if job[0] < until] == [tuple(job) for job in jobs]
