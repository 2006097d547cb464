"""Messages of zenoh-pico, against the pieces of its protocol; its options and buffers."""

import pytest

from amalthea_uros.perf.network import Direction
from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.units import SECOND
from amalthea_uros.uros.application.messages import MessageKind
from amalthea_uros.uros.profiles import profile_of

MIDDLEWARE = Middleware(profile="zenoh-pico")
PROFILE = profile_of(MIDDLEWARE)


def lengths(content, kind=MessageKind.PUBLICATION, reliable=False):
    return [part.length for part in PROFILE.parts(kind, content, reliable=reliable)]


@pytest.mark.parametrize(
    # Frame 1, sequence number 4, push 1, key 2, put 1, attachment 35, serialisation 4: 48 B, and the length of the payload, which is
    # written in one byte for each 7 bits; the payload has 4 B more than the content.
    ("content", "length"),
    [(4, 48 + 1 + 4), (123, 48 + 1 + 123), (124, 48 + 2 + 124), (1998, 48 + 2 + 1998)],
)
def test_headers_of_a_publication(content, length):
    assert lengths(content) == [length]


def test_reliable_messages_and_services_have_more_headers():
    assert lengths(8, reliable=True) == [lengths(8)[0] + 2]
    for kind in MessageKind:
        is_query = kind not in (MessageKind.PUBLICATION, MessageKind.DELIVERY)
        assert lengths(8, kind) == [lengths(8)[0] + 16 * is_query]


def test_nothing_is_acknowledged_and_no_sender_waits():
    (part,) = PROFILE.parts(MessageKind.PUBLICATION, 8, reliable=True)
    assert part.acknowledgement is None
    assert PROFILE.times_out_after(MessageKind.PUBLICATION, 8, reliable=True) is None
    sending = PROFILE.sending
    assert (sending.waits, sending.drops_when_busy, sending.is_protected) == (False, True, True)


def test_messages_longer_than_a_batch_are_cut():
    # 43 B before the content, and 2 B for its length; each fragment has 5 B of headers in a batch of 2048 B.
    assert lengths(2043 - 45) == [2048]
    assert lengths(2043 - 44) == [2048, 6]
    assert lengths(2 * 2043 - 45) == [2048, 2048]


@pytest.mark.parametrize("kind", MessageKind)
@pytest.mark.parametrize("reliable", [True, False])
def test_the_longest_content_is_joined_from_fragments(kind, reliable):
    # FRAG_MAX_SIZE is 4096 B, without the headers of the fragments.
    limit = PROFILE.largest_content(kind, reliable=reliable)
    assert sum(length - 5 for length in lengths(limit, kind, reliable)) == 4096


def test_keep_alives():
    # A third of the lease of 10 s, rounded down.
    for direction in Direction:
        assert PROFILE.heartbeat(direction) == (1, 10 * SECOND // 3, False)


APPLICATION = Application.model_validate({"nodes": [{"name": "node"}]})


def middleware(**keys):
    return Middleware.model_validate({"profile": "zenoh-pico", **keys})


def test_there_are_no_pools():
    assert all(option.role == "setting" or option.role == "room" for option in profile_of(middleware()).options(APPLICATION))


@pytest.mark.parametrize(
    ("ware", "sizes"),
    [
        ({"transport": {"udp": {"bitrate": "10 Mbit/s"}}}, [2048, 2048]),
        ({"transport": {"serial": {}}}, [1500, 2048]),  # the MTU of a serial link
        ({"limits": {"BATCH_UNICAST_SIZE": "1 kB"}}, [1000, 1000]),
    ],
)
def test_a_buffer_for_each_direction(ware, sizes):
    assert [use.size for use in profile_of(middleware(**ware)).memory(APPLICATION) if use.is_bounded] == sizes


def test_a_message_that_arrives_in_fragments_has_a_limit():
    topic = {"name": "S", "topic": "s", "message_size": "4050 B", "rate": "1 Hz", "execution_time": "1 us"}
    application = Application.model_validate({"nodes": [{"name": "node", "subscriptions": [topic]}]})
    (option,) = (each for each in profile_of(middleware()).options(application) if each.name == "FRAG_MAX_SIZE")
    assert option.is_exceeded  # 4050 B and up to 50 B of headers, in 4096 B


def test_its_thread_has_a_stack(author):
    memory = author.describe("""
        amuros: 1
        name: app
        hardware: {platform: single-core, frequency: 100 MHz}
        middleware:
          profile: zenoh-pico
          executor: {period: 10 ms, stack: 4 kB}
          tasks: [{name: zenoh_read, priority: 5, stack: 2 kB}]
        application:
          nodes: [{name: node, timers: [{name: T, period: 10 ms, execution_time: 1 us, runs_in: executor}]}]
    """).memory
    assert {user.name: user.size for user in memory.stacks.users} == {"Executor_Task": 4000, "zenoh_read": 2000}
    # Received messages wait on the heap, in any number.
    assert (memory.total, memory.is_complete) == (2048 + 2048 + 6000, False)
