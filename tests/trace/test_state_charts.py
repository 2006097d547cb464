"""The state charts and the order rules of BTF 2.3.0: each legal step is accepted, each other one is found."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st
from state_charts import StateCharts, check_trace
from test_btf_writer import ENTITIES, LINES, PREEMPTION, in_nanoseconds
from traces import chunks, random_trace, table

from amalthea_uros.trace.table import Entity, EntityKind, EventKind

K = EventKind
ENTITIES = [
    *ENTITIES,
    Entity(EntityKind.SEMAPHORE, "Sem"),
    Entity(EntityKind.CORE, "Core_2"),
    Entity(EntityKind.RUNNABLE, "Run_2"),
]
STI_A, STI_B, CORE, TASK_A, TASK_B, RUN, LABEL, SEM, CORE_2, RUN_2 = range(10)

#: The figure of the standard: event, state before, state after.
PROCESS = {
    K.ACTIVATE: ("terminated", "active"),
    K.START: ("active", "running"),
    K.PREEMPT: ("running", "ready"),
    K.RESUME: ("ready", "running"),
    K.TERMINATE: ("running", "terminated"),
    K.POLL: ("running", "polling"),
    K.RUN: ("polling", "running"),
    K.PARK: ("polling", "parking"),
    K.POLL_PARKING: ("parking", "polling"),
    K.RELEASE_PARKING: ("parking", "ready"),
    K.WAIT: ("running", "waiting"),
    K.RELEASE: ("waiting", "ready"),
}
#: A shortest way into each state.
WAYS = {
    "active": [K.ACTIVATE],
    "running": [K.ACTIVATE, K.START],
    "ready": [K.ACTIVATE, K.START, K.PREEMPT],
    "polling": [K.ACTIVATE, K.START, K.POLL],
    "parking": [K.ACTIVATE, K.START, K.POLL, K.PARK],
    "waiting": [K.ACTIVATE, K.START, K.WAIT],
    "terminated": [K.ACTIVATE, K.START, K.TERMINATE],
}


def rules(rows):
    charts = StateCharts()
    charts.check(table(ENTITIES, rows))
    return [finding.rule for finding in charts.findings]


def process_rows(kinds):
    stimulus = [(0, K.TRIGGER, STI_A, 0, STI_A, 0)]
    return stimulus + [(0, kind, STI_A if kind is K.ACTIVATE else CORE, 0, TASK_A, 0) for kind in kinds]


@pytest.mark.parametrize(("state", "kind"), list(product(WAYS, PROCESS)))
def test_a_process_does_only_what_the_figure_shows(state, kind):
    found = rules(process_rows([*WAYS[state], kind]))
    is_second_activation = kind is K.ACTIVATE  # with the same instance number
    assert "process state" not in found if PROCESS[kind][0] == state else "process state" in found
    assert ("instance number" in found) == is_second_activation


@pytest.mark.parametrize("kind", [kind for kind in PROCESS if kind is not K.ACTIVATE])
def test_at_the_begin_of_a_trace_a_process_may_be_in_any_state(kind):
    assert rules([(0, kind, CORE, 0, TASK_A, 0)]) == []


def test_a_job_after_one_that_was_activated_in_the_trace_needs_an_activation():
    assert rules([*process_rows(WAYS["terminated"]), (1, K.START, CORE, 0, TASK_A, 1)]) == ["process state"]


def test_a_lost_activation_takes_a_number():
    rows = process_rows(WAYS["running"])
    rows += [(1, K.TRIGGER, STI_A, 1, STI_A, 1), (1, K.ACTIVATION_LOST, STI_A, 1, TASK_A, 1)]
    rows += [(2, K.TRIGGER, STI_A, 2, STI_A, 2), (2, K.ACTIVATE, STI_A, 2, TASK_A, 2)]
    assert rules(rows) == []
    assert rules([row for row in rows if row[1] is not K.ACTIVATION_LOST]) == ["instance number"]


def test_a_preemption_is_legal():
    assert rules(in_nanoseconds(PREEMPTION)) == []


@given(st.randoms(use_true_random=False), st.integers(0, 200), st.integers(1, 50))
def test_a_walk_through_the_charts_is_legal_from_any_event_on(random, first, size):
    trace = random_trace(random, steps=150)
    charts = StateCharts()
    # The trigger belongs to the event after it; a trace may begin anywhere else.
    while 0 < first < len(trace) and trace.kind[first - 1] == K.TRIGGER:
        first += 1
    for part in chunks(trace.rows(first, len(trace)), size):
        charts.check(part)
    assert charts.findings == ()


@given(st.randoms(use_true_random=False), st.data())
def test_a_lost_transition_is_found(random, data):
    trace = random_trace(random, steps=100)
    events = list(zip(trace.kind.tolist(), trace.target.tolist(), trace.target_instance.tolist(), strict=True))
    # The activation of the first job may be before the begin of a trace, and the last transition of a job after its end.
    later, followed = set(), []
    for row, (kind, *job) in reversed(list(enumerate(events))):
        if kind in PROCESS:
            followed += [row] if tuple(job) in later and kind != K.ACTIVATE else []
            later.add(tuple(job))
    if followed:
        lost = data.draw(st.sampled_from(followed))
        charts = StateCharts()
        charts.check(trace.rows(0, lost))
        charts.check(trace.rows(lost + 1, len(trace)))
        assert charts.findings


RUNNING = process_rows(WAYS["running"])


def runnable(kind, number, instance=0, time=5):
    return (time, kind, TASK_A, 0, number, instance)


NESTED = [*RUNNING, runnable(K.RUNNABLE_START, RUN), runnable(K.RUNNABLE_START, RUN_2)]
PREEMPT, RESUME, TERMINATE = ((5, kind, CORE, 0, TASK_A, 0) for kind in (K.PREEMPT, K.RESUME, K.TERMINATE))
SUSPENDED = [*NESTED, runnable(K.RUNNABLE_SUSPEND, RUN_2), runnable(K.RUNNABLE_SUSPEND, RUN), PREEMPT]
RESUMED = [*SUSPENDED, RESUME, runnable(K.RUNNABLE_RESUME, RUN), runnable(K.RUNNABLE_RESUME, RUN_2)]


def test_nested_runnables():
    ends = [runnable(K.RUNNABLE_TERMINATE, RUN_2), runnable(K.RUNNABLE_TERMINATE, RUN), TERMINATE]
    assert rules([*RESUMED, *ends]) == []


@pytest.mark.parametrize(
    ("rows", "rule"),
    [
        ([*NESTED, runnable(K.RUNNABLE_TERMINATE, RUN)], "runnable state"),  # the outer one first
        ([*NESTED, runnable(K.RUNNABLE_SUSPEND, RUN)], "runnable state"),
        ([*SUSPENDED, RESUME, runnable(K.RUNNABLE_RESUME, RUN_2)], "runnable state"),  # the inner one first
        ([*NESTED, runnable(K.RUNNABLE_RESUME, RUN_2)], "runnable state"),  # it is running
        ([*RUNNING, runnable(K.RUNNABLE_SUSPEND, RUN)], "runnable state"),  # it has not started
        ([*NESTED, PREEMPT], "runnable state"),  # before the runnables are suspended
        ([*SUSPENDED, RESUME, TERMINATE], "runnable state"),
        ([*SUSPENDED, runnable(K.RUNNABLE_RESUME, RUN)], "action"),  # before the process is resumed
        ([*process_rows(WAYS["active"]), runnable(K.RUNNABLE_START, RUN)], "action"),  # before the process starts
        ([*RESUMED, runnable(K.RUNNABLE_START, RUN, 2)], "instance number"),
        ([*process_rows(WAYS["ready"]), (6, K.READ, TASK_A, 0, LABEL, 0)], "action"),
    ],
)
def test_runnables_and_accesses_out_of_order(rows, rule):
    assert rule in rules(rows)


def test_a_stimulus_is_triggered_before_its_effect():
    assert rules([(0, K.ACTIVATE, STI_A, 0, TASK_A, 0), (0, K.TRIGGER, STI_A, 0, STI_A, 0)]) == ["trigger"]
    assert rules([(0, K.TRIGGER, STI_A, 0, STI_A, 0), (0, K.ACTIVATE, STI_A, 1, TASK_A, 0)]) == ["trigger"]
    assert rules([(0, K.TRIGGER, STI_A, 0, STI_A, 0), (0, K.TRIGGER, STI_A, 2, STI_A, 2)]) == ["instance number"]


def test_a_core_executes_one_process():
    other = [(6, K.TRIGGER, STI_B, 0, STI_B, 0), (6, K.ACTIVATE, STI_B, 0, TASK_B, 0), (6, K.START, CORE, 0, TASK_B, 0)]
    assert rules([*RUNNING, *other]) == ["core"]
    assert rules([*RUNNING, PREEMPT, *other]) == []
    assert rules([*RUNNING, (5, K.PREEMPT, CORE_2, 0, TASK_A, 0)]) == ["core"]


def test_time_that_decreases():
    assert rules([(5, K.READ, TASK_A, 0, LABEL, 0), (4, K.READ, TASK_A, 0, LABEL, 0)]) == ["time"]


#: The chart of counting semaphores: event, states before, state after.
SEMAPHORE = {
    K.USED: ({"free", "used"}, "used"),
    K.LOCK: ({"free"}, "full"),
    K.LOCK_USED: ({"used"}, "full"),
    K.OVERFULL: ({"full", "overfull"}, "overfull"),
    K.FULL: ({"overfull"}, "full"),
    K.UNLOCK_FULL: ({"full"}, "used"),
    K.FREE: ({"used"}, "free"),
    K.UNLOCK: ({"full"}, "free"),
}
#: An event after which a semaphore is in the state.
INTO = {"free": K.UNLOCK, "used": K.UNLOCK_FULL, "full": K.FULL, "overfull": K.OVERFULL}


@pytest.mark.parametrize(("state", "kind"), list(product(INTO, SEMAPHORE)))
def test_a_semaphore_does_only_what_the_chart_shows(state, kind):
    rows = [(number, event, SEM, 0, SEM, 0) for number, event in enumerate((INTO[state], kind))]
    assert rules(rows) == ([] if state in SEMAPHORE[kind][0] else ["semaphore state"])


def access(*kinds):
    return [*RUNNING, *((3, kind, TASK_A, 0, SEM, 0) for kind in kinds)]


@pytest.mark.parametrize(
    ("kinds", "is_legal"),
    [
        ([K.REQUEST_SEMAPHORE, K.ASSIGNED, K.RELEASED], True),
        ([K.REQUEST_SEMAPHORE, K.INCREMENT, K.QUEUED, K.ASSIGNED, K.RELEASED, K.DECREMENT], True),
        ([K.REQUEST_SEMAPHORE, K.QUEUED, K.WAITING, K.ASSIGNED, K.RELEASED, K.REQUEST_SEMAPHORE], True),
        ([K.ASSIGNED], False),
        ([K.RELEASED], False),
        ([K.REQUEST_SEMAPHORE, K.RELEASED], False),
        ([K.REQUEST_SEMAPHORE, K.WAITING, K.RELEASED], False),
        ([K.REQUEST_SEMAPHORE, K.ASSIGNED, K.ASSIGNED], False),
        ([K.REQUEST_SEMAPHORE, K.ASSIGNED, K.QUEUED], False),
    ],
)
def test_uses_of_a_semaphore(kinds, is_legal):
    assert rules(access(*kinds)) == ([] if is_legal else ["semaphore state"])


def test_a_spinlock():
    lock, unlock = (3, K.LOCK, SEM, 0, SEM, 0), (3, K.UNLOCK, SEM, 0, SEM, 0)
    request, assigned, released = access(K.REQUEST_SEMAPHORE, K.ASSIGNED, K.RELEASED)[-3:]
    assert rules([*RUNNING, request, lock, assigned, released, unlock]) == []
    assert rules([*RUNNING, unlock, request, assigned, lock, released]) == ["semaphore state"]  # assigned while it is free


def test_a_file_is_checked(tmp_path):
    path = tmp_path / "run.btf"
    path.write_text("#version 2.3.0\n#timescale ns\n" + LINES.replace("200,Core_1,0,T,Task_A,0,preempt\n", ""))
    findings = check_trace(path)
    # Task_B starts while Task_A is still there, and Task_A is resumed, but has not been preempted.
    assert [finding.rule for finding in findings] == ["core", "process state"]
    assert "illegal transition of 'Task_A': resume in state running" in findings[1].message


def test_after_a_loss_of_events_anything_can_be_in_any_state():
    charts = StateCharts()
    lost = [(0, K.ACTIVATE, TASK_A, 0, TASK_A, 0), (1, K.START, CORE, 0, TASK_A, 0), (2, K.GAP, SEM, 0, SEM, 0)]
    charts.check(table(ENTITIES, [*lost, (3, K.RESUME, CORE, 0, TASK_A, 4), (4, K.TERMINATE, CORE, 0, TASK_A, 4)]))
    assert charts.findings == ()
