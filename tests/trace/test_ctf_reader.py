"""CTF traces of Zephyr, Linux and ROS 2, written byte by byte."""

import os
import shutil
import struct
import subprocess
from contextlib import suppress
from pathlib import Path
from random import Random

import pytest
from ctf_traces import PacketWriter, ros2_writer, write_zephyr, zephyr_event, zephyr_metadata
from hypothesis import given
from hypothesis import strategies as st
from state_charts import check_trace
from traces import told

from amalthea_uros.errors import InvalidArgumentError, ReadError
from amalthea_uros.trace.ctf.metadata import described, read_metadata
from amalthea_uros.trace.ctf.streams import PacketStream
from amalthea_uros.trace.ctf.types import ArrayType, IntegerType, StringType
from amalthea_uros.trace.files import TraceProblems, UnreadableError
from amalthea_uros.trace.readers import format_of, open_trace
from amalthea_uros.trace.table import EventKind

A, B, IDLE = (0x2000, "A"), (0x2100, "B"), (0x1000, "idle")
BABELTRACE = shutil.which(os.environ.get("BABELTRACE2", "babeltrace2"))


def rules(reader) -> list[str]:
    return [finding.rule for finding in reader.findings]


@pytest.fixture
def read(tmp_path):
    """Reads events of Zephyr: gives them, and the rules of the findings."""

    def read(events: list[bytes], core_id: bool = False):
        path = write_zephyr(tmp_path / "trace", events, core_id)
        reader = open_trace(path)
        return told(reader), rules(reader)

    return read


def test_zephyr(tmp_path):
    e = zephyr_event
    events = [
        e(100, "thread_switched_out", IDLE),
        e(100, "thread_switched_in", A),
        e(1000, "isr_enter"),
        e(1200, "thread_ready", B),
        e(1300, "isr_exit"),
        e(1400, "thread_switched_out", A),
        e(1400, "thread_switched_in", B),
        e(1500, "named_event", (0, "B|work")),
        e(1600, "named_event", (0, "E|work")),
        e(1650, "named_event", (0, "moment")),
        e(1700, "thread_pending", B),
        e(1800, "thread_switched_out", B),
        e(1800, "thread_switched_in", A),
        e(2100, "thread_switched_out", A),
        e(2100, "thread_switched_in", IDLE),
        # A has said nothing, but it was not ready in between: it had blocked, as in k_sleep.
        e(9000, "thread_ready", A),
    ]
    path = write_zephyr(tmp_path / "trace", events)
    assert format_of(path).name == "CTF"
    assert told(open_trace(path)) == [
        "100 resume A#0",
        "1000 preempt A#0",
        "1000 start ISR#0",
        "1200 activate B#0",
        "1300 terminate ISR#0",
        "1300 resume A#0",
        "1400 preempt A#0",
        "1400 start B#0",
        "1500 runnable_start work#0 by B#0",
        "1600 runnable_terminate work#0 by B#0",
        "1650 runnable_start moment#0 by B#0",
        "1650 runnable_terminate moment#0 by B#0",
        "1800 terminate B#0",
        "1800 resume A#0",
        "2100 terminate A#0",
        "9000 activate A#1",
    ]
    assert check_trace(path) == ()


@pytest.mark.parametrize(
    ("events", "lines"),
    [
        (
            [(1, "thread_switched_in"), (5, "thread_pending"), (7, "thread_ready")],
            ["1 resume A#0", "7 terminate A#0", "7 activate A#1", "7 start A#1"],
        ),
        (
            [(1, "thread_switched_in"), (5, "thread_pending"), (6, "isr_enter"), (7, "thread_ready"), (8, "isr_exit")],
            [*("1 resume A#0", "6 terminate A#0", "6 start ISR#0"), *("7 activate A#1", "8 terminate ISR#0", "8 start A#1")],
        ),
    ],
    ids=["by itself", "by an interrupt"],
)
def test_a_thread_that_becomes_ready_before_it_has_left_the_core_begins_a_new_job(read, events, lines):
    assert read([zephyr_event(time, name, A) for time, name in events])[0] == lines


