"""The options and buffers of zenoh-pico."""

import pytest

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.profiles import profile_of

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
