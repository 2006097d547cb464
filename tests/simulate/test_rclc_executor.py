"""Callbacks that an executor calls itself, as rclc does: in their order, with LET or ROS semantics, under trigger conditions."""

import pytest
from effort import examples
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT, analysis_of

from amalthea_uros import describe
from amalthea_uros.simulate.kernel import machine_code
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.trace.sinks import EventRecorder
from amalthea_uros.trace.table import EventKind
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import SECOND, Duration

SAMPLE = ROOT / "samples" / "rclc-in-executor.yaml"


@pytest.fixture(autouse=True)
def interpreted(monkeypatch):
    monkeypatch.setattr(machine_code, "is_worth_it", lambda _seconds, _left: False)


@pytest.fixture
def described(tmp_path):
    def describe_with(*replacements):
        text = SAMPLE.read_text()
        for old, new in replacements:
            assert old in text
            text = text.replace(old, new)
        path = tmp_path / "app.yaml"
        path.write_text(text)
        return describe(path).system

    return describe_with


def executed(system, duration, phases):
    """What the executor executes in each job: the runnables in their order, with the time from the activation to the end of each."""
    recorder = EventRecorder()
    settings = Settings(phases={callback: Duration(time) for callback, time in phases.items()})
    options = Options(duration=Duration(duration), mode=Mode.WORST, settings=settings, traced=(0, Duration(duration)))
    simulate_system(system, options, [recorder])
    events, jobs = recorder.table, []
    names = [entity.name for entity in events.entities]
    for time, kind, source, target in zip(events.time, events.kind, events.source, events.target, strict=True):
        if kind == EventKind.ACTIVATE and names[target] == "rclc_executor":
            jobs.append((int(time), []))
        elif kind == EventKind.RUNNABLE_TERMINATE and names[source] == "rclc_executor":
            jobs[-1][1].append((names[target], int(time) - jobs[-1][0]))
    return [job for _, job in jobs]


PHASES = {"On_Command": 0, "Control": 10 * MS, "Blink": 0}


def names(job):
    return [name for name, _ in job]


def test_let_takes_everything_first(described):
    """Job 1 has a command and an IMU message, job 2 an IMU message and the timer; the order is that of `order`."""
    first, second, third, *_ = executed(described(), 30 * MS, PHASES)
    takes = ["Take_On_Imu", "Take_On_Command"]
    assert names(first) == ["rclc_executor_Spin", "Notify_Blink", *takes, "On_Imu_Callback", "On_Command_Callback"]
    assert names(second) == ["rclc_executor_Spin", "Take_On_Imu", "Notify_Control", "On_Imu_Callback", "Control_Callback"]
    assert names(third) == ["rclc_executor_Spin", "Take_On_Imu", "On_Imu_Callback"]


def test_the_times_of_a_job(described):
    """20 us, taking 320 B: 4 + 15 + 32 us, notifying a timer: 4 us, 90 us, and 220 us with 25 us and 24 B of 100 ns to publish."""
    second = executed(described(), 20 * MS, PHASES)[1]
    assert [time for _, time in second] == [20 * US, 71 * US, 75 * US, 165 * US, (165 + 220 + 25) * US + 2400 * US // 1000]


def test_ros_takes_each_message_before_its_callback(described):
    second = executed(described(("semantics: LET", "semantics: ROS")), 20 * MS, PHASES)[1]
    assert names(second) == ["rclc_executor_Spin", "Take_On_Imu", "On_Imu_Callback", "Notify_Control", "Control_Callback"]


def test_callbacks_wait_for_the_trigger(described):
    """All of them wait for the command, which comes every 100 ms."""
    system = described(("semantics: LET", "semantics: LET\n    trigger: {one: On_Command}"))
    jobs = executed(system, 200 * MS, {"On_Command": 30 * MS, "Blink": 0})
    with_callbacks = [number for number, job in enumerate(jobs) if "On_Imu_Callback" in names(job)]
    assert with_callbacks == [3, 13]
    assert {"On_Command_Callback", "Control_Callback"} < set(names(jobs[3]))


def test_a_callback_that_is_not_due_takes_no_part_in_a_chain(described):
    """What the IMU callback writes is used by the timer in the same job or, if that is not due there, 10 ms later."""
    system = described(("min: 150 us, max: 220 us", "min: 150 us, max: 150 us"))
    phases = {"On_Command": 0, "Control": "10 ms", "Blink": 0}
    found = simulate_system(system, Options(duration=Duration(SECOND), settings=Settings(phases=phases)))
    latency = found.chains[0].quantities[ChainQuantity.REDUCED_REACTION_TIME]
    # From the start of On_Imu to the end of Control: 90 us, 150 us and publishing, 25 us and 24 B of 100 ns.
    own = 90 * US + 150 * US + 25 * US + 2400 * US // 1000
    # Only the later job notifies the timer first, 4 us.
    assert (latency.count, latency.min, latency.max) == (100, own, 10 * MS + own + 4 * US)


@pytest.fixture(scope="module")
def sample():
    return describe(SAMPLE).system, analysis_of(SAMPLE)


@given(seed=st.integers(1, 10_000), mode=st.sampled_from(list(Mode)))
@examples(9)
def test_no_bound_is_exceeded(sample, seed, mode):
    """Phases of messages and timers are independent of each other, and random."""
    system, bounds = sample
    found = simulate_system(system, Options(duration=Duration(600 * MS), seed=seed, mode=mode))
    for process in bounds.processes:
        response = found[process.name].metrics.get(JobMetric.RESPONSE_TIME)
        assert response is None or process.response.best <= response.min <= response.max <= process.response.worst
    for chain in bounds.chains:
        values = {value.quantity: value.value for value in chain.values}
        quantities = found.chains[chain.name].quantities
        assert quantities[ChainQuantity.REACTION_TIME].max <= values["max_reaction_time"]
        assert quantities[ChainQuantity.REDUCED_REACTION_TIME].max <= values["max_reduced_reaction_time"]
        assert quantities[ChainQuantity.REDUCED_DATA_AGE].max <= values["max_reduced_data_age"]
        assert quantities[ChainQuantity.FIRST_TO_FIRST].min >= values["min_first_to_first"]