def test_two_cores(read):
    e = zephyr_event
    events = [
        e(1, "thread_switched_in", A, core=0),
        e(2, "thread_switched_in", B, core=1),
        e(3, "thread_switched_out", A, core=0),
    ]
    lines, findings = read([*events, e(4, "isr_enter", core=1)], core_id=True)
    assert lines == ["1 resume A#0", "2 resume B#0", "3 preempt A#0", "4 preempt B#0", "4 start ISR#0"]
    assert findings == []


def test_threads_of_the_same_name_without_one_and_at_the_same_address(read):
    threads = [(1, "A"), (2, "A"), (3, ""), (4, "unknown"), (1, "B")]
    lines, _ = read([zephyr_event(time, "thread_ready", thread) for time, thread in enumerate(threads)])
    assert [line.split(" ", 2)[2] for line in lines] == ["A#0", "A (0x2)#0", "thread 0x3#0", "thread 0x4#0", "B#0"]


def test_a_thread_that_is_created_has_not_executed_before(read):
    """It gets its name after its creation; without the creation the first job would go on with an unknown start."""
    events = [zephyr_event(1, "thread_create", (1, "unknown")), zephyr_event(2, "thread_switched_in", (1, "A"))]
    assert read(events)[0] == ["2 start A#0"]


def test_a_clock_that_overflows(read):
    """Every ms an event: stamps of 32 bits overflow after 4.295 s, which is no finding."""
    times = range(0, 9 * 10**9, 10**7)
    lines, findings = read(
        [zephyr_event(time, "isr_enter" if number % 2 else "isr_exit") for number, time in enumerate(times, 1)]
    )
    assert [int(line.split()[0]) for line in lines] == list(times)
    assert findings == []


def test_a_clock_that_starts_again_early(read):
    """With 300 MHz the cycle counter of 32 bits starts again after 14.3 s, and with it the stamps: 2.86 s seem to be missing."""
    wrap = 2**32 * 10 // 3
    times = range(0, 16 * 10**9, 10**7)
    events = [zephyr_event(time % wrap, "thread_ready", (number, "A")) for number, time in enumerate(times)]
    lines, findings = read(events)
    gaps = [line for line in lines if "gap" in line]
    assert findings == ["TRC023"]
    assert len(gaps) == 1
    # The rest is 2.86 s late.
    assert int(lines[-1].split()[0]) - times[-1] == pytest.approx(-wrap % 2**32, abs=1)


@pytest.mark.parametrize(
    "rest",
    [[zephyr_event(2, "thread_ready", B)[:-3]], [struct.pack("<IB", 2, 0xEE), zephyr_event(3, "thread_ready", B)]],
    ids=["the end is missing", "unknown event"],
)
def test_a_stream_without_packets_is_read_up_to_the_damage(read, rest):
    assert read([zephyr_event(1, "thread_ready", A), *rest]) == (["1 activate A#0", "1 gap"], ["TRC020"])


T = 5 * 10**9
TALKER, LISTENER = (7, 70, "talker"), (8, 80, "listener")


