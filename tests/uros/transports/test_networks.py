"""Wires in systems: what is queued on them, what receives, and that no simulated message takes longer than its bound."""

from textwrap import dedent

import pytest
from effort import every

from amalthea_uros import check_files
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.network import Direction, Purpose, WireKind
from amalthea_uros.simulate.options import Mode, Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import SECOND, Duration

APP = """
    amuros: 1
    name: test
    hardware: {{frequency: 100 MHz}}
    os: {{tick: 1 ms}}
    middleware:
      agent: {{to_controller: {{min: 100 us, max: 500 us}}, to_host: 1 ms, acknowledgement: {{min: 200 us, max: 800 us}}}}
      transport: {{{transport}}}
      reliable: {{waits: {waits}}}
      executor: {{name: Exec, {executor}, execution_time: 12 us}}
    application:
      nodes:
        - name: node
          subscriptions:
            - {{name: Drive, topic: cmd_vel, rate: 50 Hz, message_size: 48 B, execution_time: 200 us, publishes: [odom]}}
          publishers: [{{topic: odom, message_size: 48 B}}, {{topic: imu, message_size: 312 B, reliability: {imu}}}]
          timers:
            - {{name: Sample, period: 100 ms, execution_time: 100 us, publishes: [imu]}}
    """
INTERRUPT = "interrupt: {name: Receive, execution_time: 3 us}"


def app(transport, executor="period: 10 ms", imu="best-effort"):
    """A periodic executor does not wait for acknowledgements here: nothing behind one that does has a bound."""
    waits = "true" if "loop" in executor else "false"
    return APP.format(transport=transport, executor=executor, imu=imu, waits=waits)


TRANSPORTS = {
    WireKind.SERIAL: f"serial: {{baud_rate: 921600, {INTERRUPT}}}",
    WireKind.USB_CDC: f"usb_cdc: {{latency: 1 ms, {INTERRUPT}}}",
    WireKind.UDP: f"udp: {{bitrate: 10 Mbit/s, latency: 1 ms, {INTERRUPT}}}",
    WireKind.TCP: f"tcp: {{bitrate: 10 Mbit/s, latency: 1 ms, {INTERRUPT}}}",
    WireKind.CAN_FD: f"can_fd: {{bitrate: 500 kbit/s, data_bitrate: 2 Mbit/s, identifiers: {{odom_topic: 0x10}}, {INTERRUPT}}}",
    WireKind.CAN: f"can: {{bitrate: 1 Mbit/s, identifiers: {{odom_topic: 0x10}}, {INTERRUPT}}}",
    WireKind.CUSTOM: f"custom: {{table: [{{size: 512 B, time: {{min: 200 us, max: 900 us}}}}], {INTERRUPT}}}",
}
READ_BY_FRAMES = (WireKind.CAN, WireKind.CAN_FD, WireKind.CUSTOM)
#: Rounds of executors that wait for acknowledgements without a sleep can follow each other at once: nothing behind them has a bound.
EXECUTORS = ["period: 10 ms", "loop: {spin_some: 100 ms, sleep: 10 ms}"]


@pytest.mark.parametrize(("kind", "executor"), every(9, [(kind, each) for kind in TRANSPORTS for each in EXECUTORS]))
def test_no_message_takes_longer_than_its_bound(kind, executor, author):
    text = app(TRANSPORTS[kind], executor, "reliable")
    if kind is WireKind.CAN_FD:
        text = text.replace("312 B", "150 B")  # four frames hold 196 bytes, and more are not sent reliably
    if kind in READ_BY_FRAMES and "loop" in executor:
        # A loop that may read one of two frames in an iteration is too slow: how late it acknowledges what is reliable has no bound.
        text = text.replace("topic: cmd_vel,", "topic: cmd_vel, reliability: best-effort,")
    system = author.describe(text).system
    (wire,) = system.network.wires
    assert wire.kind is kind
    bounds = analyze_system(system).processes
    names = [*system.transmissions, *(isr.name for isr in system.software.isrs)]
    for mode in (Mode.WORST, Mode.SAMPLED):
        found = simulate_system(system, Options(duration=Duration(SECOND), mode=mode))
        assert all(found[name].jobs for name in names if not name.startswith("heartbeat"))
        for name in names:
            response = bounds[name].response
            assert response.worst is not None
            if not found[name].jobs:
                continue  # a heartbeat, when no acknowledgement is missing
            assert response.best <= found[name].response_time.min
            assert found[name].response_time.max <= response.worst


