"""What applications ask too much of their middleware: messages, histories, and threads that wait for each other."""

import pytest

from amalthea_uros.units import MILLISECOND, SECOND

TEXT = """
amuros: 1
name: app
hardware: {{platform: generic, frequency: 160 MHz}}
middleware:
  {middleware}
  transport: {{{transport}}}
  agent: {{acknowledgement: 2 ms}}
application:
  nodes:
    - name: node
      publishers:
        - {{topic: state, message_size: {size}, reliability: {reliability}}}
      subscriptions:
        - {{name: Cmd, topic: cmd, rate: 20 Hz, message_size: {received}, execution_time: 4 us{more}}}
      services:
        - {{name: Ask, rate: 1 Hz, request_size: 8 B, response_size: 8 B, execution_time: 4 us}}
      timers:
        - {{name: Report, period: 10 ms, execution_time: 4 us, publishes: [state]{timer}}}
"""
LOOP = "executor: {loop: {spin_some: 80 ms}}"


KEYS = {
    "middleware": LOOP,
    "transport": "",
    "size": "8 B",
    "reliability": "best-effort",
    "received": "8 B",
    "more": "",
    "timer": "",
}


def app(**keys):
    return TEXT.format(**(KEYS | keys))


def reported(author, rule, **keys):
    return [(str(each.severity), each.message) for each in author.describe(app(**keys)).findings if each.rule == rule]


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"size": "500 B"}, None),
        ({"size": "501 B"}, "a message of 'state' has 501 B, but at most 500 B can be sent best effort"),
        (
            {"size": "66 kB", "reliability": "reliable"},
            "a message of 'state' has 66000 B, but at most 65528 B can be sent reliably",
        ),
        # (512 - 12) * 4 - 8
        ({"received": "1992 B"}, None),
        ({"received": "1993 B"}, "a message of 'cmd' has 1993 B, but at most 1992 B can be received reliably"),
    ],
)
def test_messages_that_are_too_long(author, keys, message):
    if message is None:
        assert reported(author, "UR121", **keys) == []
    else:
        assert [(rule, found) for _, rule, found in author.findings(app(**keys))] == [("UR121", message)]


def test_no_message_takes_all_memory(author):
    # Each of its bytes would be a frame on the line, and each 500 of them a part.
    huge = LOOP + "\n  limits: {UCLIENT_CUSTOM_TRANSPORT_MTU: 1 GB}"
    found = author.findings(app(transport="serial: {driver: {write: polling}}", middleware=huge, size="100 MB"))
    message = "a message of 'state' has 100000000 B, but at most 1048576 B can be sent best effort"
    assert ("UR121", message) in [(rule, text) for _, rule, text in found]


def test_no_header_takes_all_memory(author):
    found = [(rule, text) for _, rule, text in author.findings(app(transport="serial: {}, overhead: 1 TB"))]
    assert found == [("YML012", "overhead: must not be greater than 64 KiB, found '1 TB'")]


def test_no_request_takes_all_memory(author):
    huge = LOOP + "\n  initialisation: {request_sizes: {topic: 4294967296 B}}"
    assert [(rule, text) for _, rule, text in author.findings(app(middleware=huge))] == [
        ("YML012", "topic: must not be greater than 64 KiB, found '4294967296 B'")
    ]


def test_histories_are_shared(author):
    # Reliable messages have a depth of 10 by default; the pool has 8 slots.
    ((severity, message),) = reported(author, "UR125")
    assert severity == "info"
    text = "by default, the histories of 'Cmd', 'Ask' are deeper than the storage for messages of all callbacks, 8: "
    assert message.startswith(text)
    enough = LOOP + "\n  limits: {RMW_UXRCE_MAX_HISTORY: 10}"
    assert reported(author, "UR125", middleware=enough) == []
    ((severity, message),) = reported(author, "UR125", middleware=enough, more=", depth: 11, history: keep-all")
    assert severity == "warning"
    assert message == (
        "the history of 'Cmd' is 11 messages deep, but only 10 can be stored for all callbacks: "
        "a new message of any topic is dropped instead of more being kept"
    )


def test_a_lost_message_is_sent_again_only_without_input(author):
    # Messages every 50 ms; the client asks after 100 ms without any.
    found = reported(author, "UR124", transport="loses_messages: true", reliability="reliable")
    text = "waits up to 1 s: it is sent again after 100 ms without input, but 'cmd' can arrive every 50 ms"
    assert [message for _, message in found] == [
        f"if a message of 'state' is lost, 'Report' {text}",
        f"if a message of 'Ask' is lost, 'Ask' {text}",
    ]
    often = LOOP + "\n  limits: {UCLIENT_MIN_HEARTBEAT_TIME_INTERVAL: 50 ms}"
    assert reported(author, "UR124", transport="loses_messages: true", reliability="reliable", middleware=often) == []


def test_threads_of_one_session(author):
    def unprotected(first, second):
        text = f"'{first}' and '{second}' use the session of the middleware from several threads, but nothing locks it"
        return [("warning", text)]

    assert reported(author, "EXE008") == []
    assert reported(author, "EXE008", timer=", runs_in: own-task") == unprotected("Executor_Task", "Report")
    two = "executors: [{name: A, loop: {spin_some: 80 ms}}, {name: B, loop: {spin: 1 s}}]"
    assert reported(author, "EXE008", middleware=two, timer=", runs_in: B") == unprotected("A", "B")
    held = "a thread that waits for messages keeps the session for up to 1 s; others that send wait for it: 'Report', 'Ask'"
    several = two + "\n  multithread: true"
    assert reported(author, "UR124", middleware=several, timer=", runs_in: B") == [("warning", held)]
    assert reported(author, "EXE008", middleware=several, timer=", runs_in: B") == []
    zenoh = two + "\n  profile: zenoh-pico\n  tasks: [{name: zenoh_read, priority: 3}]"
    # It has locks of its own.
    assert [rule for rule in ("UR124", "EXE008") if reported(author, rule, middleware=zenoh, timer=", runs_in: B")] == []


def publications(author, **keys):
    (executor,) = author.describe(app(**keys)).system.executors
    return {handle.name: handle.publications for handle in executor.handles}


def test_publications_of_callbacks(author):
    found = publications(author, reliability="reliable", transport="serial: {baud_rate: 115200}")
    assert found["Cmd"] == ()
    (state,), (response,) = found["Report"], found["Ask"]
    assert (state.topic, state.transmission) == ("state", "state_topic_from_Report")
    assert (state.acknowledgement, state.waits, state.timeout) == ("state_topic_from_Report_acknowledgement", True, SECOND)
    assert (response.topic, response.waits, response.timeout) == ("Ask/response", True, SECOND)


def test_publications_that_nobody_waits_for(author):
    (state,) = publications(author, transport="serial: {baud_rate: 115200}")["Report"]
    assert (state.acknowledgement, state.waits, state.timeout) == (None, False, None)
    # A port that does not wait is acknowledged nevertheless.
    port = LOOP + "\n  reliable: {waits: false}"
    (state,) = publications(author, transport="serial: {baud_rate: 115200}", reliability="reliable", middleware=port)["Report"]
    assert (state.acknowledgement, state.waits) == ("state_topic_from_Report_acknowledgement", False)
    (state,) = publications(author, reliability="reliable", middleware=LOOP + "\n  reliable: {timeout: 30 ms}")["Report"]
    assert (state.transmission, state.acknowledgement, state.timeout) == (None, None, 30 * MILLISECOND)
