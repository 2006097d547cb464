"""The times of jobs and runnables in traces of events: by hand, and as the simulation that wrote the trace observed them."""

from hypothesis import given
from hypothesis import strategies as st
from traces import table

from amalthea_uros import Options, task, taskset
from amalthea_uros.compare.measured.events import begins_of
from amalthea_uros.measure.chains import ChainSteps
from amalthea_uros.measure.jobs import JobFollower
from amalthea_uros.measure.series import Counts
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.trace.sinks import EventRecorder
from amalthea_uros.trace.table import Entity, EntityKind, EventKind
from amalthea_uros.units import MICROSECOND, Duration

E = EventKind
ENTITIES = [Entity(EntityKind.CORE, "Core"), Entity(EntityKind.TASK, "Task"), Entity(EntityKind.RUNNABLE, "Runnable")]
CORE, TASK, RUNNABLE = range(3)


def measured(*tables):
    walk = JobFollower()
    for part in tables:
        walk.add(part)
    walk.finish()
    return {(series.name, series.quantity): series for series in walk.series([entity.name for entity in ENTITIES])}


def values(found, quantity, name="Task"):
    series = found.get((name, quantity))
    return None if series is None or series.values is None else series.values.tolist()


def task_events(*rows):
    return table(ENTITIES, [(time, kind, CORE, 0, TASK, instance) for time, kind, instance in rows])


PREEMPTED = [(0, E.ACTIVATE, 0), (10, E.START, 0), (14, E.PREEMPT, 0), (20, E.RESUME, 0), (23, E.TERMINATE, 0)]


def test_a_preempted_job_has_the_times_of_the_state_chart():
    found = measured(task_events(*PREEMPTED))
    expected = {
        JobMetric.NET_EXECUTION_TIME: [7],
        JobMetric.GROSS_EXECUTION_TIME: [13],
        JobMetric.RESPONSE_TIME: [23],
        JobMetric.INITIAL_PENDING_TIME: [10],
        JobMetric.READY_TIME: [6],
        JobMetric.PREEMPTION_TIME: [16],
    }
    assert {quantity: values(found, quantity) for quantity in expected} == expected


def test_a_job_without_activation_has_no_response_time():
    """What was not recorded is not guessed: many recorders only have the switches between tasks."""
    found = measured(task_events(*PREEMPTED[1:]))
    assert values(found, JobMetric.NET_EXECUTION_TIME) == [7]
    assert values(found, JobMetric.RESPONSE_TIME) is None
    assert values(found, JobMetric.INITIAL_PENDING_TIME) is None


def test_jobs_at_the_edges_are_incomplete():
    rows = [
        (5, E.RESUME, 0),
        (9, E.TERMINATE, 0),
        (10, E.ACTIVATE, 1),
        (11, E.START, 1),
        (15, E.TERMINATE, 1),
        (20, E.ACTIVATE, 2),
    ]
    found = measured(task_events(*rows))
    assert values(found, JobMetric.RESPONSE_TIME) == [5]
    assert found["Task", JobMetric.RESPONSE_TIME].counts == Counts(incomplete=2)


def test_a_gap_drops_what_is_open_and_ends_what_follows():
    rows = [(time + 100 * job, kind, job) for job in range(4) for time, kind, _ in PREEMPTED]
    rows = [*rows[:7], (115, E.GAP, 0), *rows[7:]]
    found = measured(task_events(*rows))
    assert values(found, JobMetric.RESPONSE_TIME) == [23, 23, 23]
    assert values(found, JobMetric.ACTIVATE_TO_ACTIVATE) == [100]
    assert found["Task", JobMetric.RESPONSE_TIME].counts.incomplete == 2


def test_a_missing_number_is_a_lost_job():
    rows = [(time + 100 * job, kind, job) for job in (0, 1, 4, 5) for time, kind, _ in PREEMPTED]
    found = measured(task_events(*rows))
    assert values(found, JobMetric.START_TO_START) == [100, 100]
    assert found["Task", JobMetric.START_TO_START].counts == Counts(lost=2)