def ros2_events(w: PacketWriter, start: int = T) -> list[bytes]:
    def event(time: int, name: str, thread: tuple, *values: object) -> bytes:
        return w.event(
            start + time, name if name.startswith("sched") else f"ros2:{name}", thread, *values, is_extended=time % 2 == 1
        )

    return [
        event(0, "rcl_node_init", TALKER, 1, 0, "talker", "/"),
        event(1, "rcl_publisher_init", TALKER, 2, 3, 1, "/chatter", 10),
        event(2, "rcl_timer_init", TALKER, 4, 100_000_000),
        event(3, "rclcpp_timer_callback_added", TALKER, 4, 5),
        event(4, "rclcpp_timer_link_node", TALKER, 4, 1),
        # The same addresses in another process are other things.
        event(5, "rcl_node_init", LISTENER, 1, 0, "listener", "/robot"),
        event(6, "rcl_subscription_init", LISTENER, 2, 3, 1, "/chatter", 10),
        event(7, "rclcpp_subscription_init", LISTENER, 2, 4),
        event(8, "rclcpp_subscription_callback_added", LISTENER, 4, 5),
        event(9, "rclcpp_callback_register", LISTENER, 5, "void (Message)"),
        event(100, "callback_start", TALKER, 5, 0),
        event(200, "rmw_publish", TALKER, 3, 9, 1111),
        event(250, "callback_end", TALKER, 5),
        event(300, "rmw_take", LISTENER, 3, 9, 0, 0),
        event(310, "rmw_take", LISTENER, 3, 9, 1111, 1),
        event(320, "callback_start", LISTENER, 5, 0),
        event(400, "callback_end", LISTENER, 5),
        event(500, "rmw_publish", TALKER, 3, 9, 2222),
        event(600, "callback_end", LISTENER, 5),
    ]


ROS2_EVENTS = [
    "100 runnable_start talker timer 100 ms#0 by talker#0",
    "200 chain_step /chatter -> robot/listener#0 by talker#0 step 0",
    "250 runnable_terminate talker timer 100 ms#0 by talker#0",
    "320 chain_step /chatter -> robot/listener#0 by listener#0 step 1",
    "320 runnable_start robot/listener subscription /chatter#0 by listener#0",
    "400 runnable_terminate robot/listener subscription /chatter#0 by listener#0",
    "500 chain_step /chatter -> robot/listener#1 by talker#0 step 0",
]


@pytest.mark.parametrize("order", "<>")
def test_ros2_callbacks_and_messages(tmp_path, order):
    w = ros2_writer(order)
    events = ros2_events(w)
    # Both processes have their buffers; the folders are those of a session.
    path = w.write(tmp_path / "session" / "ust" / "64-bit", [w.packet(T, events[:7], spare=64), w.packet(T, events[7:], 1)])
    reader = open_trace(tmp_path / "session")
    lines = told(reader)
    # Times count from the first event, as they cannot count from 1970.
    assert lines == ROS2_EVENTS
    # The end of the second execution has no begin.
    assert rules(reader) == ["TRC021"]
    assert format_of(path).name == "CTF"


def test_ros2_with_the_scheduler_of_linux(tmp_path):
    """Callbacks are suspended with their thread; that has blocked (state 1) within a callback, so it waits."""
    w = ros2_writer()

    def switch(time: int, before: tuple[str, int], state: int, after: tuple[str, int]) -> bytes:
        return w.event(T + time, "sched_switch", (0, 0, ""), before[0], before[1], 20, state, after[0], after[1], 20)

    ust = [w.event(T + 100, "ros2:callback_start", TALKER, 5, 0), w.event(T + 400, "ros2:callback_end", TALKER, 5)]
    kernel = [
        switch(50, ("swapper/0", 0), 0, ("talker", 70)),
        switch(200, ("talker", 70), 1, ("swapper/0", 0)),
        switch(300, ("swapper/0", 0), 0, ("talker", 70)),
        switch(450, ("talker", 70), 1, ("swapper/0", 0)),
    ]
    w.write(tmp_path / "trace", [w.packet(T, ust)], [w.packet(T, kernel)])
    lines = [line.split(" ", 1) for line in told(open_trace(tmp_path / "trace"))]
    assert [f"{int(time) + 50} {rest}" for time, rest in lines] == [
        "50 resume talker#0",
        "100 runnable_start callback 0x5#0 by talker#0",
        "200 runnable_suspend callback 0x5#0 by talker#0",
        "200 wait talker#0",
        "300 release talker#0",
        "300 resume talker#0",
        "300 runnable_resume callback 0x5#0 by talker#0",
        "400 runnable_terminate callback 0x5#0 by talker#0",
        "450 terminate talker#0",
    ]


def starts(w: PacketWriter, time: int, number: int = 3) -> list[bytes]:
    return [w.event(T + time + each, "ros2:callback_start", TALKER, 100 + each + time, 0) for each in range(number)]


