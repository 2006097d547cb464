"""Bounds of reliable messages to the controller on wires that lose a stated number: see docs/proofs/missing-messages.md."""

import pytest

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MILLISECOND, SECOND, Duration
from amalthea_uros.uros.described import describe_text

TEXT = """
amuros: 1
name: hand
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {name: main, loop: {spin_some: 10 ms, sleep: 1 ms}, execution_time: {base: 50 us}}
  transport: {losses: {to_controller: 1 per 5 s}, udp: {bitrate: 100 Mbit/s, latency: 2 ms}}
  agent: {to_controller: 1 ms, to_host: 1 ms, acknowledgement: 1 ms}
application:
  nodes:
    - name: rover
      subscriptions: [{name: On_Cmd, topic: cmd, interval: 50 ms, reliability: reliable, message_size: 48 B, execution_time: 200 us}]
chains: [{name: way, path: [/cmd, On_Cmd]}]
"""
PUBLISHING = (
    "execution_time: 200 us}]",
    "execution_time: 200 us, publishes: [out]}]\n      publishers: [{topic: out, message_size: 8 B}]",
)
SLOTS = ("agent:", "limits: {RMW_UXRCE_MAX_HISTORY: 10}\n  agent:")


def analysed(*changes):
    text = TEXT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return analyze_system(describe_text(text).assembly.system)


def wait(analysis):
    """The time for which a message waits for a missing one, the second hop on the wire after that of its latency."""
    (chain,) = analysis.message_chains
    return [hop.worst for hop in chain.hops if "attempts to send it again" in hop.source]


def test_a_message_waits_for_an_attempt_per_loss():
    """The next message comes 50 ms later, and takes 2 ms; its answer takes 2 ms, the agent 1 ms. Besides: reading, up to two cycles."""
    (once,) = wait(analysed())
    assert 55 * MILLISECOND < once < 85 * MILLISECOND


def test_a_message_of_a_rare_topic_is_found_with_a_heartbeat():
    """The agent sends one every 200 ms."""
    (rare,) = wait(analysed(("interval: 50 ms", "interval: 1 s")))
    assert 205 * MILLISECOND < rare < 235 * MILLISECOND
    (twice,) = wait(analysed(("interval: 50 ms", "interval: 1 s"), ("1 per 5 s", "2 per 20 s")))
    assert twice > rare + 200 * MILLISECOND


def test_answers_alone_can_be_lost_without_a_wait():
    assert wait(analysed(("losses: {to_controller", "losses: {to_agent"))) == [0]


@pytest.mark.parametrize("changes", [(), (PUBLISHING, SLOTS, ("50 ms", "2 s"))], ids=["received", "both-directions"])
@pytest.mark.parametrize("mode", [SimulationMode.WORST, SimulationMode.SAMPLED])
def test_no_simulated_value_is_beyond_a_bound(changes, mode):
    analysis = analysed(*changes)
    simulation = simulate_system(analysis.solution.context.system, Options(duration=Duration(20 * SECOND), mode=mode))
    (handle,), bound = simulation.executors["main"].handles, analysis.executors["main"].handles["On_Cmd"].response
    assert handle.response_time.max <= bound.worst
    reaction, (chain,) = simulation.chains["way"].quantities[ChainQuantity.REDUCED_REACTION_TIME], analysis.message_chains
    assert reaction.max <= chain.worst
    if mode is SimulationMode.WORST:
        assert reaction.max > 50 * MILLISECOND, "the first message is lost, and found with the next one at the earliest"


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ((("losses: {to_controller: 1 per 5 s}", "loses_messages: true"),), "how many are lost is not stated"),
        ((("1 per 5 s", "1 %"),), "any number of messages can be lost"),
        ((("1 per 5 s", "1 per 100 ms"),), "after each of them it can take"),
        ((("interval: 50 ms", "interval: 20 ms, jitter: 19 ms"),), "and the client keeps 4"),
        ((("latency: 2 ms", "latency: 300 ms"),), "and the client keeps 4"),
        ((("48 B", "1 kB"),), "in several parts"),
        ((("to_controller: 1 ms, ", ""),), "'to_controller' of the agent is not stated"),
    ],
)
def test_without_its_conditions_there_is_no_bound(changes, why):
    analysis = analysed(*changes)
    (chain,) = analysis.message_chains
    assert chain.worst is None
    reasons = (*analysis.solution.context.reasons.values(), *analysis.solution.reasons.values(), chain.reason)
    assert any(why in reason for reason in reasons), reasons


READING = """
      timers: [{name: Drive, period: 20 ms, execution_time: 10 us, writes: [data]}]
labels: {data: 4 B}
chains: [{name: way, path: [Drive, data, On_Cmd]}]
"""


@pytest.mark.parametrize(("reliability", "is_bounded"), [("reliable", True), ("best-effort", False)])
def test_data_wait_for_the_next_message_only_if_it_comes_for_certain(reliability, is_bounded):
    """A callback for a message reads what a timer has written; a best-effort message is gone if it is lost."""
    chains = TEXT[TEXT.index("chains:") :]
    reading = ("execution_time: 200 us", "execution_time: 200 us, reads: [data]")
    (chain,) = analysed((chains, READING), ("reliability: reliable", f"reliability: {reliability}"), reading).message_chains
    assert (chain.worst is not None) == is_bounded
