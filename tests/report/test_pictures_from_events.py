"""Jobs from events, also where a trace begins or ends amid them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from traces import table as table_of

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.report.pictures.chain_paths import ChainStep, DrawnPath
from amalthea_uros.report.pictures.from_events import UNKNOWN_CORE, chain_path, jobs_of
from amalthea_uros.report.pictures.jobs import CoreRows, Job, ProcessRow, RunnableSpan, State, StateSpan
from amalthea_uros.trace.table import Entity, EntityKind, EventKind

STIMULUS, CORE_0, CORE_1, TASK, ISR, RUNNABLE, INNER, CHAIN = range(8)
ENTITIES = (
    Entity(EntityKind.STIMULUS, "tick"),
    Entity(EntityKind.CORE, "Core_0"),
    Entity(EntityKind.CORE, "Core_1"),
    Entity(EntityKind.TASK, "Task"),
    Entity(EntityKind.ISR, "Interrupt"),
    Entity(EntityKind.RUNNABLE, "outer"),
    Entity(EntityKind.RUNNABLE, "inner"),
    Entity(EntityKind.CHAIN, "chain"),
)
K = EventKind


def table(*events):
    """Events as (time, kind, source, source instance, target, target instance[, note])."""
    return table_of(ENTITIES, events)


def event(time, kind, target=TASK, instance=0, source=CORE_0):
    return (time, kind, STIMULUS if kind in (K.ACTIVATE, K.ACTIVATION_LOST) else source, 0, target, instance)


#: An interrupt preempts a task.
PREEMPTION = (
    event(0, K.ACTIVATE),
    event(0, K.START),
    event(20, K.ACTIVATE, ISR, 4),
    event(20, K.PREEMPT),
    event(20, K.START, ISR, 4),
    event(30, K.TERMINATE, ISR, 4),
    event(30, K.RESUME),
    event(50, K.TERMINATE),
)


def running(start, end, core="Core_0"):
    return StateSpan(State.RUNNING, start, end, core)


def only(*events, **window):
    [core] = jobs_of(table(*events), **window)
    [row] = core.rows
    [job] = row.jobs
    return job


def test_jobs_are_in_the_states_between_their_events():
    task = Job(0, (StateSpan(State.ACTIVE, 0, 0), running(0, 20), StateSpan(State.READY, 20, 30), running(30, 50)), 0, 50)
    interrupt = Job(4, (StateSpan(State.ACTIVE, 20, 20), running(20, 30)), 20, 30)
    assert jobs_of(table(*PREEMPTION)) == (
        CoreRows("Core_0", (ProcessRow("Task", (task,)), ProcessRow("Interrupt", (interrupt,)))),
    )


@pytest.mark.parametrize(
    ("kind", "before", "after"),
    [
        (K.START, State.ACTIVE, State.RUNNING),
        (K.PREEMPT, State.RUNNING, State.READY),
        (K.RESUME, State.READY, State.RUNNING),
        (K.TERMINATE, State.RUNNING, None),
        (K.POLL, State.RUNNING, State.POLLING),
        (K.RUN, State.POLLING, State.RUNNING),
        (K.PARK, State.POLLING, State.PARKING),
        (K.POLL_PARKING, State.PARKING, State.POLLING),
        (K.RELEASE_PARKING, State.PARKING, State.READY),
        (K.WAIT, State.RUNNING, State.WAITING),
        (K.RELEASE, State.WAITING, State.READY),
    ],
)
def test_the_states_around_a_window_follow_from_its_events(kind, before, after):
    job = only(event(40, kind), start=0, end=100)
    expected = [(before, 0, 40), (after, 40, 100)] if after else [(before, 0, 40)]
    assert [(span.state, span.start, span.end) for span in job.spans] == expected
    assert job.activation is None
    assert job.end == (40 if kind is K.TERMINATE else None)


def test_the_state_before_a_window_is_taken_from_the_events_before_it():
    job = only(event(0, K.ACTIVATE), event(10, K.START), event(90, K.TERMINATE), start=50, end=80)
    assert job == Job(0, (StateSpan(State.ACTIVE, 0, 10), running(10, 80)), 0, None)


def test_what_was_seen_counts_more_than_what_an_event_implies():
    # The release of the waiting task is missing.
    job = only(event(0, K.START), event(10, K.WAIT), event(30, K.RESUME), event(40, K.TERMINATE))
    assert job.spans[1:] == (running(0, 10), StateSpan(State.WAITING, 10, 30), running(30, 40))


def test_jobs_that_end_before_a_window_or_begin_after_it_are_left_out():
    assert jobs_of(table()) == jobs_of(table(*PREEMPTION), start=60, end=80) == ()
    for start, end in ((35, 80), (0, 10)):
        [core] = jobs_of(table(*PREEMPTION), start=start, end=end)
        assert [row.name for row in core.rows] == ["Task"]


def test_deadlines_are_relative_to_the_activation_and_unknown_without_it():
    events = (event(10, K.ACTIVATE, instance=1), event(10, K.TERMINATE, instance=0))
    [core] = jobs_of(table(*events), deadlines={"Task": 100, "Other": 1})
    assert [job.deadline for job in core.rows[0].jobs] == [None, 110]


def test_a_process_belongs_to_the_core_where_it_is_seen_first():
    job = (event(0, K.START, source=CORE_1), event(5, K.PREEMPT, source=CORE_1), event(9, K.RESUME), event(20, K.TERMINATE))
    [core] = jobs_of(table(*job))
    assert core.name == "Core_1"
    assert [span.core for span in core.rows[0].jobs[0].spans if span.state is State.RUNNING] == ["Core_1", "Core_0"]


def test_cores_are_in_their_order_and_a_process_that_never_runs_is_last():
    events = (event(0, K.ACTIVATE), event(1, K.START, ISR, source=CORE_1))
    assert [core.name for core in jobs_of(table(*events))] == ["Core_1", UNKNOWN_CORE]


def test_lost_activations_are_those_in_the_window():
    events = (event(0, K.ACTIVATION_LOST), event(10, K.ACTIVATION_LOST, instance=1), event(20, K.ACTIVATE, instance=2))
    [core] = jobs_of(table(*events), start=5)
    assert core.rows[0].lost == (10,)


def call(time, kind, runnable=RUNNABLE, instance=0):
    return (time, kind, TASK, 0, runnable, instance)


def test_runnables_run_while_their_job_does():
    events = (
        event(0, K.START),
        call(0, K.RUNNABLE_START),
        call(15, K.RUNNABLE_START, INNER),
        event(20, K.PREEMPT),
        event(30, K.RESUME),
        call(35, K.RUNNABLE_TERMINATE, INNER),
        call(40, K.RUNNABLE_TERMINATE),
        event(50, K.TERMINATE),
    )
    outer, inner = (("outer", 0, 20), ("outer", 30, 40)), (("inner", 15, 20), ("inner", 30, 35))
    assert only(*events).runnables == tuple(RunnableSpan(*part) for part in (*outer, *inner))


def test_runnables_at_the_ends_of_a_trace_are_cut():
    events = (event(0, K.RESUME), call(10, K.RUNNABLE_TERMINATE), call(10, K.RUNNABLE_START, RUNNABLE, 1), event(30, K.PREEMPT))
    assert only(*events).runnables == (RunnableSpan("outer", 0, 10), RunnableSpan("outer", 10, 30))


def step(time, process, occurrence, number):
    return (time, K.CHAIN_STEP, process, 0, CHAIN, occurrence, number)


def test_the_way_of_a_chain_passes_each_step_first():
    # The effect of occurrence 3 passes its second step twice, as it is read twice.
    events = (step(5, ISR, 2, 0), step(10, ISR, 3, 0), step(20, TASK, 3, 1), step(30, TASK, 3, 1), step(40, ISR, 3, 2))
    steps = (ChainStep("Interrupt", 10), ChainStep("Task", 20), ChainStep("Interrupt", 40))
    assert chain_path(table(*events), "chain", 3) == DrawnPath("chain", steps)


@pytest.mark.parametrize(("chain", "occurrence"), [("chain", 7), ("other", 3)])
def test_a_way_without_events_is_refused(chain, occurrence):
    with pytest.raises(InvalidArgumentError, match=f"occurrence {occurrence} of the chain '{chain}'"):
        chain_path(table(step(10, ISR, 3, 0)), chain, occurrence)


@given(
    st.lists(st.tuples(st.integers(0, 20), st.integers(0, 5)), min_size=1, max_size=10), st.integers(0, 100), st.integers(1, 50)
)
def test_a_window_shows_what_the_whole_trace_shows_there(lengths, start, width):
    """Jobs one after the other, each active and then running; the times in these states within a window are those of a scan."""
    events, now, states = [], 0, []
    for instance, (active, run) in enumerate(lengths):
        events += [event(now, K.ACTIVATE, instance=instance), event(now + active, K.START, instance=instance)]
        events.append(event(now + active + run, K.TERMINATE, instance=instance))
        states += [State.ACTIVE] * active + [State.RUNNING] * run
        now += active + run
    end = start + width
    shown = [
        (span.state, max(span.start, start), min(span.end, end))
        for core in jobs_of(table(*events), start=start, end=end)
        for job in core.rows[0].jobs
        for span in job.spans
        if span.end > start and span.start < end
    ]
    for state in (State.ACTIVE, State.RUNNING):
        assert sum(right - left for found, left, right in shown if found is state) == states[start:end].count(state)


def test_a_process_that_does_not_run_in_the_window_is_on_the_core_that_is_stated():
    waiting = table(event(0, K.ACTIVATE), event(0, K.ACTIVATE, ISR), event(0, K.START, ISR, 0, CORE_1))
    assert [core.name for core in jobs_of(waiting)] == ["Core_1", UNKNOWN_CORE]
    assert [core.name for core in jobs_of(waiting, cores={"Task": "Core_0", "Interrupt": "Core_0"})] == ["Core_0", "Core_1"]
