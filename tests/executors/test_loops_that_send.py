"""Loops that send and ping outside of callbacks: what is done in intervals, and how many places may send."""

import pytest

from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.executors.semantics.demand import IterationDemand
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MILLISECOND, SECOND, Duration
from amalthea_uros.uros.described import describe_text

TEXT = """
amuros: 1
name: hand
hardware: {{platform: single-core, frequency: 100 MHz}}
middleware:
  executor: {{name: main, loop: [{{spin_some: 10 ms}}, {items}, {{sleep: 1 ms}}], execution_time: {{base: 50 us}}}}
  transport: {transport}
  agent: {{to_controller: 1 ms, to_host: 1 ms, acknowledgement: 1 ms}}
application:
  nodes:
    - name: rover
      publishers: [{publishers}]
      subscriptions: [{{name: On_Cmd, topic: cmd, rate: 20 Hz, reliability: {reliability}, message_size: 48 B, execution_time: 200 us}}]
"""
LOSSY = "{losses: {to_agent: 1 per 10 s}, udp: {bitrate: 100 Mbit/s, latency: 2 ms}}"


def system(items, transport="{serial: {baud_rate: 115200}}", publishers="", reliability="reliable"):
    text = TEXT.format(items=items, transport=transport, publishers=publishers, reliability=reliability)
    return describe_text(text).assembly.system


def test_a_ping_each_second_leaves_time_for_messages_that_come_faster_than_it_ends():
    """Request and reply take 26 ms on the line, so that a ping in each cycle would be too much for 20 messages/s."""
    model = system("{ping: 100 ms, every: 1 s}")
    bound = analyze_system(model).executors["main"].handles["On_Cmd"].response.worst
    simulation = simulate_system(model, Options(duration=Duration(5 * SECOND), mode=SimulationMode.WORST))
    assert simulation.executors["main"].handles["On_Cmd"].response_time.max <= bound
    assert analyze_system(system("{ping: 100 ms}")).executors["main"].handles["On_Cmd"].response.worst is None


@pytest.mark.parametrize("attempts", [1, 2])
def test_a_ping_takes_its_attempts_at_most_whatever_is_lost(attempts):
    """Each takes 20 ms divided by their number, and 100 ms beyond it."""
    model = system(f"{{ping: 20 ms, attempts: {attempts}, every: 1 s}}", LOSSY, reliability="best-effort")
    bound = analyze_system(model).executors["main_sends"].handles["main_ping"].response.worst
    assert 20 * MILLISECOND + attempts * 100 * MILLISECOND <= bound < 22 * MILLISECOND + attempts * 100 * MILLISECOND
    simulation = simulate_system(model, Options(duration=Duration(5 * SECOND), mode=SimulationMode.WORST))
    seen = simulation.executors["main_sends"].handles["main_ping"].response_time.max
    # Of one loss, the second attempt is not affected.
    assert 100 * MILLISECOND < seen <= bound


def test_demands_are_found_once_whatever_number_of_places_sends(monkeypatch):
    counts = []
    for number in (5, 20):
        items = ", ".join(f"{{publish: [t{each}], every: 2 s}}" for each in range(number))
        publishers = ", ".join(f"{{topic: t{each}, message_size: 8 B}}" for each in range(number))
        model = system(items, "{udp: {bitrate: 100 Mbit/s, latency: 2 ms}}", publishers)
        calls = {"demands": 0, "rates": 0}
        demands, rates = IterationDemand.of, AnalysedTask.demand_rate.func

        def counted(*arguments, calls=calls, demands=demands):
            calls["demands"] += 1
            return demands(*arguments)

        def rate(task, calls=calls, rates=rates):
            calls["rates"] += 1
            return rates(task)

        monkeypatch.setattr(IterationDemand, "of", counted)
        monkeypatch.setattr(AnalysedTask.demand_rate, "func", rate)
        analyze_system(model)
        monkeypatch.undo()
        counts.append(calls)
    few, many = counts
    assert many["demands"] <= few["demands"]
    # Four times as many messages and acknowledgements.
    assert many["rates"] <= 4 * few["rates"]
