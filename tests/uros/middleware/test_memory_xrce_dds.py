"""The pools and the memory of rmw_microxrcedds, against the figures of its sources."""

import pytest

from amalthea_uros.spec.application import Application
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.uros.middleware.xrce_dds.profile import XrceDds
from amalthea_uros.uros.profiles import known_data

DATA = known_data("xrce-dds")
TIMER = {"name": "T", "period": "10 ms", "execution_time": "1 us"}
TOPIC = {"name": "S", "topic": "s", "message_size": "4 B", "rate": "1 Hz", "execution_time": "1 us"}


def application(**node):
    return Application.model_validate({"nodes": [{"name": "node", **node}]})


def middleware(**keys):
    return Middleware.model_validate(keys)


def limits(nodes=4, publishers=4, subscriptions=4, services=4, clients=4, history=8, **others):
    names = ("NODES", "PUBLISHERS", "SUBSCRIPTIONS", "SERVICES", "CLIENTS", "HISTORY")
    counts = (nodes, publishers, subscriptions, services, clients, history)
    return {f"RMW_UXRCE_MAX_{name}": count for name, count in zip(names, counts, strict=True)} | others


def memory(data=DATA, **stated):
    return XrceDds(data, middleware(limits=stated)).memory(application())


def options(app, **keys):
    return {option.name.removeprefix("RMW_UXRCE_"): option for option in XrceDds(DATA, middleware(**keys)).options(app)}


def needed(app, **keys):
    return {name: option.needed for name, option in options(app, **keys).items()}


@pytest.mark.parametrize(
    ("stated", "session", "history", "entities"),
    # The .meta files of the ports (micro_ros_espidf_component, micro_ros_stm32cubemx_utils, micro_ros_arduino, micro_ros_setup), and
    # their memory on a 32-bit target: a session has 432 B besides its buffers, as compiled for ARM, and a pool 216 B for each publisher
    # and subscription, 200 B for each service and client.
    [
        ({}, 5552, 16896, 4448),
        (limits(1, 2, 2, 1, 1, 1), 5552, 2112, 1780),
        (limits(1, 10, 5, 1, 1, 4), 5552, 8448, 4464),
        (limits(1, 2, 1, 0, 1, 1), 5552, 2112, 1336),
        (limits(15, 15, 15, 15, 15, 10, RMW_UXRCE_STREAM_HISTORY=32), 34224, 164480, 16020),
    ],
    ids=["defaults", "ESP-IDF", "STM32", "Arduino very low memory", "host"],
)
def test_the_memory_of_known_builds(stated, session, history, entities):
    sizes = [use.size for use in memory(**stated)]
    assert sizes == pytest.approx([session, history, entities], rel=0.01)
    assert sizes[:2] == [session, history]


def test_half_the_mtu_is_half_the_session_and_history():
    whole, half = (memory(UCLIENT_CUSTOM_TRANSPORT_MTU=size) for size in ("512 B", "256 B"))
    assert 2 * (half[0].size - 432) == whole[0].size - 432
    assert 2 * (half[1].size - 8 * 64) == whole[1].size - 8 * 64


def test_a_slot_more_costs_the_longest_message():
    one, two = (memory(RMW_UXRCE_MAX_HISTORY=slots)[1].size for slots in (1, 2))
    # 2048 B were measured, without the slot itself (micro-ROS.github.io, memory profiling).
    assert two - one == 2048 + 64


def test_the_graph_costs_an_input_stream_more():
    graph = memory(RMW_UXRCE_GRAPH=True)[-1]
    assert (graph.name, graph.size) == ("graph of nodes and topics", 512 * 4)


def test_streams_of_different_length_count_only_together():
    alone, both = {"RMW_UXRCE_STREAM_HISTORY_INPUT": 2}, {"RMW_UXRCE_STREAM_HISTORY_OUTPUT": 8}
    assert memory(**alone, **both)[0].size == 512 * (2 + 8 + 2) + 432
    assert memory(**alone)[0].size == 512 * (4 + 4 + 2) + 432


