"""The ping times of the micro-ROS benchmark on an RA6M5 against computed times on the wire.

Published: the mean times of an Int64 ping in ms (eProsima/vulcanexus `docs/rst/microros_documentation/benchmarking/`). Computed:
the shortest time of the message on the wire, and of the acknowledgement that answers it. The benchmark gives no time of the agent or
of the client alone. One pair of them is fitted here, to the row of UDP, in which the wire takes almost nothing: what is left of it in
each direction is software. With this pair,

- the round trip over UART is predicted within 10 %, if each of the two messages also waits for an acknowledgement on the wire;
- its two directions are not (the published one of the client is shorter than such a wait, the one of the agent longer);
- the round trip over CAN FD is predicted within 10 %, if each of the two messages also takes the time per message that the throughput
  published for the same board and wire shows: 1.0 to 1.4 ms for any length, of which less than a third is on the wire. The rest is
  not computed, as nothing published says which part of the driver or the agent takes it;
- USB and the TCP module are not: the time that the host polls, and that of the module, are published nowhere.

In these three rows, no published time is shorter than the computed wire. The throughput of best-effort messages over UART, as it can be
read off the published plots, is that of the computed frames within 3 %.
"""

from dataclasses import dataclass

import pytest

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.executors.results import HopKind
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.uros.described import describe_text


@dataclass(frozen=True)
class Row:
    """Published mean times in ms: the client publishes, the agent publishes, the round trip."""

    transport: str
    client: float
    agent: float
    round_trip: float


UDP = Row("udp: {bitrate: 100 Mbit/s, latency: 0 s}", 0.52, 0.70, 1.22)
UART = Row("serial: {baud_rate: 115200}", 3.77, 5.04, 8.81)
#: Best-effort messages over UART and CAN FD, read off plots: kB/s by the length of a string.
UART_THROUGHPUT = {10: 3.3, 100: 9.3, 400: 11}
CAN_FD_THROUGHPUT = {10: 7, 20: 19, 40: 31}
CAN_FD = Row("can_fd: {bitrate: 500 kbit/s, data_bitrate: 2 Mbit/s}", 1.29, 2.41, 3.70)

APPLICATION = """
amuros: 1
name: ping
hardware: {{platform: single-core, frequency: 200 MHz}}
middleware:
  executor: {{loop: {{spin_some: 1 ms}}, execution_time: 10 us}}
  transport: {{{transport}}}
application:
  nodes:
    - name: node
      subscriptions:
        - {{name: on_ping, topic: ping, interval: 1 s, message_size: 8 B, execution_time: 10 us, publishes: [pong]}}
      publishers: [{{topic: pong, message_size: 8 B}}]
chains:
  - {{name: ping, path: [/ping, on_ping, /pong]}}
"""


def analysis(text):
    return analyze_system(describe_text(text).assembly.system)


def shortest_of_string(transport, length):
    """The shortest time in ms on the wire of a best-effort message with a string: its length, its characters and a terminator."""
    text = APPLICATION.format(transport=transport).replace(
        "{topic: pong, message_size: 8 B}", f"{{topic: pong, message_size: {4 + length + 1} B, reliability: best-effort}}"
    )
    return analysis(text).solution.bcet("pong_topic_from_on_ping") / MS


def wires(row):
    """The shortest times in ms on a wire: of the ping, of the pong, and of an acknowledgement."""
    found = analysis(APPLICATION.format(transport=row.transport))
    there, back = (hop.best / MS for hop in found.chains["ping"].hops if hop.kind is HopKind.WIRE)
    solution = found.solution
    answer = min(solution.bcet(name) for name in solution.context.system.transmissions if name.endswith("acknowledgement"))
    return there, back, answer / MS


@pytest.mark.parametrize("row", [UDP, UART, CAN_FD], ids=["UDP", "UART", "CAN FD"])
def test_no_published_time_is_shorter_than_the_wire(row):
    there, back, _ = wires(row)
    assert back < row.client
    assert there < row.agent
    assert there + back < row.round_trip


def test_the_wire_of_the_serial_line_is_what_its_bytes_take():
    # 12 + 8 bytes, 7 of the frame, 10 bits each; the acknowledgement has 13 + 7 bytes.
    assert wires(UART) == pytest.approx((27 * 10 / 115.2, 27 * 10 / 115.2, 20 * 10 / 115.2), abs=1e-6)


def test_software_fitted_to_udp_and_two_acknowledgements_predict_the_round_trip_over_uart():
    of_udp, of_uart = wires(UDP), wires(UART)
    client, agent = UDP.client - of_udp[1], UDP.agent - of_udp[0]
    assert of_udp[0] + of_udp[1] < 0.02 * UDP.round_trip
    predicted = client + agent + sum(of_uart) + of_uart[2]
    assert predicted == pytest.approx(UART.round_trip, rel=0.10)


def test_software_fitted_to_udp_and_the_published_time_per_message_predict_the_round_trip_over_can_fd():
    per_message = [length / rate for length, rate in CAN_FD_THROUGHPUT.items()]
    assert (min(per_message), max(per_message)) == pytest.approx((1.05, 1.43), abs=0.005)
    for length, rate in CAN_FD_THROUGHPUT.items():
        assert shortest_of_string(CAN_FD.transport, length) < length / rate / 3
    software = UDP.round_trip - sum(wires(UDP)[:2])
    assert software + 2 * min(per_message) < CAN_FD.round_trip < software + 2 * max(per_message)
    assert software + 2 * sum(per_message) / 3 == pytest.approx(CAN_FD.round_trip, rel=0.10)


@pytest.mark.parametrize("length", UART_THROUGHPUT)
def test_the_throughput_over_uart_is_that_of_the_frames(length):
    # kB/s are bytes per ms.
    assert length / shortest_of_string(UART.transport, length) == pytest.approx(UART_THROUGHPUT[length], rel=0.03)
