"""How much the times of a timer of the host vary for what its messages reach, by hand."""

import pytest

from amalthea_uros import analyze
from amalthea_uros.units import MILLISECOND

HOST = """
amuros: 1
name: jitter
hardware: {platform: host}
host:
  ros: jazzy
  computers: [{name: pc, cores: 2}]
  executors:
    - {name: sender, thread: {policy: fifo, priority: 1, core: 0}}
    - {name: receiver, thread: {policy: fifo, priority: 1, core: 1}}
  nodes:
    - name: a
      executor: sender
      timers: [{name: Send, period: 200 ms, execution_time: {min: 5 ms, max: 150 ms}, publishes: [m]}]
    - name: b
      executor: receiver
      subscriptions: [{name: Take, topic: m, execution_time: 10 ms}]
      timers: [{name: Other, period: 1 s, execution_time: 50 ms}]
  topics: [{topic: m, latency: {min: 0 ms, max: LATENCY}}]
"""


@pytest.mark.parametrize(("latency", "before"), [(44, 1), (45, 2)])
def test_messages_come_closer_to_each_other_by_execution_time_and_latency(latency, before):
    """Send ends 5 to 150 ms after it is due, so that messages vary by 145 ms and the latency: two are 200 - 189 = 11 or 10 ms apart.

    Other has to wait for the second message, too, if that comes when the call for the first one ends.
    """
    result = analyze(HOST.replace("LATENCY", f"{latency} ms"))
    assert result.host["receiver"].handles["Other"].response.worst == (before * 10 + 50) * MILLISECOND
    assert result.host["sender"].handles["Send"].lateness.most == 145 * MILLISECOND