def test_every_timer_has_a_guard_condition():
    timers = [TIMER | {"name": f"T{number}"} for number in range(5)]
    own = [{"name": "G", "execution_time": "1 us"}]
    assert needed(application(timers=timers))["MAX_GUARD_CONDITION"] == 5
    assert needed(application(timers=timers, guard_conditions=own))["MAX_GUARD_CONDITION"] == 6


def test_topics_do_not_count_nodes_and_names():
    same = [TOPIC | {"name": f"S{number}"} for number in range(3)]
    publishers = [{"topic": "s", "message_size": "4 B"}]
    found = needed(application(subscriptions=same, publishers=publishers))
    assert (found["MAX_TOPICS"], found["MAX_PUBLISHERS"], found["MAX_SUBSCRIPTIONS"], found["MAX_NODES"]) == (4, 1, 3, 1)
    assert options(application(), limits=limits(publishers=7, subscriptions=2))["MAX_TOPICS"].available == 9


def test_entities_behind_actions_parameters_and_lifecycles():
    sizes = {"goal_size": "4 B", "result_size": "4 B", "feedback_size": "4 B", "execution_time": "1 us", "rate": "1 Hz"}
    server = needed(application(action_servers=[{"name": "A", **sizes}]))
    # rcl_action: services for goals, results and cancelling; publishers of feedback and status; a timer for results that expire.
    assert [server[f"MAX_{kind}"] for kind in ("SERVICES", "PUBLISHERS", "GUARD_CONDITION")] == [3, 2, 1]
    client = needed(application(action_clients=[{"name": "A", "action": "a", **sizes}]))
    assert [client[f"MAX_{kind}"] for kind in ("CLIENTS", "SUBSCRIPTIONS")] == [3, 2]
    parameters = needed(application(parameter_server={"execution_time": "1 us"}))
    assert [parameters[f"MAX_{kind}"] for kind in ("SERVICES", "PUBLISHERS")] == [6, 1]
    silent = needed(application(parameter_server={"execution_time": "1 us", "events": False}))
    assert silent["MAX_PUBLISHERS"] == 0
    # rcl_lifecycle creates all five services and the publisher of transitions.
    lifecycle = needed(application(lifecycle={"execution_time": "1 us", "services": 1}))
    assert [lifecycle[f"MAX_{kind}"] for kind in ("SERVICES", "PUBLISHERS")] == [5, 1]


def test_a_wait_set_per_executor():
    several = [{"name": "A"}, {"name": "B"}, {"name": "C"}]
    assert needed(application(timers=[TIMER]), executors=several)["MAX_WAIT_SETS"] == 3
    assert needed(application(publishers=[{"topic": "p", "message_size": "4 B"}]))["MAX_WAIT_SETS"] == 0


LOOP = {"spin_some": "100 ms"}


@pytest.mark.parametrize(
    ("ware", "slots"),
    [
        ({"executor": {"loop": LOOP}}, 1),  # each wait takes one message, and the round takes it from its slot
        ({}, 2),  # messages of a period wait for its end
        ({"executor": {"loop": LOOP, "trigger": "all"}}, 2),  # one waits for the other
        ({"executor": {"loop": LOOP}, "multithread": True}, 2),
        ({"executors": [{"name": "A", "loop": LOOP}, {"name": "B", "loop": LOOP}]}, 2),  # each stores what is for the other
    ],
)
def test_slots_for_messages_that_wait(ware, slots):
    two = application(subscriptions=[TOPIC, TOPIC | {"name": "R"}])
    assert needed(two, **ware)["MAX_HISTORY"] == slots


def test_messages_wait_while_a_reliable_publication_does():
    def slots(reliability, waits=True):
        app = application(
            subscriptions=[TOPIC, TOPIC | {"name": "R"}],
            publishers=[{"topic": "p", "message_size": "4 B", "reliability": reliability}],
        )
        return needed(app, executor={"loop": LOOP}, reliable={"waits": waits})["MAX_HISTORY"]

    assert (slots("best-effort"), slots("reliable"), slots("reliable", waits=False)) == (1, 2, 1)