def test_what_is_queued_on_a_serial_line(author):
    network = author.describe(app(TRANSPORTS[WireKind.SERIAL])).system.network
    assert {each.name: (each.direction, each.purpose, each.length) for each in network.transmissions} == {
        # 12 bytes besides the content; 13 of acknowledgements and heartbeats; best effort is not acknowledged.
        "cmd_vel_topic_to_Drive": (Direction.TO_CONTROLLER, Purpose.DATA, 60),
        "cmd_vel_topic_to_Drive_acknowledgement": (Direction.TO_AGENT, Purpose.ACKNOWLEDGEMENT, 13),
        "odom_topic_from_Drive": (Direction.TO_AGENT, Purpose.DATA, 60),
        "odom_topic_from_Drive_acknowledgement": (Direction.TO_CONTROLLER, Purpose.ACKNOWLEDGEMENT, 13),
        "imu_topic_from_Sample": (Direction.TO_AGENT, Purpose.DATA, 324),
        "heartbeat_of_agent": (Direction.TO_CONTROLLER, Purpose.HEARTBEAT, 13),
        "heartbeat_of_agent_acknowledgement": (Direction.TO_AGENT, Purpose.ACKNOWLEDGEMENT, 13),
        "heartbeat_of_client": (Direction.TO_AGENT, Purpose.HEARTBEAT, 13),
        "heartbeat_of_client_acknowledgement": (Direction.TO_CONTROLLER, Purpose.ACKNOWLEDGEMENT, 13),
    }
    by_name = {each.name: each for each in network.transmissions}
    assert by_name["cmd_vel_topic_to_Drive"].processes == ("Receive",)
    assert by_name["cmd_vel_topic_to_Drive"].agent.most == 500 * US
    assert by_name["odom_topic_from_Drive_acknowledgement"].agent.most == 800 * US
    assert by_name["imu_topic_from_Sample"].processes == ()


def test_each_frame_has_an_interrupt_and_each_message_a_round(author):
    text = app(TRANSPORTS[WireKind.SERIAL], "loop: {spin: 1 s}")
    found = simulate_system(author.describe(text).system, Options(duration=Duration(10 * SECOND), mode=Mode.WORST))
    messages = found["cmd_vel_topic_to_Drive"].jobs
    assert found["Receive"].jobs == messages
    to_controller = "odom_topic_from_Drive_acknowledgement", "heartbeat_of_agent", "heartbeat_of_client_acknowledgement"
    others = sum(found[name].jobs for name in to_controller)
    # A frame of 60 bytes has up to 133 bytes with escaped ones, in 4 chunks of 42; one of 13 has 39.
    assert found["Receive_Other"].jobs == pytest.approx(3 * messages + others, abs=4)
    # 50 messages and 10 timers per second; without an interrupt, the wire itself begins the iterations.
    assert calls_of(found) == pytest.approx([500, 100], abs=2)
    system = author.describe(app("serial: {baud_rate: 921600}", "loop: {spin: 1 s}")).system
    assert not system.software.isrs
    found = simulate_system(system, Options(duration=Duration(10 * SECOND), mode=Mode.WORST))
    assert calls_of(found) == pytest.approx([500, 100], abs=2)


def calls_of(simulation):
    return [handle.calls for handle in simulation.executors["Exec"].handles]


def worst_case(system, name):
    result = analyze_system(system).processes[name]
    return result.response.worst if result.response is not None else None


def test_an_unknown_agent_makes_what_it_sends_back_unknown(author):
    text = app(TRANSPORTS[WireKind.SERIAL]).replace(", acknowledgement: {min: 200 us, max: 800 us}", "")
    results = analyze_system(author.describe(text).system)
    reason = "how long 'Agent' takes to acknowledge a message is not stated"
    assert results.processes["odom_topic_from_Drive_acknowledgement"].reason == reason
    # It can come at any time, and delay what else goes to the controller.
    assert results.processes["cmd_vel_topic_to_Drive"].response is None
    # The limit for the whole of the acknowledgement holds for the part of the agent, too.
    limited = text.replace("transport: {", "transport: {acknowledgement: 5 ms, ")
    assert worst_case(author.describe(limited).system, "cmd_vel_topic_to_Drive") is not None


