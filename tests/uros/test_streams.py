"""Reliable streams: messages under way until they are acknowledged, against the buffers of the stream."""

import pytest

TEXT = """
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz}}
middleware:
  transport: {{{transport}}}
  limits: {{{limits}}}
application:
  nodes:
    - name: node
      publishers:
        - {{topic: state, message_size: {size}, reliability: {reliability}}}
      timers:
        - {{name: Report, period: 10 ms, execution_time: 4 us, publishes: [state]}}
"""


def told(author, transport="acknowledgement: 20 ms", limits="", size="8 B", reliability="reliable"):
    assembly = author.describe(TEXT.format(transport=transport, limits=limits, size=size, reliability=reliability))
    return [(finding.rule, finding.message) for finding in assembly.findings if finding.rule in ("UR122", "UR123")]


def test_reliable_messages_need_a_time_of_acknowledgement(author):
    expected = "'state' is sent reliably, and it is not stated how long the acknowledgement takes"
    assert told(author, transport="") == [("UR122", expected)]
    assert told(author, transport="", reliability="best-effort") == []
    assert told(author) == []


@pytest.mark.parametrize(
    ("acknowledgement", "limits", "size", "buffers", "history"),
    [
        # One message every 10 ms, one buffer each; by default there are four.
        ("40 ms", "", "8 B", 4, 4),
        ("41 ms", "", "8 B", 5, 4),
        ("41 ms", "RMW_UXRCE_STREAM_HISTORY: 5", "8 B", 5, 5),
        # 1000 B and 12 B of headers take two buffers of 512 B.
        ("20 ms", "RMW_UXRCE_MTU: 512 B", "1000 B", 4, 4),
        ("21 ms", "RMW_UXRCE_MTU: 512 B", "1000 B", 6, 4),
    ],
)
def test_messages_under_way_fit_into_the_stream(author, acknowledgement, limits, size, buffers, history):
    found = told(author, transport=f"acknowledgement: {acknowledgement}", limits=limits, size=size)
    message = f"up to {buffers} buffers wait for their acknowledgement at a time, and the reliable stream has {history}"
    assert found == ([("UR123", message)] if buffers > history else [])


def test_best_effort_waits_for_nothing(author):
    assert told(author, transport="acknowledgement: 1 s", reliability="best-effort") == []