@pytest.mark.parametrize(
    ("wire", "stated", "transport", "option", "mtu"),
    [
        ({"udp": {"bitrate": "100 Mbit/s"}}, {}, "udp", "UCLIENT_UDP_TRANSPORT_MTU", 512),
        ({"tcp": {"bitrate": "100 Mbit/s"}}, {"UCLIENT_TCP_TRANSPORT_MTU": "1 kB"}, "tcp", "UCLIENT_TCP_TRANSPORT_MTU", 1000),
        ({"serial": {}}, {}, "custom", "UCLIENT_CUSTOM_TRANSPORT_MTU", 512),
        ({"serial": {}}, {"UCLIENT_SERIAL_TRANSPORT_MTU": "128 B"}, "serial", "UCLIENT_SERIAL_TRANSPORT_MTU", 128),
        ({"serial": {}}, {"RMW_UXRCE_TRANSPORT": "serial"}, "serial", "UCLIENT_SERIAL_TRANSPORT_MTU", 512),
        ({"serial": {}}, {"RMW_UXRCE_MTU": "256 B"}, "custom", "UCLIENT_CUSTOM_TRANSPORT_MTU", 256),
        ({"can": {"bitrate": "1 Mbit/s"}}, {}, "custom", "UCLIENT_CUSTOM_TRANSPORT_MTU", 512),
        ({"can_fd": {"bitrate": "1 Mbit/s", "data_bitrate": "4 Mbit/s"}}, {"RMW_UXRCE_MTU": "256 B"}, "custom", None, 63),
    ],
)
def test_only_the_mtu_of_the_transport_counts(wire, stated, transport, option, mtu):
    build = XrceDds(DATA, middleware(transport=wire, limits=stated)).build
    assert (build.transport, build.mtu_option, build.mtu) == (transport, option, mtu)


@pytest.mark.parametrize(("size", "mtu"), [(500, 512), (501, 516), (1, 16), (4, 16)])
def test_a_best_effort_message_needs_one_buffer(size, mtu):
    # 12 B of headers, padded to four bytes: an Int32 of 4 B has 16 B on the wire (micro_ros_arduino issue 20).
    app = application(publishers=[{"topic": "p", "message_size": f"{size} B", "reliability": "best-effort"}])
    assert needed(app)["UCLIENT_CUSTOM_TRANSPORT_MTU"] == mtu


@pytest.mark.parametrize(
    ("size", "history"),
    # Received in fragments of 500 B of the MTU of 512 B, the first of which has 8 B of headers more: H * 500 - 8 at most.
    [(496, 1), (497, 2), (992, 2), (993, 4), (1992, 4), (1993, 8)],
)
def test_a_reliable_message_that_arrives_needs_all_its_fragments(size, history):
    app = application(subscriptions=[TOPIC | {"message_size": f"{size} B"}])
    assert options(app)["STREAM_HISTORY"].smallest == history


@pytest.mark.parametrize(
    ("multithread", "history"),
    # 2000 B in fragments of 500 B, with 8 B of headers: five. They can go out step by step, but not from a build for several threads
    # (`uxr_prepare_output_stream_fragmented` in src/c/core/session/stream/output_reliable_stream.c).
    [(False, 1), (True, 8)],
)
def test_a_reliable_message_that_leaves_needs_all_its_fragments_with_several_threads(multithread, history):
    app = application(publishers=[{"topic": "p", "message_size": "2000 B"}])
    assert options(app, multithread=multithread)["STREAM_HISTORY"].smallest == history


def test_lengths_of_names_have_a_slash_and_a_terminator():
    app = application(subscriptions=[TOPIC | {"topic": "factor"}])
    found = needed(app)
    assert (found["NODE_NAME_MAX_LENGTH"], found["TOPIC_NAME_MAX_LENGTH"]) == (len("node") + 1, len("/factor") + 1)
    assert needed(application(subscriptions=[TOPIC | {"topic": "/factor"}]))["TOPIC_NAME_MAX_LENGTH"] == len("/factor") + 1


def test_a_profile_can_have_other_defaults():
    other = DATA.model_copy(update={"options": {"MTU": 256, "RMW_UXRCE_MAX_HISTORY": 2}})
    assert [use.size for use in memory(other)][:2] == [256 * 10 + 432, 2 * (256 * 4 + 64)]
    assert memory(other, RMW_UXRCE_MAX_HISTORY=1)[1].size == 256 * 4 + 64