def test_messages_wait_for_those_before_them_on_a_line_without_priorities(author):
    """On UDP at 10 Mbit/s: 126 bytes of cmd_vel and 84 of an acknowledgement or heartbeat, 0.8 us each."""
    bounds = analyze_system(author.describe(app(TRANSPORTS[WireKind.UDP])).system).processes
    alone = 126 * 800_000
    other = 84 * 800_000
    # Before it can be queued: an acknowledgement of odom, a heartbeat, and the answer to one.
    assert bounds["cmd_vel_topic_to_Drive"].response.worst == alone + 3 * other


@pytest.mark.parametrize(
    ("transport", "rule", "text"),
    [
        ("serial: {}, udp: {bitrate: 10 Mbit/s}", "APP003", "more than one wire is described: 'serial' and 'udp'"),
        ("can_fd: {bitrate: 1 Mbit/s, data_bitrate: 500 kbit/s}", "APP003", "'data_bitrate' is lower than 'bitrate'"),
        (
            "custom: {table: [{size: 512 B, time: 1 ms}, {size: 512 B, time: 2 ms}]}",
            "APP003",
            "the sizes in 'table' do not increase",
        ),
        (
            "custom: {table: [{size: 64 B, time: 1 ms}]}",
            "UR134",
            "'imu' needs 324 bytes in one message of the transport, which carries 64 at most",
        ),
        (
            "can: {bitrate: 1 Mbit/s, foreign: [{name: Brake, identifier: 1, bytes: 12, period: 10 ms}]}",
            "APP003",
            "'Brake' has 12 data bytes, but a frame on this bus has 8 at most",
        ),
        (
            "can: {bitrate: 1 Mbit/s, identifiers: {odom_topic: 1}, foreign: [{name: Brake, identifier: 1, period: 10 ms}]}",
            "APP003",
            "'Brake' has the identifier of 'odom_topic', 0x1",
        ),
        (
            "can: {bitrate: 1 Mbit/s, foreign: [{name: Exec, identifier: 1, period: 10 ms}]}",
            "APP002",
            "duplicate process or frame name 'Exec' (first defined on line 9)",
        ),
    ],
)
def test_what_cannot_be(transport, rule, text, author):
    assert (rule, text) in {(found, message) for _, found, message in author.findings(app(transport))}


def warnings(assembly, rule):
    return [(finding.message, finding.help) for finding in assembly.findings if finding.rule == rule]


def test_an_overload_says_what_would_fit(author):
    # Up to 1 + 2 * 66 bytes of odom and 39 of an acknowledgement each 20 ms, 661 of imu each 100 ms: 152,100 bits per second.
    ((message, advice),) = warnings(author.describe(app("serial: {baud_rate: 115200}")), "UR132")
    assert message == "overload: the messages to the agent need up to 132.0 % of 'Serial'"
    assert advice == "Set 'baud_rate: 230400'; or send fewer or smaller messages."
    assert not warnings(author.describe(app("serial: {baud_rate: 230400}")), "UR132")


FOREIGN = "can_fd: {{bitrate: 500 kbit/s, data_bitrate: 2 Mbit/s, identifiers: {{cmd_vel_topic: 0x100}}, foreign: [{}]}}"


def test_frames_of_others_delay_those_of_higher_identifiers(author):
    def worst(frames):
        text = app(FOREIGN.format(frames), imu="best-effort").replace("312 B", "32 B")
        return worst_case(author.describe(text).system, "cmd_vel_topic_to_Drive")

    wins = worst("{name: Brake, identifier: 0x10, period: 100 ms, bytes: 64}")
    loses = worst("{name: Door, identifier: 0x200, period: 100 ms, bytes: 64}")
    # A frame of 64 bytes with an extended identifier: 49 + 8 stuff bits of 2 us and 5 + 512 + 32 + 130 of 0.5 us. One that loses can
    # also be on the bus, instead of one of the client.
    frame = (36 + 13 + 8) * 2 * US + (5 + 512 + 32 + 138 - 8) * US // 2
    assert wins == worst("") + frame
    assert loses == worst("")
    assert worst("{name: Brake, identifier: 0x10}") is None


