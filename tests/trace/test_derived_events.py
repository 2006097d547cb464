"""Events that follow from others: states of semaphores, and runnables that pause with their process (BTF 2.3.0, section 2.3)."""

from collections import deque
from itertools import pairwise

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from state_charts import StateCharts
from traces import chunks, random_trace, said, table

from amalthea_uros.trace.derived_events import CHANGE, RunnableSuspensions, SemaphoreStates
from amalthea_uros.trace.table import Entity, EntityKind, EventKind

K = EventKind
TASKS = (0, 1, 2, 3)
SEMAPHORE = 4
ENTITIES = [*(Entity(EntityKind.TASK, f"Task_{number}") for number in TASKS), Entity(EntityKind.SEMAPHORE, "Semaphore")]


def change(before, after, *, was_wanted=False, is_wanted=False):
    """A recorded change of how much of the semaphore is in use."""
    return CHANGE, SEMAPHORE, before, SEMAPHORE, after, 2 * was_wanted + is_wanted


def does(kind, task):
    return kind, task, 0, SEMAPHORE, 0


def complete(events, users, size=10**6, spinlocks=()):
    """The events of the semaphore in full: kind, and the task if it is one that causes it."""
    rows = [(time, *event) for time, event in enumerate(events)]
    states = SemaphoreStates({SEMAPHORE: users}, spinlocks)
    return [
        (EventKind(row[1]), ENTITIES.index(row[2])) for row in said(map(states.complete, chunks(table(ENTITIES, rows), size)))
    ]


MUTEX = [
    does(K.REQUEST_SEMAPHORE, 0),
    change(0, 1),
    does(K.ASSIGNED, 0),
    does(K.REQUEST_SEMAPHORE, 1),
    change(1, 1, is_wanted=True),
    does(K.WAITING, 1),
    does(K.RELEASED, 0),
    change(1, 1, was_wanted=True),
    does(K.ASSIGNED, 1),
    does(K.RELEASED, 1),
    change(1, 0),
]


def test_a_mutex_that_two_tasks_want():
    assert complete(MUTEX, users=1) == [
        (K.REQUEST_SEMAPHORE, 0),
        (K.QUEUED, 0),
        (K.LOCK, SEMAPHORE),
        (K.ASSIGNED, 0),
        (K.REQUEST_SEMAPHORE, 1),
        (K.QUEUED, 1),
        (K.OVERFULL, SEMAPHORE),
        (K.WAITING, 1),
        (K.RELEASED, 0),
        (K.FULL, SEMAPHORE),
        (K.ASSIGNED, 1),
        (K.RELEASED, 1),
        (K.UNLOCK, SEMAPHORE),
    ]


def test_of_a_spinlock_nobody_is_said_to_be_queued_or_waiting():
    assert complete(MUTEX, users=1, spinlocks=[SEMAPHORE]) == [
        (K.REQUEST_SEMAPHORE, 0),
        (K.LOCK, SEMAPHORE),
        (K.ASSIGNED, 0),
        (K.REQUEST_SEMAPHORE, 1),
        (K.RELEASED, 0),
        (K.UNLOCK, SEMAPHORE),
        (K.LOCK, SEMAPHORE),
        (K.ASSIGNED, 1),
        (K.RELEASED, 1),
        (K.UNLOCK, SEMAPHORE),
    ]


def states_of(events, users):
    return [kind for kind, source in complete(events, users) if source == SEMAPHORE]


def test_a_semaphore_for_three_users():
    changes = [change(before, after) for before, after in pairwise([0, 1, 2, 3, 2, 1, 0])]
    assert states_of(changes, users=3) == [K.USED, K.USED, K.LOCK_USED, K.UNLOCK_FULL, K.USED, K.FREE]


def test_a_writer_waits_for_one_of_two_readers():
    # BTF has no state for a semaphore that is wanted but not full: then nobody is said to be waiting for it.
    changes = [change(2, 2, is_wanted=True), change(2, 1, was_wanted=True, is_wanted=True), change(1, 2, was_wanted=True)]
    assert states_of(changes, users=2) == [K.OVERFULL, K.FULL, K.UNLOCK_FULL, K.LOCK_USED]


