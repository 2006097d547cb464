"""Messages that arrive by themselves, and the jobs that take them."""

from dataclasses import replace

import numpy as np
import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from amalthea_uros import analyze_system, describe
from amalthea_uros._internal.plural import counted
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.apply import describe as describe_changes
from amalthea_uros.design.changes.change import parse_change
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.simulate.kernel import machine_code
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.program.stimulus_records import QUEUE_LENGTH
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.trace.sinks import EventRecorder
from amalthea_uros.trace.table import EventKind
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import SECOND, Duration

THESIS = describe(ROOT / "samples" / "bodas-test-advanced.yaml").system
RCLC = describe(ROOT / "samples" / "rclc-in-executor.yaml").system


@pytest.fixture(autouse=True)
def interpreted(monkeypatch):
    monkeypatch.setattr(machine_code, "is_worth_it", lambda _seconds, _left: False)


def simulate(*changes, system=THESIS, duration=200 * MS, sinks=(), **options):
    changed, settings_ = apply(system, Settings(), map(parse_change, changes))
    return simulate_system(changed, Options(duration=Duration(duration), settings=settings_, **options), sinks)


def observed(simulation):
    """What a simulation shows, without what it assumes."""
    return replace(simulation, assumptions=())


@given(st.integers(0, 39))
@examples(6)
def test_regular_arrivals_on_the_grid_are_the_counter(phase):
    stated = f"Message_Factor.phase={phase}ms"
    assert observed(simulate(stated, "Message_Factor.arrival_jitter=0ms")) == observed(simulate(stated))


@given(st.integers(1, 20 * MS), st.booleans())
@examples(6)
def test_a_job_takes_what_arrived_before_its_activation(phase, is_queued):
    changes = [f"Message_Factor.phase={phase}ps", *(["Message_Factor.arrival_jitter=0ms"] if is_queued else [])]
    next_activation = f"Message_Factor.phase={-(-phase // MS)}ms"
    assert observed(simulate(*changes)) == observed(simulate(next_activation))


def test_callbacks_in_the_executor_take_part_together():
    """Take and callback are two calls of one job."""
    phases = ["On_Command.phase=30ms", "Control.phase=10ms"]
    jitters = ["On_Command.arrival_jitter=0ms", "Control.arrival_jitter=0ms"]
    assert observed(simulate(*phases, *jitters, system=RCLC, duration=SECOND)) == observed(
        simulate(*phases, system=RCLC, duration=SECOND)
    )


def taking_jobs(arrivals, activations):
    """The activations whose jobs take a message: one each, oldest first, of those that are there and fit into the queue."""
    events = sorted([(time, 0) for time in arrivals] + [(time, 1) for time in activations])
    waiting, taking, lost = 0, [], 0
    for time, is_activation in events:
        if not is_activation:
            lost += waiting == QUEUE_LENGTH
            waiting = min(QUEUE_LENGTH, waiting + 1)
        elif waiting:
            waiting -= 1
            taking.append(time)
    return taking, lost


@pytest.mark.parametrize(
    "changes",
    [
        ["Message_Factor.arrival_jitter=5ms"],
        ["Message_Factor.arrival_jitter=60ms"],
        ["Message_Factor.arrival_period=20.7ms"],
        ["Message_Factor.arrival_period=0.9ms", "Message_Factor.arrival_jitter=3ms"],
        ["Message_Factor.arrival_period=2ms", "Message_Factor.arrival_jitter=30ms"],
    ],
)
def test_irregular_arrivals(changes):
    """The jobs that take 25 us are those that a queue by the book gives messages to."""
    recorder = EventRecorder()
    found = simulate(*changes, sinks=[recorder], traced=(0, "200 ms"))
    events, names = recorder.table, np.array([entity.name for entity in recorder.table.entities])
    arrivals, activations, starts, ends = (
        events.time[(events.kind == kind) & (names[events.target] == name)].tolist()
        for kind, name in (
            (EventKind.TRIGGER, "Message_Factor"),
            *((kind, "Executor_Task") for kind in (EventKind.ACTIVATE, EventKind.START, EventKind.TERMINATE)),
        )
    )
    assert len(arrivals) > 5
    durations = [end - start for start, end in zip(starts, ends, strict=True)]
    taking, lost = taking_jobs(arrivals, activations)
    assert [time for time, duration in zip(activations, durations, strict=True) if duration == 25 * US] == taking
    assert [finding.rule for finding in found.findings] == ["SIM005"] * (lost > 0)
    assert lost == 0 or f"{counted(lost, 'message')} lost" in found.findings[0].message


