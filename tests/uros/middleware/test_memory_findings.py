"""Build options in a description that are too small, that the build refuses, or that have no effect."""

import pytest

from amalthea_uros.errors import ReadError

APP = """
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz{hardware}}}
middleware:
  executor: {{period: 1 ms, stack: 4 kB}}
  transport: {{serial: {{}}}}
  limits: {{{limits}}}
application:
  nodes:
    - name: node
      subscriptions:
        - {{name: A, topic: {topic}, message_size: 4 B, interval: 10 ms, execution_time: 2 us}}
        - {{name: B, topic: b, message_size: 4 B, interval: 10 ms, execution_time: 2 us}}
"""


def found(author, limits="", topic="a", hardware=""):
    text = APP.format(limits=limits, topic=topic, hardware=hardware)
    try:
        findings = author.describe(text).findings
    except ReadError as error:
        findings = error.findings
    ours = ("UR120", "UR126", "UR127", "UR128", "UR129")
    return [(each.rule, each.severity.value, each.location.line) for each in findings if each.rule in ours]


@pytest.mark.parametrize(
    ("limits", "expected"),
    [
        ("RMW_UXRCE_MAX_SUBSCRIPTIONS: 1", [("UR120", "error", 7)]),
        ("RMW_UXRCE_MAX_TOPICS: 1", [("UR120", "error", 7)]),
        ("RMW_UXRCE_MAX_WAIT_SETS: 0", [("UR120", "error", 7)]),
        # A message that finds no slot is lost, but the application runs.
        ("RMW_UXRCE_MAX_HISTORY: 1", [("UR120", "warning", 7)]),
        ("RMW_UXRCE_STREAM_HISTORY: 3", [("UR126", "warning", 7)]),
        ("RMW_UXRCE_STREAM_HISTORY: 1", []),
        ("RMW_UXRCE_STREAM_HISTORY_INPUT: 4", [("UR128", "warning", 7)]),
        ("RMW_UXRCE_STREAM_HISTORY_OUTPUT: 4", [("UR128", "warning", 7)]),
        ("RMW_UXRCE_STREAM_HISTORY_INPUT: 4, RMW_UXRCE_STREAM_HISTORY_OUTPUT: 8", []),
        ("RMW_UXRCE_STREAM_HISTORY_INPUT: 4, RMW_UXRCE_STREAM_HISTORY_OUTPUT: 6", [("UR126", "warning", 7)]),
        ("UCLIENT_UDP_TRANSPORT_MTU: 1 kB", [("UR128", "warning", 7)]),
        ("UCLIENT_CUSTOM_TRANSPORT_MTU: 1 kB", []),
        ("RMW_UXRCE_XML_BUFFER_LENGTH: 400", [("UR128", "warning", 7)]),
        ("RMW_UXRCE_NODE_NAME_MAX_LENGTH: 4", [("UR127", "error", 7)]),
        ("RMW_UXRCE_NODE_NAME_MAX_LENGTH: 5", []),
    ],
)
def test_a_build_option(author, limits, expected):
    assert found(author, limits) == expected


def test_a_name_that_is_too_long_by_default(author):
    # 60 characters, of which the slash and the terminator are two.
    assert found(author, topic="t" * 58) == []
    assert found(author, topic="t" * 59) == [("UR127", "warning", 7)]


def test_more_memory_than_there_is(author):
    # 5552 B + 8 * 2112 B + 4448 B of the middleware, and 4000 B of stack; the tasks of A and B have stacks of unknown size.
    assert found(author, hardware=", memories: [{name: RAM, kind: SRAM, size: 30896 B}]") == []
    assert found(author, hardware=", memories: [{name: RAM, kind: SRAM, size: 30895 B}]") == [("UR129", "warning", 3)]
    assert found(author, hardware=", memories: [{name: ROM, kind: flash, size: 1 kB}]") == []
    enough = "memories: [{name: RAM, kind: SRAM, size: 1 MB}]"
    assert found(author, hardware=f", {enough}, ram_budget: 30895 B") == [("UR129", "warning", 3)]


def test_the_memory_says_what_is_not_known(author):
    memory = author.describe(APP.format(limits="", topic="a", hardware="")).memory
    assert (memory.total, memory.stacks.unknown) == (5552 + 8 * 2112 + 4448 + 4000, ("A", "B"))
    assert not memory.is_complete
