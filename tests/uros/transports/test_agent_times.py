"""Times in the agent of which only the mean is known: simulations take it for each message, and no bound follows from it."""

import pytest

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.bridge.build import build_model
from amalthea_uros.bridge.extract import extract
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import SECOND, Duration

TEXT = """
amuros: 1
name: app
hardware: {{frequency: 100 MHz}}
middleware:
  executor: {{name: Exec, loop: {{spin_some: 100 ms}}, execution_time: 1 us}}
  transport: {{udp: {{bitrate: 100 Mbit/s, latency: 0 ms}}}}
  agent: {{{agent}}}
application:
  nodes:
    - name: node
      publishers: [{{topic: pong, message_size: 8 B, reliability: best-effort}}]
      subscriptions:
        - {{name: Echo, topic: ping, message_size: 8 B, reliability: best-effort, rate: 10 Hz, execution_time: 1 us, publishes: [pong]}}
chains: [{{name: trip, path: [/ping, Echo, /pong], reaction: 10 ms}}]
"""
#: 20 B of XRCE-DDS, 28 B of headers and 38 B of Ethernet at 100 Mbit/s, there and back; a microsecond in executor and callback each.
#: The executor can have filled its wait set before a message comes, so that the best case is without its microsecond.
LEAST = 2 * 86 * 8 * 10_000 + 2 * US


def trip(system):
    return analyze_system(system).chains["trip"]


def simulated(system):
    return (
        simulate_system(system, Options(duration=Duration(SECOND)))
        .chains["trip"]
        .quantities[ChainQuantity.REDUCED_REACTION_TIME]
    )


@pytest.mark.parametrize(
    ("agent", "unknown"),
    [
        ("to_controller: {mean: 300 us}, to_host: {mean: 500 us}", "to_controller"),
        ("to_controller: 300 us, to_host: {mean: 500 us}", "to_host"),
        ("to_controller: {mean: 300 us}, to_host: 500 us", "to_controller"),
    ],
)
def test_a_mean_is_simulated_and_gives_no_bound(agent, unknown, author):
    system = author.describe(TEXT.format(agent=agent)).system
    found = trip(system)
    assert found.worst is None
    assert f"only the mean of '{unknown}' of the agent is known" in found.reason
    # What is stated counts; of what has a mean, nothing is known.
    stated = sum(time for key, time in (("to_controller: 300", 300), ("to_host: 500", 500)) if key in agent)
    assert found.best == LEAST - US + stated * US
    assert simulated(system).mean == LEAST + 800 * US


def test_a_known_minimum_counts_for_the_best_case(author):
    system = author.describe(TEXT.format(agent="to_controller: 0 ms, to_host: {min: 200 us, mean: 500 us}")).system
    assert trip(system).best == LEAST - US + 200 * US


def test_assumptions_about_times_survive_a_model_and_are_those_of_each_result(author):
    system = author.describe(TEXT.format(agent="profile: ra6m5-udp")).system
    (sentence,) = system.network.assumptions
    again = extract(build_model(system)).system
    assert again.network == system.network
    assert sentence in analyze_system(again).assumptions
    assert sentence in simulate_system(again, Options(duration=Duration(SECOND))).assumptions
    assert (
        "where only the mean of a time in the agent is known, every message takes it"
        in simulate_system(again, Options(duration=Duration(SECOND))).assumptions
    )


@pytest.mark.parametrize(
    ("time", "message"),
    [
        ("{min: 1 ms}", "expected either 'max' or, if it is unknown, 'mean'"),
        ("{max: 2 ms, mean: 1 ms}", "expected either 'max' or, if it is unknown, 'mean'"),
        ("{min: 2 ms, mean: 1 ms}", "'min' is greater than 'mean'"),
        ("{min: 2 ms, max: 1 ms}", "'min' is greater than 'max'"),
    ],
)
def test_wrong_times(time, message, author):
    ((line, rule, text),) = author.findings(TEXT.format(agent=f"to_host: {time}"))
    assert (line, rule) == (7, "YML012")
    assert message in text


def test_a_sender_waits_for_an_acknowledgement_as_long_as_the_mean(author):
    def calls(time):
        text = TEXT.replace("topic: pong, message_size: 8 B, reliability: best-effort", "topic: pong, message_size: 8 B")
        agent = f"to_controller: 0 ms, to_host: 0 ms, acknowledgement: {time}"
        system = author.describe(text.format(agent=agent)).system
        (executor,) = simulate_system(system, Options(duration=Duration(SECOND))).executors
        return executor.handles["Echo"].response_time

    assert calls("{mean: 3 ms}") == calls("3 ms")
    assert calls("{mean: 3 ms}").max > calls("1 ms").max