def test_lost_events_and_packets_are_gaps(tmp_path):
    w = ros2_writer()
    packets = [
        w.packet(T, starts(w, 0), 0),
        w.packet(T + 1000, starts(w, 1000), 1, 5),
        w.packet(T + 2000, starts(w, 2000), 4, 5),
    ]
    reader = open_trace(w.write(tmp_path / "trace", packets))
    notes = [note for table in reader for kind, note in zip(table.kind, table.note, strict=True) if kind == EventKind.GAP]
    # The five lost events may have been before the packet or in it, so that neither is crossed. Two packets are missing at its end.
    assert notes == [5, 0]
    assert rules(reader) == ["TRC022", "TRC022"]


def test_a_damaged_packet_is_left_out_and_the_next_one_is_found(tmp_path):
    w = ros2_writer()
    packets = [w.packet(T + 1000 * number, starts(w, 1000 * number), number) for number in range(3)]
    packets[1] = b"\xff" * 40 + packets[1][40:]
    reader = open_trace(w.write(tmp_path / "trace", packets))
    assert [line.split()[1] for line in told(reader)] == ["runnable_start"] * 3 + ["gap"] + ["runnable_start"] * 3
    assert rules(reader) == ["TRC020", "TRC022"]


def test_packets_of_several_cores_in_one_file(tmp_path):
    w = ros2_writer()
    packets = [w.packet(T + time, starts(w, time), number, core=number) for number, time in enumerate([5000, 0])]
    reader = open_trace(w.write(tmp_path / "trace", packets))
    assert [line.split()[1] for line in told(reader)] == ["runnable_start"] * 3 + ["gap"]
    assert rules(reader) == ["TRC020", "TRC004"]


def test_metadata_in_packets(tmp_path):
    text = zephyr_metadata().encode()
    halves = [text[:700], text[700:]]
    packed = b""
    for half in halves:
        size = (37 + len(half)) * 8
        packed += struct.pack("<I16sIIIBBBBB", 0x75D11D57, bytes(16), 0, size, size, 0, 0, 0, 1, 8) + half
    (tmp_path / "metadata").write_bytes(packed)
    assert read_metadata(tmp_path / "metadata") == described(text.decode())


def test_types_of_metadata():
    metadata = described(
        """/* CTF 1.8 */
        trace { major = 1; minor = 8; byte_order = be; };
        typealias integer { size = 32; signed = false; } := unsigned int;
        typealias integer { size = 16; align = 16; signed = true; byte_order = le; } := short_t;
        typedef short_t other_t;
        struct point { unsigned int x, y; };
        event { name = "e"; id = 1 + 0; fields := struct { string s; other_t list[2][x]; struct point p; }; };
        """.replace("1 + 0", "0x1")
    )
    fields = dict(metadata.streams[0].events[1].fields.fields)
    assert fields["s"] == StringType()
    assert fields["list"] == ArrayType(ArrayType(IntegerType(16, 16, True), "x"), 2)
    assert [name for name, _ in fields["p"].fields] == ["x", "y"]
    assert fields["p"].fields[0][1] == IntegerType(32, 8, False, is_big_endian=True)


@pytest.mark.parametrize(
    "text",
    [
        "event { name = ",
        "typealias integer { size = 65; } := a;",
        "typealias integer { size = 8; align = 3; } := a;",
        "event { fields := struct { unknown_t x; }; };",
        "event { fields := " + "struct { " * 1000,
        "clock { name = c; freq = 0; };",
        "@",
    ],
)
def test_metadata_that_are_wrong(text, tmp_path):
    with pytest.raises(UnreadableError):
        described(text)
    (tmp_path / "metadata").write_text(text)
    with pytest.raises(ReadError) as error:
        list(open_trace(tmp_path))
    assert [finding.rule for finding in error.value.findings] == ["TRC024"]


def test_a_folder_without_a_trace(tmp_path):
    with pytest.raises(InvalidArgumentError, match="folder with a CTF trace"):
        open_trace(tmp_path)


