"""Classic CAN controllers of a robot: what is missing for latencies of their messages is named, with where to state it."""

import pytest

import amalthea_uros as amuros
from amalthea_uros.units import MILLISECOND
from amalthea_uros.uros.described import describe_text

ROBOT = """
amuros: 1
name: robot
controllers:
  - name: a
    hardware: &hardware {platform: single-core, frequency: 100 MHz}
    middleware: &middleware
      executor: {name: E, period: 1 ms, execution_time: {base: 12 us, per_message: 13 us}}
      transport: {can: {bitrate: 250 kbit/s}}
      task_periods: [1 ms, 10 ms]
    application:
      nodes:
        - name: n
          publishers: [{topic: speed, message_size: 4 B, reliability: best-effort}]
          timers: [{name: Send, period: 10 ms, execution_time: 4 us, publishes: [speed]}]
  - name: b
    hardware: *hardware
    middleware: *middleware
    application:
      nodes:
        - name: n
          subscriptions:
            - {name: Receive, topic: speed, rate: 100 Hz, message_size: 4 B, reliability: best-effort, execution_time: 2 us}
host:
  ros: humble
  computers: [{name: pc}]
  latency: 2 ms
  executors: [{name: X, computer: pc, type: single-threaded, thread: {policy: fifo, priority: 10, core: 0}}]
  nodes: [{name: h, executor: X, subscriptions: [{name: Show, topic: speed, execution_time: 1 ms}]}]
chains:
  - {name: between, path: [a_Send, /speed, b_Receive], reaction: 100 ms}
  - {name: shown, path: [a_Send, /speed, Show], reaction: 100 ms}
"""
WITHOUT_TRANSPORT = ROBOT.replace("      transport: {can: {bitrate: 250 kbit/s}}\n", "")
#: In which nothing described sends to a controller.
SENDING_ONLY = WITHOUT_TRANSPORT.replace("Receive, topic: speed", "Receive, topic: wish").replace("/speed, b_Receive", "/speed")


def messages(result):
    return str([each.message for each in result.findings])


def test_the_buses_are_a_part_of_the_system():
    assert [wire.name for wire in describe_text(ROBOT).assembly.system.network.wires] == ["a_CAN", "b_CAN"]


def test_the_bus_of_a_single_controller_is_one_if_there_is_a_host():
    before, _, rest = ROBOT.partition("controllers:\n")
    first = rest.partition("  - name: b")[0].replace("  - name: a\n", "").replace("\n    ", "\n").removeprefix("    ")
    text = f"{before}{first}host{ROBOT.partition('host')[2].partition('chains')[0]}"
    assert [wire.name for wire in describe_text(text).assembly.system.network.wires] == ["CAN"]


def test_the_time_of_the_agent_is_missing():
    analysis = amuros.analyze(ROBOT)
    assert all("'to_host' of the agent is not stated" in chain.reason for chain in analysis.chains)
    assert "publishes 'speed'" not in messages(analysis)


def test_with_it_the_chain_to_the_host_has_a_bound():
    text = ROBOT.replace("      task_periods", "      agent: {to_controller: 1 ms, to_host: 1 ms}\n      task_periods")
    bound, seen = amuros.analyze(text).chains["shown"], amuros.simulate(text, "1 s")
    assert bound.worst < 20 * MILLISECOND
    assert "'b_Receive' takes 'speed' outside of an executor with a loop" in messages(seen)


@pytest.mark.parametrize("run", [amuros.analyze, lambda text: amuros.simulate(text, "1 s")], ids=["analyze", "simulate"])
def test_without_a_transport_this_is_missing(run):
    said = messages(run(SENDING_ONLY))
    assert "no transport is described for 'a_Send'" in said
    assert "no wire is described for 'speed_sent_by_a_Send'" in said
    assert "neither a callback of the host nor a controller with a 'transport' publishes 'speed'" in said
    assert "no activity" not in said


def test_without_a_transport_nothing_is_known_of_what_controllers_send_each_other():
    with pytest.raises(amuros.ReadError, match="'b_Receive' receives 'speed', which is published here, too, but no wire"):
        describe_text(WITHOUT_TRANSPORT)


def test_a_bus_is_one_if_its_controller_receives_what_it_publishes():
    _, _, rest = ROBOT.partition("controllers:\n")
    first = rest.partition("  - name: b")[0].replace("  - name: a\n", "").replace("\n    ", "\n").removeprefix("    ")
    text = f"amuros: 1\nname: own\n{first}"
    own = "subscriptions: [{name: Own, topic: /speed, rate: 100 Hz, message_size: 4 B, execution_time: 2 us}]\n"
    assert not describe_text(text).assembly.system.network.wires
    (wire,) = describe_text(text.replace("      publishers:", f"      {own}      publishers:")).assembly.system.network.wires
    assert wire.name == "CAN"
