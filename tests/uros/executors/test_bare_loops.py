"""Loops without a sleep whose publishers wait for acknowledgements, the default of micro-ROS: bounds, and simulations within them."""

import pytest

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.options import SimulationMode as Mode
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MILLISECOND, SECOND, Duration
from amalthea_uros.uros.described import describe_text

APP = """
amuros: 1
name: bare
hardware: {{platform: rp2040, frequency: 150 MHz}}
os: {{tick: 1 ms}}
middleware:
  executor:
    {{name: executor, priority: 5, loop: {{{loop}}}, callbacks: in-executor, execution_time: {{base: 30 us, per_message: 20 us}}}}
  transport: {{{transport}}}
  agent:
    {{to_controller: {{min: 0.3 ms, max: 1 ms}}, to_host: {{min: 0.3 ms, max: 1 ms}}, acknowledgement: {{min: 0.3 ms, max: {most}}}}}
application:
  nodes:
    - name: n
      publishers: [{{topic: v, message_size: 77 B, reliability: reliable}}{publisher}]
      subscriptions:
        - {{name: cb, topic: r, message_size: 8 B, reliability: reliable, rate: {rate}, execution_time: {{min: 1.2 ms, max: 1.4 ms}},
           publishes: [v]}}
      timers: {timers}
tasks: [{{name: Below, period: 50 ms, priority: 2, execution_time: 1 ms}}]
chains: [{{name: rtt, path: [/r, cb, /v]}}]
"""
USB = "usb_cdc: {latency: {min: 0 ms, max: 1 ms}}"
UDP = "udp: {bitrate: 20 Mbit/s, latency: {min: 0 ms, max: 2 ms}, loses_messages: false}"
TIMER = "[{name: t, period: 100 ms, execution_time: 100 us, publishes: [w]}]"


OTHER = ", {topic: w, message_size: 8 B, reliability: reliable}"


@pytest.fixture
def bare(author):
    def system(loop="spin_some: 100 ms", transport=USB, rate="100 Hz", most="2 ms", timers="[]"):
        publisher = OTHER if timers == TIMER else ""
        text = APP.format(loop=loop, transport=transport, rate=rate, most=most, timers=timers, publisher=publisher)
        return author.describe(text).system

    return system


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"loop": "spin: 100 ms"},
        {"timers": TIMER, "rate": "20 Hz"},
        {"transport": "serial: {baud_rate: 921600}", "rate": "20 Hz", "timers": TIMER},
        {
            "transport": "udp: {bitrate: 20 Mbit/s, latency: {min: 0 ms, max: 2 ms}}",
            "rate": "20 Hz",
            "timers": TIMER,
            "loop": "spin: 1 s",
        },
    ],
    ids=str,
)
def test_a_reliable_publisher_in_a_bare_loop_has_bounds_that_contain_what_is_simulated(change, bare):
    system = bare(**change)
    analysis = analyze_system(system)
    (executor,) = analysis.executors
    for mode in (Mode.WORST, Mode.SAMPLED):
        found = simulate_system(system, Options(duration=Duration(2 * SECOND), mode=mode))
        for handle in found.executors["executor"].handles:
            response = executor.handles[handle.name].response
            assert response.best <= handle.response_time.min <= handle.response_time.max <= response.worst
        for process in found.processes:
            if process.jobs:
                response = analysis.processes[process.name].response
                assert response.best <= process.response_time.min <= process.response_time.max <= response.worst
    assert analysis.chains["rtt"].worst < 2 * SECOND


def test_a_message_that_each_finds_the_loop_waiting_is_not_stored(bare):
    # A cycle with a call takes 7.6 ms, messages come at least 7.9 ms apart: each waits for one cycle at most.
    (handle,) = analyze_system(bare()).executors["executor"].handles
    assert handle.terms[0].name == "running iteration"
    assert handle.response.worst < 16 * MILLISECOND


def test_acknowledgements_that_take_longer_than_the_distance_of_messages_have_no_bound_without_losses(bare):
    # The publication can last 15 ms, so that messages of every 10 ms are stored until there is no room.
    (handle,) = analyze_system(bare(most="15 ms")).executors["executor"].handles
    assert handle.lost is not None
    assert handle.response.worst is None or handle.terms[0].name == "storage"


BACK = """
amuros: 1
name: back
hardware: {platform: rp2040, frequency: 150 MHz}
middleware:
  executor: {name: executor, loop: {spin_some: 100 ms}, callbacks: in-executor, execution_time: 30 us}
  transport: {usb_cdc: {latency: {min: 0 ms, max: 1 ms}}}
  agent: {to_controller: {min: 0 ms, max: 1 ms}, to_host: {min: 0 ms, max: 1 ms}, acknowledgement: {min: 0 ms, max: 2 ms}}
application:
  nodes:
    - name: n
      publishers: [{topic: v, message_size: 8 B, reliability: reliable}]
      subscriptions:
        - {name: own, topic: OWN, message_size: 8 B, rate: 20 Hz, execution_time: 100 us}
        - {name: rare, topic: r, message_size: 8 B, rate: 2 Hz, execution_time: 1 ms, publishes: [v]}
"""


def test_a_message_that_comes_back_does_not_end_waits_for_certain(author):
    # What `own` receives is published by `rare`, whose messages come every 500 ms, not every 50 ms: it ends no wait before its timeout.
    def rare(topic):
        handle = analyze_system(author.describe(BACK.replace("OWN", topic)).system).executors["executor"].handles["rare"]
        return handle.response.worst

    assert rare("other") < 100 * MILLISECOND < rare("v")


def test_a_loop_that_never_sleeps_loads_its_core_fully_and_starves_what_is_below():
    """With timers only its waits return at once; what is above it is not affected."""
    text = """
amuros: 1
name: busy
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {name: main, priority: 5, loop: {spin_some: 10 ms}, execution_time: {base: 50 us}}
application: {nodes: [{name: n, timers: [{name: t, period: 250 ms, execution_time: 1 ms}]}]}
tasks:
  - {name: Above, priority: 9, period: 10 ms, execution_time: 1 ms}
  - {name: Below, priority: 1, period: 10 ms, execution_time: 1 ms}
"""
    analysis = analyze_system(describe_text(text).assembly.system)
    assert analysis.processors["Core_0"].worst == 1
    assert analysis.processes["Above"].response.worst == MILLISECOND
    assert analysis.processes["Below"].response is None
