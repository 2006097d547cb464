"""Who preempts whom, and which activations are lost: schedules derived by hand."""

import pytest
from by_hand import allocated, built, play
from hand_made_systems import Proc, ticks

from amalthea_uros.perf.activities import Call, Group, SchedulePoint, Terminate
from amalthea_uros.perf.os import Parameter, Policy, Scheduler
from amalthea_uros.perf.software import Preemption, Runnable
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.observed.job_times import JobColumn
from amalthea_uros.trace.table import EventKind

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