@given(st.lists(st.tuples(st.sampled_from(TASKS), st.booleans()), max_size=60), st.integers(1, 4), st.integers(1, 20))
def test_what_tasks_do_in_turn_obeys_the_chart(turns, users, size):
    held, queue, recorded, used = {}, deque(), [], 0
    for task, is_exclusive in turns:  # each requests the semaphore, and releases it at its next turn
        before, was_wanted, granted = used, bool(queue), []
        if task in held:
            used -= held.pop(task)
            while queue and used + queue[0][1] <= users:
                granted.append(queue[0][0])
                used += queue[0][1]
                held.update([queue.popleft()])
            changed = change(before, used, was_wanted=was_wanted, is_wanted=bool(queue))
            recorded += [does(K.RELEASED, task), changed, *(does(K.ASSIGNED, other) for other in granted)]
        elif task not in dict(queue):
            amount = users if is_exclusive else 1
            recorded.append(does(K.REQUEST_SEMAPHORE, task))
            if used + amount <= users:
                used += amount
                held[task] = amount
                recorded += [change(before, used, was_wanted=was_wanted, is_wanted=was_wanted), does(K.ASSIGNED, task)]
            else:
                queue.append((task, amount))
                if used == users:
                    recorded.append(change(used, used, was_wanted=was_wanted, is_wanted=True))
                recorded.append(does(K.WAITING, task))
    found = complete(recorded, users, size)
    charts = StateCharts()
    charts.check(table(ENTITIES, [(time, kind, source, 0, SEMAPHORE, 0) for time, (kind, source) in enumerate(found)]))
    assert charts.findings == ()
    kept = [event for event in found if event[1] != SEMAPHORE and event[0] is not K.QUEUED]
    assert kept == [(kind, task) for kind, task, *_ in recorded if kind != CHANGE]


CORE, TASK, OUTER, INNER = range(4)
RUNNABLES = [
    Entity(EntityKind.CORE, "C"),
    Entity(EntityKind.TASK, "T"),
    Entity(EntityKind.RUNNABLE, "R"),
    Entity(EntityKind.RUNNABLE, "Q"),
]


def test_the_inner_runnable_is_suspended_first_and_resumed_last():
    recorded = table(
        RUNNABLES,
        [
            (10, K.START, CORE, 0, TASK, 4),
            (10, K.RUNNABLE_START, TASK, 4, OUTER, 7),
            (12, K.RUNNABLE_START, TASK, 4, INNER, 9),
            (20, K.PREEMPT, CORE, 0, TASK, 4),
            (30, K.RESUME, CORE, 0, TASK, 4),
            (40, K.RUNNABLE_TERMINATE, TASK, 4, INNER, 9),
            (50, K.WAIT, CORE, 0, TASK, 4),
        ],
    )
    complete = RunnableSuspensions().insert(recorded)
    assert said(complete)[3:9] == said(
        table(
            RUNNABLES,
            [
                (20, K.RUNNABLE_SUSPEND, TASK, 4, INNER, 9),
                (20, K.RUNNABLE_SUSPEND, TASK, 4, OUTER, 7),
                (20, K.PREEMPT, CORE, 0, TASK, 4),
                (30, K.RESUME, CORE, 0, TASK, 4),
                (30, K.RUNNABLE_RESUME, TASK, 4, OUTER, 7),
                (30, K.RUNNABLE_RESUME, TASK, 4, INNER, 9),
            ],
        )
    )
    assert complete.kind.tolist()[9:] == [K.RUNNABLE_TERMINATE, K.RUNNABLE_SUSPEND, K.WAIT]


@given(st.randoms(use_true_random=False), st.integers(1, 20))
def test_of_a_legal_trace_they_are_what_was_taken_away(random, size):
    legal = random_trace(random, steps=150)
    paused = np.isin(legal.kind, [K.RUNNABLE_SUSPEND, K.RUNNABLE_RESUME])
    recorded = legal.where(~paused)
    assert said(map(RunnableSuspensions().insert, chunks(recorded, size))) == said(legal)
