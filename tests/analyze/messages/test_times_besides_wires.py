"""What a message triggers behind its wire comes closer together than the message, by how much its time there varies."""

import pytest

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.uros.described import describe_text

TEXT = """
amuros: 1
name: p
hardware: {platform: single-core, frequency: 1 GHz}
os: {tick: 1 ms}
middleware:
  executor: {name: main, loop: {spin_some: 1 ms, sleep: 1 ms}, execution_time: 10 us}
  transport:
    udp: {bitrate: 8 Mbit/s, overhead: 0 B, LATENCYdriver: {read: READ}, interrupt: {name: Receive, execution_time: 1 us}}
  agent: {to_controller: 0 ms, to_host: 0 ms, acknowledgement: {min: 1 ms, max: 2 ms}}
application:
  nodes:
    - name: n
      subscriptions:
        - {name: on_cmd, topic: cmd, interval: 20 ms, message_size: 8 B, execution_time: 100 us, reliability: best-effort}
      publishers: [{topic: odom, message_size: 8 B}]
      guard_conditions: [{name: on_stop, interval: 50 ms, execution_time: 100 us, publishes: [odom]}]
"""


def analysed(latency="latency: {min: 1 ms, max: 4 ms}, ", read="blocking", **changes):
    text = TEXT.replace("LATENCY", latency).replace("READ", read)
    for old, new in changes.items():
        text = text.replace(old, new)
    return analyze_system(describe_text(text).assembly.system)


def distance(process, *latency, read="blocking"):
    return analysed(*latency, read=read)[process].min_interarrival


#: Before, two small messages can be on the wire, of some 40 bytes each.
BLOCKED = 100 * US


def test_interrupts_come_closer_by_how_much_the_latency_varies():
    assert distance("Receive", "latency: 1 ms, ") == pytest.approx(20 * MS, abs=BLOCKED)
    assert distance("Receive") == pytest.approx(17 * MS, abs=BLOCKED)


def test_interrupts_come_closer_by_the_tick_in_which_a_driver_waits():
    assert distance("Receive", read="dma") == pytest.approx(16 * MS, abs=BLOCKED)


def test_nothing_is_known_of_interrupts_after_an_unknown_latency():
    assert distance("Receive", "") is None


@pytest.mark.parametrize(("latency", "least"), [("latency: 1 ms, ", 99 * MS), ("latency: {min: 1 ms, max: 4 ms}, ", 96 * MS)])
def test_acknowledgements_come_closer_by_the_latency_of_what_they_acknowledge(latency, least):
    """The agent takes 1 to 2 ms; heartbeats come every 100 ms."""
    assert distance("heartbeat_of_client_acknowledgement", latency) == pytest.approx(least, abs=BLOCKED)


LATE = "to_controller: {min: 0 ms, max: 1 ms}"


@pytest.mark.parametrize(("published", "known"), [("odom", {"cmd_topic_to_on_cmd"}), ("cmd", set())])
def test_only_messages_that_the_host_publishes_regularly_have_a_longest_distance(published, known):
    """What a guard condition publishes comes back from the agent as rarely as that is triggered."""
    analysis = analysed(odom=published, **{"to_controller: 0 ms": LATE})
    found = {each.name for each in analysis.processes if each.max_interarrival is not None and "UDP" in (each.processor or "")}
    assert found == known


@pytest.mark.parametrize(("timeout", "is_known"), [("2 ms", True), ("30 ms", False)])
def test_interrupts_that_activate_iterations_come_as_close_together_as_these(timeout, is_known):
    """After a wait that is longer than the period, iterations follow each other until the loop has caught up."""
    changes = {
        "spin_some: 1 ms, sleep: 1 ms": f"spin_period: 20 ms, timeout: {timeout}",
        "os: {tick: 1 ms}": "os: {tick: 1 ms, overhead: {activation: 2 us, activations_run_in: interrupt}}",
        "publishes: [odom]": "publishes: []",
    }
    interrupt = analysed(**changes)["main_Activation"]
    assert (interrupt.response is not None) is is_known
    # An iteration can also last longer than the period.
    assert interrupt.max_interarrival is None
