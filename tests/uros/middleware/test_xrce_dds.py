"""Messages of XRCE-DDS, against the layouts in the sources of the client and against figures of its users."""

import pytest

from amalthea_uros.perf.network import Direction
from amalthea_uros.spec.content import nodes_of
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.nodes import plain
from amalthea_uros.units import MILLISECOND, SECOND
from amalthea_uros.uros.application.messages import ASKING, MessageKind
from amalthea_uros.uros.profiles import profile_of

CAN_FD = {"can_fd": {"bitrate": "500 kbit/s", "data_bitrate": "2 Mbit/s"}}
SERIAL = {"serial": {"baud_rate": 115200}}
#: Options for the directions count only together.
BOTH = {"RMW_UXRCE_STREAM_HISTORY_INPUT": 8, "RMW_UXRCE_STREAM_HISTORY_OUTPUT": 2}
SENT = (MessageKind.PUBLICATION, MessageKind.REQUEST_OUT, MessageKind.RESPONSE_OUT)
RECEIVED = (MessageKind.DELIVERY, MessageKind.REQUEST_IN, MessageKind.RESPONSE_IN)


def profile_with(**content):
    return profile_of(Middleware.model_validate(plain(nodes_of(content)[0])))


def lengths(kind, content, best_effort=False, **keys):
    return [part.length for part in profile_with(**keys).parts(kind, content, reliable=not best_effort)]


def largest(kind, best_effort=False, **keys):
    return profile_with(**keys).largest_content(kind, reliable=not best_effort)


@pytest.mark.parametrize(
    # Int32, Int64, Twist and Imu without a frame_id; an Int32 has 16 B in the agent's log of micro_ros_arduino issue 20.
    ("content", "length"),
    [(4, 16), (8, 20), (48, 60), (312, 324), (1, 16), (5, 20)],
)
def test_a_publication_has_headers_of_12_bytes_and_is_aligned_to_4(content, length):
    assert lengths(MessageKind.PUBLICATION, content) == [length]
    assert lengths(MessageKind.PUBLICATION, content, best_effort=True) == [length]


def test_only_reliable_messages_are_acknowledged():
    profile = profile_with()
    for reliable, acknowledgement in ((True, 13), (False, None)):
        for content, fragments in ((8, 1), (1000, 3 if reliable else 1)):
            parts = profile.parts(MessageKind.PUBLICATION, content, reliable=reliable)
            # One ACKNACK for each fragment.
            assert [part.acknowledgement for part in parts] == [acknowledgement] * fragments


def test_fragments_fill_the_buffers():
    # 4 B of each buffer are its length; fragments have 8 B of headers: 500 B of the submessage in each. It has 8 + 1000 B.
    assert lengths(MessageKind.PUBLICATION, 1000) == [508, 508, 16]
    assert lengths(MessageKind.DELIVERY, 992) == [508, 508]
    # CAN FD: fragments of 51 B. The submessage has 8 + 48 B.
    assert lengths(MessageKind.PUBLICATION, 48, transport=CAN_FD) == [59, 13]


@pytest.mark.parametrize(
    ("keys", "best_effort", "unfragmented"),
    [
        ({}, 512 - 12, 512 - 16),
        ({"transport": SERIAL}, 500, 496),
        ({"transport": CAN_FD}, 48, 44),
        ({"limits": {"RMW_UXRCE_MTU": "256 B"}}, 244, 240),
        ({"transport": SERIAL, "limits": {"UCLIENT_CUSTOM_TRANSPORT_MTU": "128 B"}}, 116, 112),
        # A constant of the transport, whatever the options say.
        ({"transport": CAN_FD, "limits": {"RMW_UXRCE_MTU": "256 B"}}, 48, 44),
    ],
)
def test_the_longest_messages_that_are_not_cut(keys, best_effort, unfragmented):
    assert largest(MessageKind.PUBLICATION, best_effort=True, **keys) == best_effort
    assert len(lengths(MessageKind.PUBLICATION, unfragmented, **keys)) == 1
    assert len(lengths(MessageKind.PUBLICATION, unfragmented + 1, **keys)) == 2


