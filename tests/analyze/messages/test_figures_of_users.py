"""Figures that users of micro-ROS measured or that follow from the protocol, from the description to the result.

The cited issues belong to micro-ROS on GitHub.
"""

import pytest

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import SECOND
from amalthea_uros.uros.described import describe_text

APP = """
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz}}
middleware:
  executor: {{loop: {loop}}}
  transport: {{serial: {{baud_rate: {baud_rate}}}}}
  agent: {{to_controller: 1 ms, to_host: 1 ms, acknowledgement: {{min: 0 s, max: 2 ms}}}}
application:
  nodes:
    - name: node
      publishers: [{{topic: out, message_size: {size} B, reliability: {reliability}}}]
      subscriptions:
        - {{name: On_In, topic: in, interval: {interval}, message_size: 4 B, reliability: best-effort, execution_time: 1 us}}
      timers: [{{name: Report, period: {period}, execution_time: 1 us, publishes: [out]}}]
"""


def analysis(
    loop="{spin_some: 100 ms, sleep: 10 ms}", baud_rate=115200, size=4, reliability="best-effort", interval="10 s", period="5 s"
):
    text = APP.format(loop=loop, baud_rate=baud_rate, size=size, reliability=reliability, interval=interval, period=period)
    return analyze_system(describe_text(text).assembly.system)


def messages(found, rule):
    return [finding.message for finding in found.findings if finding.rule == rule]


@pytest.mark.parametrize(("baud_rate", "least"), [(115200, 3.73), (921600, 0.47)])
def test_a_reliable_int32_takes_the_time_of_its_frame_and_of_the_acknowledgement(baud_rate, least):
    # 23 B and 20 B, 10 bits each; the execution adds 1 us.
    report = analysis(baud_rate=baud_rate, reliability="reliable").executors[0].handles["Report"]
    assert report.response.best / MS == pytest.approx(43 * 10_000 / baud_rate + 0.001, abs=1e-6)
    assert round(report.response.best / MS, 2) == least
    # Of which the agent takes up to 2 ms, each byte but the flags can be escaped, and publish is called in the round.
    publish = next(term for term in report.terms if term.name == "publish")
    assert publish.most > least * MS + 2 * MS


def test_an_imu_at_115200_baud_is_sent_34_times_per_second():
    # micro_ros_arduino#1781.
    solution = analysis(size=312, period="100 ms").solution
    assert SECOND // solution.bcet("out_topic_from_Report") == 34


@pytest.mark.parametrize(("interval", "is_overload"), [("99 ms", True), ("101 ms", False)])
def test_a_loop_with_delay_100_receives_10_messages_per_second(interval, is_overload):
    # micro_ros_arduino#1660: messages above 10 Hz get older and older.
    found = analysis(loop="{spin_some: 100 ms, sleep: 100 ms}", interval=interval)
    assert bool(messages(found, "EXE012")) is is_overload


def test_a_loop_with_delay_100_publishes_10_times_per_second():
    found = analysis(loop="{spin_some: 100 ms, sleep: 100 ms}", period="50 ms")
    (message,) = messages(found, "EXE010")
    # It is due at 0, and checked again after 100 ms and a round: 50 ms and 100 ms are lost.
    assert message.startswith("'Report' loses periods: ")
    assert "what was due until then at 50 ms, 100 ms is lost, the next call is due at 150 ms" in message


@pytest.mark.parametrize("sleep", [10, 100])
def test_a_timer_is_late_by_the_sleep_and_a_round(sleep):
    lateness = analysis(loop=f"{{spin_some: 100 ms, sleep: {sleep} ms}}").executors[0].handles["Report"].lateness
    # Two rounds of 1 us and of one message of 23 B, each byte of which but one can be escaped: 45 * 10 bits.
    assert sleep * MS <= lateness.most <= sleep * MS + 2 * (450 * SECOND // 115200 + 2 * MS // 1000)
