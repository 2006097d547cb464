"""Wires have bit rates and not clocks; one with a table of times has none."""

import pytest

import amalthea_uros as amuros
from amalthea_uros.report.wording.cells import load_cells, relief

LOOP = """
amuros: 1
name: one
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {name: E, priority: 1, loop: {spin: 1 s}, execution_time: {base: 10 us}}
  transport: WIRE
application:
  nodes:
    - name: n
      publishers: [{topic: t, message_size: 4 B, reliability: best-effort}]
      timers: [{name: T, period: 10 ms, execution_time: 20 us, publishes: [t]}]
"""


@pytest.mark.parametrize(
    ("wire", "expected"),
    [
        ("{serial: {baud_rate: 460800}}", {"460.8 kbit/s"}),
        ("{udp: {bitrate: 100 Mbit/s, latency: 1 ms}}", {"100 Mbit/s"}),
        ("{custom: {table: [{size: 512 B, time: 1 ms}]}}", {"-"}),
    ],
)
def test_each_wire_has_its_bit_rate(wire, expected):
    analysis = amuros.analyze(LOOP.replace("WIRE", wire))
    network = analysis.solution.context.system.network
    rates = {each.name: load_cells(each, network)[1] for each in analysis.processors}
    assert rates.pop("Core_0") == "100 MHz"
    assert set(rates.values()) == expected


def test_an_overloaded_wire_needs_a_bit_rate():
    text = LOOP.replace("WIRE", "{serial: {baud_rate: 9600}}").replace("message_size: 4 B", "message_size: 40 B")
    overloaded = [each for each in amuros.analyze(text).processors if each.is_overloaded]
    assert overloaded
    assert all("kbit/s as bit rate" in relief(each, is_wire=True) for each in overloaded)