def test_a_trace_of_something_else(tmp_path):
    w = PacketWriter()
    w.define("something", "I", value="uint32_t")
    reader = open_trace(w.write(tmp_path / "trace", [w.packet(T, [w.event(T, "something", TALKER, 1)])]))
    assert told(reader) == []
    assert rules(reader) == ["TRC003"]


# Types that grow without bits: the structures of 2^60 elements, and an array of nothing.
DOUBLING = "struct s0 { }; " + " ".join(f"struct s{n} {{ struct s{n - 1} a; struct s{n - 1} b; }};" for n in range(1, 61))
HOSTILE = [
    DOUBLING + " event { name = isr_enter; id = 0; fields := struct { struct s60 f; }; };",
    "struct s0 { }; event { name = isr_enter; id = 0; fields := struct { struct s0 f[4000000000]; }; };",
    "event { name = isr_enter; id = 0; fields := struct { u8 n; u8 f[n]; u8 g[1000000000]; }; };",
]


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_metadata_end_soon(text, tmp_path):
    common = "typealias integer { size = 8; } := u8; trace { byte_order = le; }; stream { event.header := struct { u8 timestamp; }; };"
    (tmp_path / "metadata").write_text(common + text)
    (tmp_path / "stream").write_bytes(bytes(10_000))
    reader = open_trace(tmp_path)
    assert told(reader) == []
    assert "TRC020" in rules(reader)


@given(
    which=st.booleans(),
    in_metadata=st.booleans(),
    places=st.lists(st.tuples(st.floats(0, 1), st.binary(max_size=12), st.integers(0, 12)), max_size=5),
)
def test_any_damage_gives_findings_and_the_rest(tmp_path_factory, which, in_metadata, places):
    folder = tmp_path_factory.mktemp("ctf") / "trace"
    w = ros2_writer()
    if which:
        events = ros2_events(w)
        w.write(folder, [w.packet(T, events[:9]), w.packet(T + 10, events[9:], 1)])
    else:
        write_zephyr(
            folder, [zephyr_event(time, name, A) for time, name in enumerate(["thread_switched_in", "thread_ready"] * 20)]
        )
    path = folder / "metadata" if in_metadata else folder / "channel0_0"
    content = path.read_bytes()
    for place, breaker, length in places:
        at = int(place * len(content))
        content = content[:at] + breaker + content[at + length :]
    path.write_bytes(content)
    reader = open_trace(folder)
    with suppress(ReadError):  # of metadata that are not understood
        times = [int(time) for table in reader for time in table.time]
        assert times == sorted(times)
        check_trace(folder)


def babeltrace(folder: Path) -> list[str]:
    """What the reference implementation says of each event: nanoseconds and name."""
    command = [BABELTRACE, "--clock-cycles", "--names=none", "--fields=", str(folder)]
    result = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    return result.stdout.splitlines()


@pytest.mark.skipif(BABELTRACE is None, reason="needs babeltrace2")
@pytest.mark.parametrize("order", "<>")
def test_the_reference_implementation_reads_the_same(tmp_path, order):
    random, w = Random(1), ros2_writer(order)
    time, packets = T, []
    for sequence in range(5):
        events, begin = [], time
        for _ in range(50):
            time += random.choice([1, 1000, 10**6])
            events.append(
                w.event(time, "ros2:callback_start", TALKER, random.getrandbits(64), 1, is_extended=random.random() < 0.3)
            )
        packets.append(w.packet(begin, events, sequence, length=time - begin, spare=random.randrange(9)))
    folder = w.write(tmp_path / "trace", packets)
    own = list(PacketStream(folder / "channel0_0", read_metadata(folder / "metadata"), TraceProblems(None)))
    theirs = babeltrace(folder)
    assert len(own) == len(theirs) == 250
    for event, line in zip(own, theirs, strict=True):
        ticks = event.time // 1000 - 1_700_000_000 * 10**9 - 5
        assert f"[{ticks:020d}]" in line
        assert f"{event.fields['callback']}" in line