def test_phases_are_random_where_nobody_states_them():
    latencies = {
        simulate("Message_Factor.arrival_jitter=0ms", seed=seed, duration=100 * MS)
        .chains[0]
        .quantities[ChainQuantity.FIRST_TO_FIRST]
        .max
        for seed in range(1, 9)
    }
    assert len(latencies) > 3


def test_without_sampling_the_first_possibility_counts():
    first = simulate("Message_Factor.arrival_jitter=0ms", mode=Mode.AVERAGE)
    assert observed(first) == observed(simulate("Message_Factor.phase=0ms", mode=Mode.AVERAGE))


@given(st.integers(0, 45_000), st.integers(700, 45_000), st.integers(1, 1000))
@examples(15)
def test_no_bound_is_exceeded(jitter, period, seed):
    """Microseconds; the analysis knows period and jitter, and nothing else."""
    changes = [f"Message_Factor.arrival_jitter={jitter}us", f"Message_Factor.arrival_period={period}us"]
    changed, _ = apply(THESIS, Settings(), map(parse_change, changes))
    bounds, found = analyze_system(changed), simulate(*changes, seed=seed, duration=300 * MS)
    for process in bounds.processes:
        response = found.processes[process.name].metrics[JobMetric.RESPONSE_TIME]
        assert process.response.best <= response.min
        assert response.max <= process.response.worst
    (chain,) = bounds.chains
    values = {value.quantity: value.value for value in chain.values}
    quantities = found.chains[0].quantities
    for quantity, name in (
        (ChainQuantity.REACTION_TIME, "max_reaction_time"),
        (ChainQuantity.REDUCED_REACTION_TIME, "max_reduced_reaction_time"),
        (ChainQuantity.DATA_AGE, "max_data_age"),
        (ChainQuantity.REDUCED_DATA_AGE, "max_reduced_data_age"),
    ):
        if quantity in quantities and name in values:
            assert quantities[quantity].max <= values[name]
    assert "exact" not in {str(value.claim) for value in chain.values}


def test_the_analysis_states_what_it_assumes():
    changed, _ = apply(THESIS, Settings(), [parse_change("Message_Factor.arrival_jitter=5ms")])
    found = analyze_system(changed)
    sentence = "Message_Factor is due every 20 ms with a jitter of 5 ms: it is unknown in which jobs of Executor_Task"
    assert sentence in found.assumptions
    assert not any("all phases are evaluated" in assumption for assumption in found.assumptions)


def test_the_changes_are_described():
    changes = [parse_change("Message_Factor.arrival_jitter=5ms"), parse_change("Message_Factor.arrival_period=21ms")]
    assert [(d.key, d.before, d.after) for d in describe_changes(THESIS, Settings(), changes)] == [
        ("arrival_jitter", "0 s", "5 ms"),
        ("arrival_period", "20 ms", "21 ms"),
    ]


@pytest.mark.parametrize("text", ["arrival_period=0ms", "arrival_period=-1ms", "arrival_jitter=-1ms", "arrival_jitter=5"])
def test_wrong_values(text):
    with pytest.raises(InvalidArgumentError, match=text.split("=")[0]):
        apply(THESIS, Settings(), [parse_change(f"Message_Factor.{text}")])


def test_a_trace_changes_nothing():
    """Random numbers belong to places of the model, not of the program, in which a trace has more operations."""
    assert simulate(system=RCLC, traced=(0, "1 ms")) == simulate(system=RCLC)
