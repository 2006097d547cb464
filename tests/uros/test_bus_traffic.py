"""The messages of an application on its CAN bus: when they are queued, how long they take, and that the rest stays as it is."""

import pytest
from command import amuros
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from amalthea_uros import describe
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.activities import Execute
from amalthea_uros.perf.stimuli import Single
from amalthea_uros.perf.system import System
from amalthea_uros.services.subject import open_system
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import SECOND, Duration
from amalthea_uros.uros.network.classic_bus import BusTransmission, with_bus
from amalthea_uros.uros.transports.can import CanBus, block_bytes, frames

SAMPLES = ROOT / "samples"


@given(st.integers(0, 2000))
def test_each_frame_has_a_header_byte_and_the_last_one_may_be_padded(length):
    blocks = block_bytes(length)
    assert len(blocks) == frames(length)
    assert sum(least - 1 for least, _ in blocks) == max(1, length)
    assert {most for _, most in blocks} == {8}


def test_the_thesis_at_250_kbit_per_second():
    """Section 4.4.2: an XRCE message of n bytes takes ceil(n / 7) frames; with all stuff bits, each takes 135 bits of 4 us."""
    system = describe(SAMPLES / "bodas-test-advanced.yaml").system_with_bus()
    found = simulate_system(system, Options(duration=Duration(2 * SECOND), mode=Mode.WORST))
    # 4 bytes and 12 of headers at 50 Hz.
    assert found["factor_topic_to_Message_Factor"].response_time.max == 3 * 540 * US
    assert float(found.cores["CAN"].load) == 50 * 3 * 540e-6


# The longest message that creates an entity, and the shortest one from the agent.
@pytest.mark.parametrize(("length", "count"), [(84, 12), (14, 2)])
def test_messages_of_the_thesis_that_create_entities(length, count):
    message = BusTransmission(name="message", frames=block_bytes(length), stimulus=Single(name="once", time=0))
    system = with_bus(System(), CanBus(bit_rate=250_000), [message])
    found = simulate_system(system, Options(duration=Duration(SECOND), mode=Mode.WORST))
    assert found["message"].response_time.max == count * 540 * US
    assert sum(isinstance(each, Execute) for each in system.processes["message"].activities) == count


def test_messages_are_queued_as_often_as_the_description_says():
    assembly = describe(SAMPLES / "drive-and-lift.yaml")
    found = simulate_system(assembly.system_with_bus(), Options(duration=Duration(10 * SECOND)))
    jobs = {process.name: process.jobs for process in found.processes if process.core == "CAN"}
    assert jobs == {
        "speed_topic_to_Set_Speed": 200,
        "odometry_topic_from_Report_Odometry": 100,
        # Watch_Load is due every 500 ms, in a task of 100 ms.
        "load_request_from_Watch_Load": 20,
        "load_response_to_Ask_Load": 20,
        "Move_Lift_request_to_Move_Lift": 20,
        "Move_Lift_response_from_Move_Lift": 20,
    }
    assert found.cores["CAN"].load <= sum(message.bus_load for message in assembly.messages)


def test_a_callback_that_runs_between_messages_does_not_publish_then(author):
    assembly = author.describe(
        """
        amuros: 1
        name: test
        hardware: {frequency: 1 MHz}
        middleware: {task_periods: [1 ms, 10 ms], transport: {can: {bitrate: 1 Mbit/s}}}
        application:
          nodes:
            - name: node
              subscriptions:
                - {name: Echo, topic: in, rate: 25 Hz, message_size: 4 B, execution_time: 5 us, publishes: [out]}
              publishers: [{topic: out, message_size: 4 B, reliability: best-effort}]
        """
    )
    found = simulate_system(assembly.system_with_bus(), Options(duration=Duration(SECOND)))
    # Its task has a period of 10 ms, so that it runs four times for each message.
    assert (found["Echo"].jobs, found["out_topic_from_Echo"].jobs, found["in_topic_to_Echo"].jobs) == (100, 25, 25)


