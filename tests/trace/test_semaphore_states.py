"""The states of semaphores that follow from what processes do with them (BTF 2.3.0, sections 2.3.7 and 2.3.8)."""

from collections import deque

from hypothesis import given
from hypothesis import strategies as st
from traces import chunks, said, table

from amalthea_uros.trace.semaphore_states import SemaphoreStates
from amalthea_uros.trace.state_charts import StateCharts
from amalthea_uros.trace.table import Entity, EntityKind, EventKind

K = EventKind
TASKS = (0, 1, 2, 3)
SEMAPHORE = 4
ENTITIES = [*(Entity(EntityKind.TASK, f"Task_{number}") for number in TASKS), Entity(EntityKind.SEMAPHORE, "Semaphore")]


def complete(events, users, size=10**6):
    """The events of the semaphore in full: kind, and the task if it is one that causes it."""
    rows = [(time, kind, source, 0, SEMAPHORE, 0) for time, (kind, source) in enumerate(events)]
    return [
        (EventKind(row[1]), ENTITIES.index(row[2]))
        for row in said(map(SemaphoreStates({SEMAPHORE: users}).insert, chunks(table(ENTITIES, rows), size)))
    ]


def test_a_mutex_that_two_tasks_want():
    recorded = [
        (K.REQUEST_SEMAPHORE, 0),
        (K.LOCK, SEMAPHORE),
        (K.ASSIGNED, 0),
        (K.REQUEST_SEMAPHORE, 1),
        (K.WAITING, 1),
        (K.RELEASED, 0),
        (K.ASSIGNED, 1),
        (K.RELEASED, 1),
        (K.UNLOCK, SEMAPHORE),
    ]
    assert complete(recorded, users=1) == [
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


def test_a_semaphore_for_three_users():
    recorded = [(kind, task) for task in (0, 1, 2) for kind in (K.REQUEST_SEMAPHORE, K.ASSIGNED)]
    recorded += [(K.RELEASED, task) for task in (0, 1, 2)]
    states = [kind for kind, source in complete(recorded, users=3) if source == SEMAPHORE]
    assert states == [K.USED, K.USED, K.LOCK_USED, K.UNLOCK_FULL, K.USED, K.FREE]


def test_of_a_spinlock_nobody_is_said_to_be_waiting():
    rows = [(0, kind, 0, 0, SEMAPHORE, 0) for kind in (K.REQUEST_SEMAPHORE, K.WAITING, K.LOCK, K.ASSIGNED)]
    result = SemaphoreStates({}, [SEMAPHORE]).insert(table(ENTITIES, rows))
    assert result.kind.tolist() == [K.REQUEST_SEMAPHORE, K.LOCK, K.ASSIGNED]


@given(st.lists(st.sampled_from(TASKS), max_size=60), st.integers(1, 4), st.integers(1, 20))
def test_what_tasks_do_in_turn_obeys_the_chart(turns, users, size):
    holders, queue, recorded = set(), deque(), []
    for task in turns:  # each requests the semaphore, and releases it at its next turn
        if task in holders:
            holders.remove(task)
            recorded.append((K.RELEASED, task))
            if queue:
                holders.add(queue[0])
                recorded.append((K.ASSIGNED, queue.popleft()))
        elif task not in queue:
            is_free = len(holders) < users
            (holders.add if is_free else queue.append)(task)
            recorded += [(K.REQUEST_SEMAPHORE, task), (K.ASSIGNED if is_free else K.WAITING, task)]
    found = complete(recorded, users, size)
    charts = StateCharts()
    charts.check(table(ENTITIES, [(time, kind, source, 0, SEMAPHORE, 0) for time, (kind, source) in enumerate(found)]))
    assert charts.findings == ()
    assert [event for event in found if event[1] != SEMAPHORE and event[0] is not K.QUEUED] == recorded
