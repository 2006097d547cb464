"""Reliable streams: messages occupy the buffers of the stream until they are acknowledged."""

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


def reported(author, transport="acknowledgement: 20 ms", limits="", size="8 B", reliability="reliable"):
    assembly = author.describe(TEXT.format(transport=transport, limits=limits, size=size, reliability=reliability))
    return [(finding.rule, finding.message) for finding in assembly.findings if finding.rule in ("UR122", "UR123")]


def test_reliable_messages_need_an_acknowledgement_time(author):
    expected = "'state' is sent reliably, but the acknowledgement time is not specified"
    assert reported(author, transport="") == [("UR122", expected)]
    assert reported(author, transport="", reliability="best-effort") == []
    assert reported(author) == []


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
def test_unacknowledged_messages_fit_into_the_stream(author, acknowledgement, limits, size, buffers, history):
    found = reported(author, transport=f"acknowledgement: {acknowledgement}", limits=limits, size=size)
    message = f"up to {buffers} buffers wait for acknowledgement at the same time, but the reliable stream has only {history}"
    assert found == ([("UR123", message)] if buffers > history else [])


def test_best_effort_needs_no_acknowledgement(author):
    assert reported(author, transport="acknowledgement: 1 s", reliability="best-effort") == []