@pytest.mark.parametrize(
    ("kind", "keys", "longest"),
    [
        # (MTU - 12) * history - 8
        (MessageKind.DELIVERY, {}, 500 * 4 - 8),
        (MessageKind.DELIVERY, {"limits": {"RMW_UXRCE_STREAM_HISTORY": 8}}, 500 * 8 - 8),
        (MessageKind.DELIVERY, {"transport": CAN_FD}, 51 * 4 - 8),
        (MessageKind.DELIVERY, {"limits": {"RMW_UXRCE_STREAM_HISTORY_INPUT": 8}}, 500 * 4 - 8),
        (MessageKind.DELIVERY, {"limits": BOTH}, 500 * 8 - 8),
        (MessageKind.PUBLICATION, {"limits": BOTH, "multithread": True}, 500 * 2 - 8),
        (MessageKind.REQUEST_IN, {}, 500 * 4 - 8 - 24),
        (MessageKind.RESPONSE_IN, {}, 500 * 4 - 8 - 4),
        # The length of a submessage has 16 bits: 4 B of the entity, and aligned.
        (MessageKind.PUBLICATION, {}, 65532 - 4),
        # `uxr_prepare_output_stream_fragmented` does nothing in builds for several threads.
        (MessageKind.PUBLICATION, {"multithread": True}, 500 * 4 - 8),
        (MessageKind.PUBLICATION, {"reliable": {"waits": False}}, 500 * 4 - 8),
        # With one buffer, a message that is not cut is longer than one that is.
        (MessageKind.DELIVERY, {"limits": {"RMW_UXRCE_STREAM_HISTORY": 1}}, 496),
    ],
)
def test_the_longest_reliable_messages(kind, keys, longest):
    assert largest(kind, **keys) == longest


@pytest.mark.parametrize("transport", [{}, SERIAL, CAN_FD], ids=str)
@pytest.mark.parametrize("kind", [*SENT, *RECEIVED])
def test_the_longest_content_is_the_last_that_fits(kind, transport):
    profile = profile_with(transport=transport, multithread=True)
    mtu = 63 if "can_fd" in transport else 512
    for reliable, buffers in ((False, 1), (True, 4)):
        limit = profile.largest_content(kind, reliable=reliable)

        def fits(content, reliable=reliable, buffers=buffers):
            parts = profile.parts(kind, content, reliable=reliable)
            return len(parts) <= buffers and all(part.length <= mtu for part in parts)

        assert [fits(limit), fits(limit + 1)] == [True, False]


def test_an_overhead_that_is_stated_counts_as_it_always_has():
    for kind in frozenset(MessageKind) - ASKING:
        assert lengths(kind, 5, transport={"overhead": "20 B"}) == [25]
        assert lengths(kind, 5, transport={"overhead": "0 B"}) == [5]


@pytest.mark.parametrize(
    ("keys", "content", "timeout"),
    [
        ({}, 8, SECOND),
        ({"reliable": {"timeout": "20 ms"}}, 8, 20 * MILLISECOND),
        ({"limits": {"RMW_UXRCE_PUBLISH_RELIABLE_TIMEOUT": "20 ms"}}, 8, 20 * MILLISECOND),
        ({"reliable": {"waits": False}}, 8, None),
        # 1992 B in the four buffers; longer ones wait up to 1 s for each time that these are full, whatever the timeout is.
        ({"reliable": {"timeout": "20 ms"}}, 1992, 20 * MILLISECOND),
        ({"reliable": {"timeout": "20 ms"}}, 1993, 1020 * MILLISECOND),
        ({}, 4000, 3 * SECOND),
    ],
)
def test_how_long_a_sender_waits(keys, content, timeout):
    profile = profile_with(**keys)
    kind = MessageKind.PUBLICATION
    assert profile.times_out_after(kind, content, reliable=True) == timeout
    assert profile.times_out_after(kind, content, reliable=False) is None


def test_several_threads_wait_for_each_other_only_if_they_are_protected():
    for multithread in (False, True):
        sending = profile_with(multithread=multithread).sending
        assert (sending.holds_session_while_waiting, sending.is_protected) == (multithread, multithread)


def test_heartbeats():
    # HEARTBEAT of 13 B; the client sends one after 100 ms by default, the agent after 200 ms.
    for keys, interval in (({}, 100), ({"limits": {"UCLIENT_MIN_HEARTBEAT_TIME_INTERVAL": "1 ms"}}, 1)):
        profile = profile_with(**keys)
        assert profile.heartbeat(Direction.TO_AGENT) == (13, interval * MILLISECOND, True)
        assert profile.heartbeat(Direction.TO_CONTROLLER) == (13, 200 * MILLISECOND, True)
        assert profile.sending.resends_after == interval * MILLISECOND
