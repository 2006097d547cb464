"""The jitter of messages that an agent sends."""

from pathlib import Path

import pytest
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.errors import ReadError
from amalthea_uros.perf.stimuli import Arrivals
from amalthea_uros.services.simulate import simulate
from amalthea_uros.timing.activation.releases import counters
from amalthea_uros.units import MILLISECOND as MS

SAMPLE = (ROOT / "samples" / "bodas-test-advanced.yaml").read_text()


def describe(tmp_path: Path, keys: str):
    path = tmp_path / "app.yaml"
    path.write_text(SAMPLE.replace("rate: 50 Hz", keys))
    return amuros.describe(path)


def arrivals(system):
    return {(process, counter.source): counter.arrivals for process, counter in counters(system)}


def test_the_executor_takes_what_arrives(tmp_path):
    found = arrivals(describe(tmp_path, "rate: 50 Hz, jitter: 5 ms").system)
    assert found == {("Executor_Task", "Message_Factor"): Arrivals(jitter=5 * MS)}


def test_an_interval_between_two_periods(tmp_path):
    found = arrivals(describe(tmp_path, "interval: 20500 us, jitter: 100 us").system)
    assert found["Executor_Task", "Message_Factor"] == Arrivals(period=20_500_000_000, jitter=MS // 10)


def test_without_jitter_messages_are_regular(tmp_path):
    assert set(arrivals(describe(tmp_path, "rate: 50 Hz").system).values()) == {None}


def test_the_model_keeps_it(tmp_path):
    model = build_model(describe(tmp_path, "interval: 20500 us, jitter: 100 us").system)
    assert arrivals(extract(model).system)["Executor_Task", "Message_Factor"] == Arrivals(
        period=20_500_000_000, jitter=MS // 10
    )


def test_the_task_of_the_callback_keeps_up_with_the_shortest_distance(tmp_path):
    """20 ms would be too long for messages that can be 15 ms apart."""
    system = describe(tmp_path, "rate: 50 Hz, jitter: 5 ms").system
    (stimulus,) = system.processes["Message_Factor"].stimuli
    assert system.stimuli_by_name[stimulus].period == 10 * MS


def test_simulation_and_analysis_know_it(tmp_path):
    system = describe(tmp_path, "rate: 50 Hz, jitter: 5 ms").system
    assert len({str(value.claim) for value in amuros.analyze_system(system).chains[0].values}) == 1
    latencies = simulate(system, "400 ms").chains[0].quantities["first_to_first"]
    assert latencies.min < latencies.max


def test_a_jitter_of_an_interval(tmp_path):
    with pytest.raises(ReadError) as caught:
        describe(tmp_path, "rate: 50 Hz, jitter: 20 ms")
    assert caught.value.findings[0].message == "the jitter of 'Message_Factor' is not shorter than its message interval"
