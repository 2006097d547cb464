"""Losses of a transport: a number in a time, or a probability of each message."""

import pytest

from amalthea_uros.errors import ReadError
from amalthea_uros.perf.network import Direction, Losses
from amalthea_uros.units import MILLISECOND, SECOND
from amalthea_uros.uros.described import describe_text

BOTH, IN, OUT = tuple(Direction), (Direction.TO_CONTROLLER,), (Direction.TO_AGENT,)
TEXT = """
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executor: {loop: {spin_some: 100 ms, sleep: 10 ms}, execution_time: 1 us}
  transport: {serial: {}, losses: LOSSES}
  agent: {to_controller: 1 ms}
application:
  nodes:
    - name: node
      subscriptions: [{name: On_Cmd, topic: cmd, rate: 10 Hz, message_size: 8 B, execution_time: 1 us}]
"""


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("1 per 10 s", [Losses(directions=BOTH, count=1, window=10 * SECOND)]),
        ("20 per 500 ms", [Losses(directions=BOTH, count=20, window=500 * MILLISECOND)]),
        ("0.1 %", [Losses(directions=BOTH, per_billion=1_000_000)]),
        ("{both: 12.5%}", [Losses(directions=BOTH, per_billion=125_000_000)]),
        (
            "{to_agent: 0.1 %, to_controller: 2 per 1 s}",
            [Losses(directions=IN, count=2, window=SECOND), Losses(directions=OUT, per_billion=1_000_000)],
        ),
    ],
)
def test_what_is_stated(text, found):
    (wire,) = describe_text(TEXT.replace("LOSSES", text)).assembly.system.network.wires
    assert (list(wire.losses), wire.loses_messages) == (found, True)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("1", "such as '1 per 10 s'"),
        ("often", "such as '1 per 10 s'"),
        ("1 per 10", "has no unit"),
        ("0 per 10 s", "1 to 1,000 messages"),
        ("1001 per 10 s", "1 to 1,000 messages"),
        ("1 per 0 s", "1 to 1,000 messages"),
        ("0 %", "above 0 %"),
        ("100 %", "below 100 %"),
        ("{}", "state 'both'"),
        ("{both: 1 %, to_agent: 1 %}", "either it or the directions"),
        ("1 %, loses_messages: false", "'loses_messages' is false"),
    ],
)
def test_what_is_wrong(text, problem):
    with pytest.raises(ReadError) as caught:
        describe_text(TEXT.replace("LOSSES", text))
    assert any(problem in finding.message for finding in caught.value.findings)
