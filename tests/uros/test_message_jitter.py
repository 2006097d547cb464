"""The jitter of messages that an agent sends."""

import pytest
from support import ROOT

import amalthea_uros as amuros
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.perf.stimuli import Arrivals
from amalthea_uros.services.simulate import simulate
from amalthea_uros.timing.activation.releases import counters
from amalthea_uros.units import MILLISECOND as MS

SAMPLE = (ROOT / "samples" / "bodas-test-advanced.yaml").read_text()
JITTER = SAMPLE.replace("rate: 50 Hz", "rate: 50 Hz, jitter: 5 ms")


def arrivals(system):
    return {(process, counter.source): counter.arrivals for process, counter in counters(system)}


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ("rate: 50 Hz", None),
        ("rate: 50 Hz, jitter: 5 ms", Arrivals(jitter=5 * MS)),
        # An interval between two periods of the executor.
        ("interval: 20500 us, jitter: 100 us", Arrivals(period=20_500_000_000, jitter=MS // 10)),
    ],
)
def test_the_executor_takes_what_arrives_and_the_model_keeps_it(keys, expected, author):
    system = author.describe(SAMPLE.replace("rate: 50 Hz", keys)).system
    for found in (system, extract(build_model(system)).system):
        assert arrivals(found) == {("Executor_Task", "Message_Factor"): expected}


def test_the_task_of_the_callback_keeps_up_with_the_shortest_distance(author):
    """20 ms would be too long for messages that can be 15 ms apart."""
    system = author.describe(JITTER).system
    (stimulus,) = system.processes["Message_Factor"].stimuli
    assert system.stimuli_by_name[stimulus].period == 10 * MS


def test_simulation_and_analysis_know_it(author):
    system = author.describe(JITTER).system
    assert len({str(value.claim) for value in amuros.analyze_system(system).chains[0].values}) == 1
    latencies = simulate(system, "200 ms").chains[0].quantities["first_to_first"]
    assert latencies.min < latencies.max


def test_a_jitter_of_an_interval(author):
    ((_, _, message), *_) = author.findings(SAMPLE.replace("rate: 50 Hz", "rate: 50 Hz, jitter: 20 ms"))
    assert message == "the jitter of 'Message_Factor' is not shorter than its message interval"