@pytest.mark.parametrize("sample", ["drive-and-lift", "bodas-test-hardware"])
def test_the_bus_changes_nothing_of_the_application_and_keeps_within_its_bounds(sample):
    assembly = describe(SAMPLES / f"{sample}.yaml")
    whole = assembly.system_with_bus()
    bounds = {process.name: process.response for process in analyze_system(whole).processes}
    for mode in Mode:
        options = Options(duration=Duration(SECOND // 2), mode=mode)
        alone, found = (simulate_system(system, options) for system in (assembly.system, whole))
        assert [found[process.name] for process in alone.processes] == list(alone.processes)
        times = {process.name: process.response_time for process in found.processes}
        assert [
            name for name, time in times.items() if not bounds[name].best <= time.min <= time.max <= bounds[name].worst
        ] == []


@pytest.mark.parametrize("command", ["analyze", "simulate"])
def test_the_commands_show_the_bus_where_it_is_wanted(command):
    for options, is_shown in ((("--bus",), True), ((), False)):
        done = amuros(command, SAMPLES / "bodas-test-hardware.yaml", *options)
        assert done.returncode == 0, done.stderr
        assert ("factor_topic_to_Message_Factor" in done.stdout) is ("  CAN " in done.stdout) is is_shown


@pytest.mark.parametrize(
    ("sample", "reason"),
    [
        ("executor.amxmi", "only an app.yaml describes the messages on a CAN bus"),
        (
            "bodas-test-simple.yaml",
            "no CAN bus is described in .*bodas-test-simple.yaml; set 'middleware.transport.can.bitrate'",
        ),
    ],
)
def test_a_bus_that_is_not_described(sample, reason):
    with pytest.raises(InvalidArgumentError, match=reason):
        open_system([SAMPLES / sample], with_bus=True)


BOTH_WAYS = """
    amuros: 1
    name: test
    hardware: {{frequency: 1 MHz}}
    middleware: {{transport: {{can: {{bitrate: 1 Mbit/s, identifiers: {{{identifiers}}}}}}}}}
    application:
      nodes:
        - name: node
          subscriptions:
            - {{name: First, topic: a, rate: 10 Hz, message_size: 2 B, execution_time: 5 us}}
            - {{name: Second, topic: b, rate: 10 Hz, message_size: 2 B, execution_time: 5 us}}
            - {{name: Third, topic: c, rate: 10 Hz, message_size: 2 B, execution_time: 5 us}}
    """


@pytest.mark.parametrize(
    ("identifiers", "order"),
    [
        ("", "abc"),
        ("c_topic: 0x120", "cab"),
        ("c_topic: 0x120, a_topic: 0x121", "cab"),
        ("c_topic: 0x120, b_topic: 0x11F", "bca"),
    ],
)
def test_identifiers_of_messages_decide_who_is_sent_first(identifiers, order, author):
    system = author.describe(BOTH_WAYS.format(identifiers=identifiers)).system_with_bus()
    found = simulate_system(system, Options(duration=Duration(SECOND), mode=Mode.WORST))
    ends = {process.name[0]: process.response_time.max for process in found.processes if process.core == "CAN"}
    # Each has 14 bytes, so two frames of 135 bits.
    assert ends == {name: place * 270 * US for place, name in enumerate(order, 1)}


@pytest.mark.parametrize(
    ("identifiers", "finding"),
    [
        ("d_topic: 1", ("APP001", "undefined message 'd_topic'")),
        (
            "a_topic: 0x20000000",
            ("YML012", "a_topic: expected an identifier of up to 29 bits, 0 to 0x1fffffff, found '0x20000000'"),
        ),
        ("a_topic: 0x12G", ("YML012", "a_topic: expected a hexadecimal number such as 0x120, found '0x12G'")),
        ("a_topic: 0x800", ("APP003", "the identifier 0x800 of 'a_topic' has more than 11 bits")),
    ],
)
def test_wrong_identifiers(identifiers, finding, author):
    assert author.findings(BOTH_WAYS.format(identifiers=identifiers)) == [(4, *finding)]


def test_services_have_the_identity_of_the_sample_before_their_content():
    """12 B of headers and 24 B of identity before a request that arrives and before its response (src/c/core/session/write_access.c of
    eProsima/Micro-XRCE-DDS-Client); the client of another service sends 12 B and receives 16 B."""
    messages = {message.name: message for message in describe(SAMPLES / "drive-and-lift.yaml").messages}
    before = {
        "Move_Lift_request_to_Move_Lift": 36,
        "Move_Lift_response_from_Move_Lift": 36,
        "load_request_from_Watch_Load": 12,
        "load_response_to_Ask_Load": 16,
    }
    lengths = {name: messages[name].length - -(-messages[name].message.size // 8) for name in before}
    assert lengths == before
