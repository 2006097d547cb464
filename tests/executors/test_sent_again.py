"""Bounds on wires that lose a stated number of messages: see docs/proofs/sent-again.md."""

import pytest

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND, MILLISECOND, SECOND, Duration
from amalthea_uros.uros.described import describe_text

TEXT = """
amuros: 1
name: hand
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {name: main, loop: {spin_some: 10 ms, sleep: 1 ms}, execution_time: {base: 50 us}}
  transport: {losses: {to_agent: 1 per 10 s}, udp: {bitrate: 100 Mbit/s, latency: 2 ms}}
  agent: {to_controller: 1 ms, to_host: 1 ms, acknowledgement: 1 ms}
application:
  nodes:
    - name: rover
      publishers: [{topic: odom, message_size: 96 B}]
      timers: [{name: Report, period: 250 ms, execution_time: 1 ms, publishes: [odom]}]
chains: [{name: way, path: [Report, /odom]}]
"""
SUBSCRIPTIONS = """      subscriptions:
        - {name: On_Cmd, topic: cmd, rate: 2 Hz, reliability: best-effort, message_size: 48 B, execution_time: 200 us}
chains:"""


def systems():
    return [describe_text(text).assembly.system for text in (TEXT, TEXT.replace("chains:", SUBSCRIPTIONS))]


@pytest.mark.parametrize("system", systems())
def test_an_iteration_takes_the_timeout_of_its_publication_at_most(system):
    """Besides the timeout of 1 s: a callback of 1 ms, one of 200 us, 50 us of overhead, and what is written meanwhile."""
    (executor,) = analyze_system(system).executors
    assert SECOND + 1050 * MICROSECOND <= executor.round.most < SECOND + 10 * MILLISECOND
    assert all(handle.response.worst is not None for handle in executor.handles)


@pytest.mark.parametrize("system", systems())
def test_no_simulated_value_is_beyond_a_bound(system):
    analysis = analyze_system(system)
    for mode in (SimulationMode.WORST, SimulationMode.SAMPLED):
        simulation = simulate_system(system, Options(duration=Duration(20 * SECOND), mode=mode))
        (executor,) = simulation.executors
        assert executor.handles["Report"].response_time.max > 90 * MILLISECOND, "no loss delayed it"
        for handle in executor.handles:
            response = analysis.executors["main"].handles[handle.name].response
            assert response.best <= handle.response_time.min <= handle.response_time.max <= response.worst


def test_a_chain_over_a_reliable_message_has_no_bound():
    (chain,) = analyze_system(systems()[0]).message_chains
    assert chain.worst is None
    assert "waits until those before it have been sent again" in chain.reason


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("losses: {to_agent: 1 per 10 s}", "loses_messages: true", "how many are lost is not stated"),
        ("1 per 10 s", "1 %", "any number of messages can be lost"),
        ("executor: {", "reliable: {waits: false}\n  executor: {", "not each reliable message is a publication that waits"),
        ("96 B", "2 kB", "in several parts"),
        ("100 Mbit/s, latency: 2 ms", "100 Mbit/s, latency: 600 ms", "how often it is sent again"),
        ("1 per 10 s", "1 per 10 ms", "how often it is sent again"),
    ],
)
def test_without_its_conditions_there_is_no_bound(old, new, why):
    text = TEXT.replace("chains:", SUBSCRIPTIONS)
    assert old in text
    analysis = analyze_system(describe_text(text.replace(old, new)).assembly.system)
    assert all(handle.response.worst is None for handle in analysis.executors["main"].handles)
    assert any(why in reason for reason in analysis.solution.context.reasons.values()) or any(
        why in reason for reason in analysis.solution.reasons.values()
    )