def test_an_activation_that_the_system_lost_is_no_job_of_which_times_are_missing():
    """Its number is that of no job: the next job follows the last one, as a simulation that loses activations observes it."""
    rows = [(time + 100 * job, kind, job) for job in (0, 1, 4, 5) for time, kind, _ in PREEMPTED]
    rows = [*rows[:10], (200, E.ACTIVATION_LOST, 2), (300, E.ACTIVATION_LOST, 3), *rows[10:]]
    found = measured(task_events(*rows))
    assert values(found, JobMetric.ACTIVATE_TO_ACTIVATE) == [100, 300, 100]
    assert found["Task", JobMetric.START_TO_START].counts == Counts(lost_activations=2)
    # Of a job whose number is missing besides, nothing is known.
    found = measured(task_events(*rows[:10], *rows[11:]))
    assert values(found, JobMetric.ACTIVATE_TO_ACTIVATE) == [100, 100]
    assert found["Task", JobMetric.START_TO_START].counts == Counts(lost=1, lost_activations=1)


def test_a_lost_activation_may_have_the_number_of_the_next_job():
    rows = [(time + 100 * job, kind, job) for job in (0, 1, 2, 3) for time, kind, _ in PREEMPTED]
    found = measured(task_events(*rows[:10], (190, E.ACTIVATION_LOST, 2), *rows[10:]))
    assert values(found, JobMetric.ACTIVATE_TO_ACTIVATE) == [100, 100, 100]
    assert found["Task", JobMetric.START_TO_START].counts == Counts(lost_activations=1)


def test_a_runnable_does_not_execute_while_its_process_is_preempted():
    process = task_events(*PREEMPTED)
    runnable = [(11, E.RUNNABLE_START, TASK, 0, RUNNABLE, 0), (22, E.RUNNABLE_TERMINATE, TASK, 0, RUNNABLE, 0)]
    rows = sorted([*zip(*(column.tolist() for column in process.to_dict().values()), strict=True), *runnable])
    found = measured(table(ENTITIES, rows))
    assert values(found, JobMetric.NET_EXECUTION_TIME, "Runnable") == [5]
    assert values(found, JobMetric.GROSS_EXECUTION_TIME, "Runnable") == [11]
    assert values(found, JobMetric.RESPONSE_TIME, "Runnable") == [22]


def test_runnables_are_measured_without_events_of_their_process():
    kinds = (E.RUNNABLE_START, E.RUNNABLE_SUSPEND, E.RUNNABLE_RESUME, E.RUNNABLE_TERMINATE)
    rows = [(time, kind, TASK, 0, RUNNABLE, 0) for time, kind in zip((0, 4, 10, 13), kinds, strict=True)]
    found = measured(table(ENTITIES, rows))
    assert values(found, JobMetric.NET_EXECUTION_TIME, "Runnable") == [7]
    assert ("Task", JobMetric.NET_EXECUTION_TIME) not in found


tasks = st.tuples(st.integers(1, 20), st.integers(1, 12), st.integers(0, 5))


@given(st.lists(tasks, min_size=1, max_size=4), st.booleans())
def test_the_trace_of_a_simulation_has_what_it_observed(parameters, with_chain):
    made = [
        task(name=f"T{number}", period=period * 100, wcet=wcet * 10, offset=offset * 30, unit="us")
        for number, (period, wcet, offset) in enumerate(parameters)
    ]
    chains = {"chain": [each.name for each in made]} if with_chain else None
    system = taskset(made, priorities="rate monotonic", chains=chains)
    duration = 10_000 * MICROSECOND
    recorder = EventRecorder()
    found = simulate_system(system, Options(duration=Duration(duration), traced=(0, Duration(duration))), [recorder])
    events = recorder.table
    walk, steps = JobFollower(), ChainSteps(begins_of(system).chains)
    for part in (events.rows(0, 50), events.rows(50, len(events))):
        walk.add(part)
        steps.add(part)
    names = [entity.name for entity in events.entities]
    series = {(each.name, each.quantity): each.statistics for each in (*walk.series(names), *steps.series(names))}
    observed = [(each.name, each.metrics) for each in found.processes]
    for name, metrics in observed:
        for metric, expected in metrics.items():
            if metric not in (JobMetric.SLACK_TIME, JobMetric.LATENESS):
                assert_equal(series[name, metric], expected)
    for each in found.chains:
        if len(made) > 1:
            for quantity, expected in each.quantities.items():
                assert_equal(series[each.name, quantity], expected)


def assert_equal(statistics, expected):
    figures = statistics.count, statistics.min, statistics.mean, statistics.max, statistics.std
    assert figures == (expected.count, expected.min, expected.mean, expected.max, expected.std)