def test_frames_of_a_database(author):
    pytest.importorskip("cantools")
    (author.path.parent / "car.dbc").write_text(DBC)
    text = app("can: {bitrate: 500 kbit/s, dbc: car.dbc}", imu="best-effort").replace("312 B", "32 B")
    assembly = author.describe(text)
    frames = {each.name: each.length for each in assembly.system.network.transmissions if each.purpose is Purpose.FOREIGN}
    assert frames == {"Brake": 8, "Diagnosis": 3}
    assert [message for message, _ in warnings(assembly, "UR133")] == [
        "'Diagnosis' has no cycle time, so that the waiting of all messages of lower priority is unknown"
    ]
    found = simulate_system(assembly.system, Options(duration=Duration(SECOND), mode=Mode.WORST))
    assert (found["Brake"].jobs, found["Brake"].response_time.min >= 270 * US) == (100, True)
    missing = text.replace("car.dbc", "lorry.dbc")
    assert [(rule, "not found" in message) for _, rule, message in author.findings(missing)] == [("APP001", True)]


DBC = """VERSION ""
NS_ :
BS_:
BU_: Car
BO_ 16 Brake: 8 Car
 SG_ Pressure : 0|8@1+ (1,0) [0|255] "" Vector__XXX
BO_ 1792 Diagnosis: 3 Car
 SG_ Code : 0|8@1+ (1,0) [0|255] "" Vector__XXX
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_DEF_DEF_ "GenMsgCycleTime" 0;
BA_ "GenMsgCycleTime" BO_ 16 10;
"""


def test_frames_without_a_jitter_are_assumed_to_be_on_time(author):
    foreign = "{name: Brake, identifier: 1, period: 10 ms}, {name: Door, identifier: 2, period: 10 ms, jitter: 1 ms}"
    text = app(f"can: {{bitrate: 500 kbit/s, foreign: [{foreign}]}}", imu="best-effort").replace("312 B", "32 B")
    sentence = "foreign frames without a stated jitter never come earlier than their period: Brake"
    assert sentence in analyze_system(author.describe(text).system).assumptions


def test_a_polling_driver_keeps_the_processor_busy(author):
    def times(driver):
        system = author.describe(app(f"serial: {{baud_rate: 921600, driver: {driver}}}")).system
        result = analyze_system(system).processes["Sample"]
        return result.bcet, result.wcet

    waits, polls, calls = map(times, ("{}", "{write: polling}", "{write_cost: 2 us}"))
    # 661 bytes of imu if all are escaped; a tick of the processor is 10 ns. The bytes are copied while they are on the line: a
    # message that left after the copying would be on the line twice, and its least latency too high.
    for size, without, busy in zip((0, 661), waits, polls, strict=True):
        assert busy - without == pytest.approx(size * 10 * SECOND / 921600, abs=10**4)
    # 8 or 16 chunks with 2 us each.
    assert [with_calls - without for with_calls, without in zip(calls, waits, strict=True)] == [16 * US, 32 * US]


def test_a_classic_bus_stays_outside_where_nothing_asks_for_it(author):
    quiet = app("can: {bitrate: 1 Mbit/s}").replace("agent:", "x-agent:")
    assembly = author.describe(quiet)
    assert not assembly.system.network.wires
    assert "CAN" in assembly.system_with_bus().cores
    for asked in (
        app("can: {bitrate: 1 Mbit/s}"),
        quiet.replace("period: 10 ms", "loop: {spin: 1 s}"),
        quiet.replace("bitrate: 1 Mbit/s", "bitrate: 1 Mbit/s, foreign: [{name: Brake, identifier: 1, period: 10 ms}]"),
    ):
        whole = author.describe(asked)
        assert [wire.kind for wire in whole.system.network.wires] == [WireKind.CAN]
        assert whole.system_with_bus() == whole.system


