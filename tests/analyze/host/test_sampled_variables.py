"""Variables of the host that a subscription reads: from the write to the end of the next call, by hand."""

import pytest

from amalthea_uros import analyze
from amalthea_uros.units import MILLISECOND

HOST = """
amuros: 1
name: sampled
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
      timers:
        - {name: Write, period: 70 ms, execution_time: 5 ms, writes: [pose]}
        - {name: Tick, period: 50 ms, execution_time: {min: 1 ms, max: 2 ms}, publishes: [m]}
    - name: b
      executor: receiver
      subscriptions:
        - {name: Read, topic: m, execution_time: 10 ms, reads: [pose], publishes: [n]}
        - {name: Use, topic: n, execution_time: 20 ms}
  topics: [{topic: m, latency: {min: 1 ms, max: 4 ms}}, {topic: n, latency: 0 ms}]
chains:
  - {name: used, path: [Write, Read, Use], reaction: 200 ms}
"""


def test_a_subscription_reads_at_the_next_message_of_its_timer():
    """Write waits for Tick of 2. Tick can be called just before Write ends; 50 later, it waits for Write, and takes 2 again.

    Its message arrives after 4; then Read and Use take 10 and 20, if nothing else is pending.
    """
    chain = analyze(HOST).chains["used"]
    assert [hop.worst for hop in chain.hops] == [(2 + 5) * MILLISECOND, (50 + 5 + 2 + 4 + 10 + 20) * MILLISECOND]


RELAY = "{name: Relay, topic: m, depth: 1, execution_time: 1 ms, publishes: [k]}\n        - {name: Read, topic: k,"


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({", publishes: [m]}": "}"}, "publishes 'm'"),
        (
            {", publishes: [m]}": "}", "[{topic: m,": "[{topic: m, rate: 20 Hz,"},
            "between two messages of 'Read' has no maximum",
        ),
        (
            {"{name: Read, topic: m,": RELAY, "max: 4 ms}}": "max: 90 ms}}, {topic: k, latency: 0 ms}"},
            "messages of 'Relay' can be lost",
        ),
    ],
)
def test_it_is_unknown_when_it_reads_if_no_timer_is_sure_to_wake_it(changes, reason):
    text = HOST
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    chain = analyze(text).chains["used"]
    assert chain.worst is None
    assert reason in chain.reason
