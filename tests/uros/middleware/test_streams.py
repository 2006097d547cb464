"""Reliable messages: how long they keep their senders and the buffers of their stream."""

import pytest

TEXT = """
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz}}
middleware:
  reliable: {{waits: {waits}}}
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


def reported(author, transport="acknowledgement: 20 ms", limits="", size="8 B", reliability="reliable", waits="false"):
    text = TEXT.format(transport=transport, limits=limits, size=size, reliability=reliability, waits=waits)
    return author.reported(text, "UR122", "UR123", "UR124")


def test_reliable_messages_need_an_acknowledgement_time(author):
    expected = "'state' is sent reliably, but the acknowledgement time is not specified"
    assert reported(author, transport="") == [expected]
    assert reported(author, transport="", reliability="best-effort") == []
    assert reported(author) == []


def test_without_an_acknowledgement_time_a_sender_waits_until_the_timeout(author):
    # RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT is 1000 ms by default.
    expected = "'state' is sent reliably, but the acknowledgement time is not specified: it blocks 'Report' for up to 1 s"
    assert reported(author, transport="", waits="true") == [expected]


@pytest.mark.parametrize(
    ("acknowledgement", "limits", "size", "buffers", "history"),
    [
        # One message every 10 ms, one buffer each; by default there are four.
        ("40 ms", "", "8 B", 4, 4),
        ("41 ms", "", "8 B", 5, 4),
        ("41 ms", "RMW_UXRCE_STREAM_HISTORY: 8", "8 B", 5, 8),
        # In buffers of 512 B, fragments carry 500 B, of which the submessage header and the entity need 8 B: 992 B take two.
        ("20 ms", "RMW_UXRCE_MTU: 512 B", "992 B", 4, 4),
        ("20 ms", "RMW_UXRCE_MTU: 512 B", "993 B", 6, 4),
        ("21 ms", "RMW_UXRCE_MTU: 512 B", "992 B", 6, 4),
    ],
)
def test_unacknowledged_messages_fit_into_the_stream_of_a_port_that_does_not_wait(
    author, acknowledgement, limits, size, buffers, history
):
    found = reported(author, transport=f"acknowledgement: {acknowledgement}", limits=limits, size=size)
    message = f"up to {buffers} buffers wait for acknowledgement at the same time, but the reliable stream has only {history}"
    assert found == ([message] if buffers > history else [])


def test_a_sender_that_waits_has_one_message_in_the_stream(author):
    # Whatever the acknowledgement time is; but the model of periodic executors has no time for waiting.
    waiting = "'Report' waits up to 41 ms for acknowledgements, so that its response time is unknown"
    assert reported(author, transport="acknowledgement: 41 ms", waits="true") == [waiting]


@pytest.mark.parametrize(
    # 8 B of headers and 2000 B of fragments of 500 B: as many fragments as buffers up to 1992 B.
    ("size", "steps"),
    [("1992 B", 1), ("1993 B", 2), ("3992 B", 2), ("3993 B", 3)],
)
def test_a_message_of_more_fragments_than_buffers_is_sent_in_steps(author, size, steps):
    *found, waiting = reported(author, size=size, waits="true")
    assert waiting.startswith("'Report' waits up to 20 ms")
    assert [f"it is sent in {steps} steps, and 'Report' waits" in message for message in found] == [True] * (steps > 1)


def test_best_effort_needs_no_acknowledgement(author):
    for waits in ("true", "false"):
        assert reported(author, transport="acknowledgement: 1 s", reliability="best-effort", waits=waits) == []