@pytest.mark.parametrize(
    ("baud_rate", "sleep", "size", "message"),
    [
        # 11520 bytes per second at 115200 baud, less than two messages in 10 ms.
        (115200, 10, 115, "116"),
        (115200, 10, 116, None),
        # Not more than what is sent: 100 ms are 5 periods of 20 ms, and 2 messages more; each is a frame of 1 + 2 * (60 + 6) bytes.
        (921600, 100, 7 * 133 - 1, "931"),
        (921600, 100, 7 * 133, None),
    ],
)
def test_bytes_that_arrive_while_the_loop_sleeps(author, baud_rate, sleep, size, message):
    found = author.describe(f"""
        amuros: 1
        name: ring
        hardware: {{frequency: 100 MHz}}
        middleware:
          executor: {{name: Exec, loop: {{spin_some: 100 ms, sleep: {sleep} ms}}}}
          transport: {{serial: {{baud_rate: {baud_rate}, driver: {{read: dma, tick: 1 ms, buffer: {size} B}}}}}}
        application:
          nodes:
            - name: node
              subscriptions:
                - {{name: Drive, topic: cmd, rate: 50 Hz, message_size: 48 B, execution_time: 2 us, reliability: best-effort}}
        """).findings
    expected = f"up to {message} bytes can arrive while the loop of 'Exec' sleeps for {sleep} ms and nothing is read, "
    assert [each.message for each in found if each.rule == "UR139"] == (
        [f"{expected}more than the receive buffer of {size}"] if message else []
    )


def test_an_imu_through_a_driver_that_waits_in_ticks(author):
    """8 chunks are 8 ms: the 125 Hz that users measured at 921600 baud (micro-ROS/micro_ros_stm32cubemx_utils#72)."""
    found = author.describe("""
        amuros: 1
        name: stm32
        hardware: {frequency: 100 MHz}
        middleware:
          executor: {loop: {spin_some: 100 ms, sleep: 1 ms}}
          transport: {serial: {baud_rate: 921600, driver: {write: dma, tick: 1 ms}}}
        application:
          nodes:
            - name: node
              publishers: [{topic: imu, message_size: 312 B, reliability: best-effort}]
              timers: [{name: Report, period: 1 s, execution_time: 2 us, publishes: [imu]}]
        """).findings
    (message,) = (each.message for each in found if each.rule == "UR135")
    assert "42,000 bytes per second at most" in message
    assert "a message of 'imu' takes 8 ms or more, so that 125 are sent per second at most" in message


UNACKNOWLEDGED = app(TRANSPORTS[WireKind.UDP]).replace("size: 48 B", "size: 48 B, reliability: best-effort")


def test_an_interrupt_for_frames_that_do_not_exist_is_left_out(author):
    # Datagrams of 60 bytes are one frame each; nothing is acknowledged, so that there are no heartbeats either.
    system = author.describe(UNACKNOWLEDGED).system
    assert [isr.name for isr in system.software.isrs] == ["Receive"]
    bounds = analyze_system(system).processes
    assert all(bounds[name].response is not None for name in ("Receive", "Drive", "Sample"))
    # Without messages to the controller there is no interrupt at all.
    silent = UNACKNOWLEDGED.replace("subscriptions:", "x-subscriptions:")
    assert not author.describe(silent).system.software.isrs


def test_messages_carry_the_effect_of_chains(author):
    chains = "chains: [{name: there, path: [/cmd_vel, Drive, /odom]}]"
    author.path.write_text(f"{dedent(app(TRANSPORTS[WireKind.UDP]))}\n{chains}\n")
    assert [found for found in check_files(author.path).findings if found.rule == "TIM-CHAIN-CARRIED"] == []


QUICK = UNACKNOWLEDGED.replace(
    "middleware:",
    "middleware:\n      profile: zenoh-pico\n      tasks: [{name: zenoh_read, priority: 9, execution_time: 30 us}]",
    1,
)


def test_messages_that_keep_a_connection_alive_are_on_the_wire(author):
    # A third of the lease of 10 s; they are not answered.
    system = author.describe(QUICK).system
    found = {each.name: each.length for each in system.network.transmissions if each.purpose is not Purpose.DATA}
    assert found == {"heartbeat_of_agent": 1, "heartbeat_of_client": 1}
    bounds = analyze_system(system).processes
    # The longest of 84 bytes for less than the least frame, 0.8 us each, can be before a message.
    (message,) = (bounds[each.name] for each in system.network.transmissions if each.topic == "cmd_vel")
    assert message.response.worst - message.response.best == 84 * 800_000


def test_a_message_that_can_be_dropped_has_no_bound(author):
    chains = "chains: [{name: there, path: [/cmd_vel, Drive, /odom]}, {name: drive, path: [/cmd_vel, Drive]}]"
    analysis = analyze_system(author.describe(f"{dedent(QUICK)}\n{chains}\n").system)
    assert analysis.chains["there"].worst is None
    assert analysis.chains["there"].loss == "a message of 'odom' is dropped if another thread of the middleware is sending"
    assert analysis.chains["drive"].worst is not None
