"""What it takes to create the entities of an application: messages, their bytes, the wire, and the time.

The messages are those of S. R. Bappanadu 2022, sections 4.3 and 4.4.2: 24, 52, 84, 24, 40 and 24 B to the agent, 19 and four times
14 B back. A message takes a frame of CAN for each 7 bytes. A frame with 8 bytes has 111 to 135 bits.
"""

from fractions import Fraction

from support import ROOT

from amalthea_uros import describe
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.units import SECOND

SAMPLE = ROOT / "samples" / "bodas-test-hardware.yaml"
BIT = SECOND // 250_000


def test_the_messages_of_the_thesis():
    traffic = describe(SAMPLE).initialisation.traffic
    assert (traffic.to_agent.messages, traffic.to_agent.most_bytes) == (6, 24 + 52 + 84 + 24 + 40 + 24)
    assert (traffic.to_controller.messages, traffic.to_controller.most_bytes) == (5, 19 + 4 * 14)
    # The agent acknowledges each request but that of the session, and the client each response but that.
    assert (traffic.to_agent.acknowledgements, traffic.to_controller.acknowledgements) == (4, 5)


def test_the_wire_during_the_start():
    start = describe(SAMPLE).initialisation
    frames = (4 + 8 + 12 + 4 + 6 + 4) + (3 + 4 * 2) + 9 * 2
    assert start.traffic.most_wire_time == frames * 135 * BIT
    # Requests have at least 24 B: three frames of 8 bytes, and one of 4. Acknowledgements can be missing.
    least = 6 * (3 * 111 + 79) + (2 * 111 + 95) + 4 * 222
    assert start.traffic.least_wire_time == least * BIT
    # The client can ask for acknowledgements every 100 ms, the agent every 200 ms, and each is answered: 13 B each, in two frames.
    heartbeats = Fraction(2 * 2 * 135 * BIT, 100 * MS) + Fraction(2 * 2 * 135 * BIT, 200 * MS)
    assert start.most_load == Fraction(start.traffic.most_wire_time, start.min_time) + heartbeats


APP = """
    amuros: 1
    name: app
    hardware: {{platform: generic}}
    middleware:
      executor: {{{executor}}}
      transport: {{{transport}}}
      {more}
    application:
      nodes:
        - name: node
          publishers: [{{topic: out, message_size: 4 B}}]
          timers: [{{name: T, period: 100 ms, execution_time: 1 ms, publishes: [out]}}]
          {entities}
"""
CAN = "can: {bitrate: 250 kbit/s}"


def started(author, executor="period: 1 ms", transport=CAN, more="", entities=""):
    text = APP.format(executor=executor, transport=transport, more=more, entities=entities)
    return author.describe(text).initialisation


def test_the_wire_bounds_the_response_that_nobody_stated(author):
    # 412 bits there and 222 or 317 back, at 4 us each, are 2.536 or 2.916 ms: three cycles after that of each of 5 requests.
    start = started(author)
    assert (start.min_cycles, start.max_cycles) == (5 * (1 + 3), None)
    assert "'initialisation.response_time'" in start.reason


def test_sizes_that_are_not_stated_are_unknown(author):
    start = started(author)
    assert (start.traffic.to_agent.least_bytes, start.traffic.to_agent.most_bytes) == (5 * 24, None)
    assert start.traffic.most_wire_time is None
    assert start.most_load is None
    assert "participant, topic, publisher, datawriter" in start.traffic.reason


LOOP = "loop: {spin_some: 100 ms}"


def test_a_thread_waits_for_each_response(author):
    # 5 entities; at most ten attempts of a second for the session, and a second for each other one.
    start = started(author, LOOP, more="initialisation: {response_time: {min: 3 ms, max: 20 ms}}")
    assert (start.min_cycles, start.min_time, start.max_time) == (None, 5 * 3 * MS, 5 * 20 * MS)
    unknown = started(author, LOOP)
    assert (unknown.min_time, unknown.max_time) == ((4 * (412 + 222) + 412 + 317) * BIT, None)
    assert unknown.limit == (10 + 4) * SECOND


def test_no_response_is_faster_than_the_wire(author):
    start = started(author, LOOP, more="initialisation: {response_time: 1 ms}")
    assert start.min_time == (4 * (412 + 222) + 412 + 317) * BIT
    assert start.max_time == 5 * (412 + 317) * BIT


def test_without_a_wire_only_the_messages_are_known(author):
    start = started(author, LOOP, transport="acknowledgement: 5 ms")
    assert (start.min_time, start.max_time, start.traffic.least_wire_time) == (0, None, None)
    assert "wire" in start.traffic.reason


def test_nothing_is_acknowledged_that_is_sent_with_best_effort(author):
    start = started(author, LOOP, more="limits: {RMW_UXRCE_ENTITY_CREATION_DESTROY_TIMEOUT: 0}")
    assert start.traffic.to_agent.acknowledgements == start.traffic.to_controller.acknowledgements == 0


def kinds(start):
    return [entity.kind for entity in start.entities]


def test_what_is_behind_actions_and_parameters_is_created_too(author):
    goal = "goal_size: 4 B, result_size: 4 B, feedback_size: 4 B, execution_time: 1 ms, rate: 1 Hz"
    start = started(author, LOOP, entities=f"action_servers: [{{name: Drive, {goal}}}]")
    assert kinds(start)[5:] == ["replier"] * 3 + ["topic", "publisher", "datawriter"] * 2
    # Three repliers ask for requests.
    assert start.traffic.to_agent.messages == 5 + 9 + 3


def test_a_request_for_data_takes_at_most_a_cycle(author):
    response = "initialisation: {response_time: 5 ms}"
    subscription = "subscriptions: [{name: S, topic: s, message_size: 4 B, interval: 100 ms, execution_time: 1 ms}]"
    service = "services: [{name: A, rate: 1 Hz, request_size: 4 B, response_size: 4 B, execution_time: 1 ms}]"
    start = started(author, more=response, entities=f"{subscription}\n          {service}")
    # 9 entities: 6 cycles each; the request of the subscription comes before the service, that of the service after the last response.
    assert (start.min_cycles, start.max_cycles) == (9 * 6, 9 * 6 + 1)
