"""How long messages are on the wire, against the arithmetic of the protocols and published measurements.

Messages of XRCE-DDS have 12 bytes besides their content, an acknowledgement has 13; a frame of a stream has 7 bytes more. At 8N1, a
byte is 10 bits.
"""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.perf.network import Direction, Span
from amalthea_uros.spec.transports import CanFd, CustomTransport, NetworkSection, Serial, UsbCdc
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import MILLISECOND as MS
from amalthea_uros.uros.transports import framing
from amalthea_uros.uros.transports.can import CanBus, CanFdLine, Identifier, bits, data_bytes, frames, max_message_bits
from amalthea_uros.uros.transports.driven import (
    CustomLine,
    SerialLine,
    TcpLine,
    UdpLine,
    UsbCdcLine,
    bytes_between_reads,
    steady_time,
)
from amalthea_uros.uros.transports.line import time_on

IN, OUT = Direction.TO_CONTROLLER, Direction.TO_AGENT
#: Bytes of the messages of XRCE-DDS, for contents of 4, 8, 48 and 312 bytes.
INT32, INT64, TWIST, IMU, ACKNACK = 16, 20, 60, 324, 13


def serial(**keys):
    return SerialLine(section=Serial.model_validate(keys), tick=None)


@pytest.mark.parametrize(
    ("length", "frame", "slow", "slow_and_back", "fast", "fast_and_back"),
    # Milliseconds of frames without escaped bytes at 115200 and 921600 baud, and with the acknowledgement of 20 bytes.
    [
        (INT32, 23, 2.00, 3.73, 0.25, 0.47),
        (INT64, 27, 2.34, 4.08, 0.29, 0.51),
        (TWIST, 67, 5.82, 7.55, 0.73, 0.94),
        (IMU, 331, 28.7, 30.5, 3.59, 3.81),
    ],
)
def test_messages_on_serial_lines(length, frame, slow, slow_and_back, fast, fast_and_back):
    assert framing.least_frame(length) == frame
    for baud_rate, alone, and_back in ((115200, slow, slow_and_back), (921600, fast, fast_and_back)):
        line = serial(baud_rate=baud_rate)
        there, back = (time_on(line, line.frames(size, OUT))[0] for size in (length, ACKNACK))
        digits = 1 if alone > 10 else 2
        assert (round(there / MS, digits), round((there + back) / MS, digits)) == (alone, and_back)


def test_each_byte_after_the_flag_can_be_escaped():
    line = serial()
    # 27 bytes of which 26 are sent as two; 10 bits per byte at 115200 baud.
    least, most = time_on(line, line.frames(INT64, OUT))
    assert (least, most) == (270 * 10**12 // 115200, -(-530 * 10**12 // 115200))


@given(st.binary(max_size=600))
def test_no_frame_is_outside_the_bounds(message):
    escaped = sum(byte in b"\x7d\x7e" for byte in message)
    assert framing.least_frame(len(message)) <= len(message) + 7 + escaped <= framing.longest_frame(len(message))
    for frame in (framing.least_frame(len(message)), framing.longest_frame(len(message))):
        assert sum(framing.chunks(frame)) == frame
        assert max(framing.chunks(frame)) <= 42


@pytest.mark.parametrize("frames", [framing.in_chunks, framing.in_bytes])
@pytest.mark.parametrize("length", [2, INT64, IMU])
def test_of_random_bytes_one_of_128_is_escaped_on_average(frames, length):
    """The mean of a sum is the sum of the means: each byte after the flag adds 2/256 of a byte, of 10 bits."""
    weighted = [frame.weights or ((frame.least, 1),) for frame in frames(length, 10)]
    means = [sum(ticks * weight for ticks, weight in each) / sum(weight for _, weight in each) for each in weighted]
    assert sum(means) == pytest.approx(10 * (length + 7 + (length + 6) / 128), rel=1e-6)


def test_how_often_bytes_of_a_short_frame_are_escaped():
    """Of 8 bytes none is escaped with (127/128)**8, and one with 8 (127**7 / 128**8); all 8 are possible."""
    (frame,) = framing.in_chunks(2, 1)
    weights = dict(frame.weights)
    assert (weights[9], weights[10]) == (round(1e9 * (127 / 128) ** 8), round(8e9 * 127**7 / 128**8))
    assert weights[17] == 1
    assert sum(weights.values()) == pytest.approx(1e9)


def test_dma_takes_a_tick_per_chunk():
    """A message of Imu at 921600 baud and ticks of 1 ms: 8 chunks, so the 125 Hz that users measured
    (micro-ROS/micro_ros_stm32cubemx_utils#72)."""
    line = serial(baud_rate=921600)
    chunks = [frame for frame in line.frames(IMU, OUT) if frame.least]
    assert len(chunks) == 8
    assert steady_time(chunks, MS, 921600) == 8 * MS


def test_the_bound_of_dma_holds_for_any_phase_of_the_tick():
    waits = serial(baud_rate=921600, driver={"write": "dma", "tick": "1 ms"})
    waits = SerialLine(section=waits.section, tick=waits.section.driver.tick)
    # 649 bytes at most are 15 chunks of 42 bytes, which are on the line for 456 us, and one of 19. The first one can be started
    # just after a tick, and is seen up to a tick late; each other one takes a tick, rounded up to whole symbols of 1.1 us.
    most = time_on(waits, waits.frames(IMU, OUT))[1]
    assert 15 * MS + MS + 455 * US < most <= 15 * MS + MS + (456 + 16 * 2) * US
    # Nothing waits for ticks in the other direction on the wire, but then in the driver: the head, and 16 pieces of 41 bytes, each of
    # which can go round the end of the buffer.
    assert time_on(waits, waits.frames(IMU, IN))[1] < 8 * MS
    reads = SerialLine(section=Serial.model_validate({"driver": {"read": "dma"}}), tick=MS)
    assert reads.reading(IMU) == Span(most=33 * MS)
    # Without escaped bytes, an acknowledgement needs the 2..3 calls of a short message.
    assert framing.reads(framing.least_frame(ACKNACK)) == (2, 3)


def test_an_unknown_tick_makes_the_driver_unknown():
    line = SerialLine(section=Serial.model_validate({"driver": {"read": "dma"}}), tick=None)
    assert line.reading(INT32).most is None


def test_bytes_that_arrive_between_two_reads():
    # 11520 bytes per second at 115200 baud.
    assert bytes_between_reads(115200, 10, 100 * MS) == 1152
    assert bytes_between_reads(115200, 10, 100 * MS + 1) == 1153


@pytest.mark.parametrize(
    ("length", "size"),
    # A best-effort message of 48 bytes and a reliable one of 44 have 60 and 60 bytes with their headers; 63 fill a frame.
    [(0, 1), (7, 8), (8, 12), (11, 12), (12, 16), (16, 20), (20, 24), (24, 32), (32, 48), (48, 64), (60, 64), (63, 64)],
)
def test_frames_of_can_fd_have_the_next_size_of_a_length_code(length, size):
    assert data_bytes(length) == size


@pytest.mark.parametrize("data", [0, 1, 8, 12, 16, 20, 24, 32, 48, 64])
def test_bits_of_can_fd_by_hand(data):
    """ISO 11898-1:2015: 17 bits before the switch with a standard identifier, 36 with an extended one; ESI and length code; a stuff
    count of 4 bits, a CRC of 17 or 21 bits with 6 or 7 fixed stuff bits; 13 bits after them."""
    crc = 4 + 17 + 6 if data <= 16 else 4 + 21 + 7
    for extended, head in ((False, 17), (True, 36)):
        least, most = bits(data, extended=extended)
        assert least == (head + 13, 5 + 8 * data + crc)
        # A stuff bit after the first 5 equal bits, and after each 4 bits more.
        stuffed = (head + 5 + 8 * data - 1) // 4
        assert sum(most) - sum(least) == stuffed


def test_a_can_fd_frame_at_two_bit_rates():
    line = CanFdLine(section=CanFd.model_validate({"bitrate": "500 kbit/s", "data_bitrate": "2 Mbit/s"}))
    # Int64: 21 bytes in a frame of 24: 49 bits of 2 us, 5 + 192 + 32 of 0.5 us.
    assert time_on(line, line.frames(INT64, OUT))[0] == (49 * 2000 + 229 * 500) * 1000


def test_a_short_foreign_frame_on_can_fd_can_be_a_classic_one():
    line = CanFdLine(section=CanFd.model_validate({"bitrate": "500 kbit/s", "data_bitrate": "2 Mbit/s"}))
    longest = CanBus(bit_rate=500_000)
    assert time_on(line, [line.foreign(8, extended=False)])[1] == longest.duration(longest.max_frame_bits(8)) == 270 * US


def network(kind, **keys):
    return kind(section=NetworkSection.model_validate({"bitrate": "10 Mbit/s", **keys}), tick=None)


def test_udp():
    line = network(UdpLine)
    # 28 bytes of IPv4 and UDP, 18 of Ethernet, 20 of preamble and gap.
    assert time_on(line, line.frames(TWIST, OUT)) == ((60 + 28 + 18 + 20) * 800_000,) * 2
    # The content of an Ethernet frame is filled up to 46 bytes (IEEE 802.3).
    assert time_on(line, line.frames(ACKNACK, OUT)) == ((46 + 18 + 20) * 800_000,) * 2
    assert line.link.most is None
    stated = network(UdpLine, overhead="70 B", latency="2 ms")
    assert time_on(stated, stated.frames(TWIST, OUT)) == ((60 + 70) * 800_000,) * 2
    assert stated.link == Span(least=2 * MS, most=2 * MS)


def test_tcp():
    line = network(TcpLine)
    assert time_on(line, line.frames(TWIST, OUT)) == ((60 + 2 + 40 + 18 + 20) * 800_000,) * 2
    # 2050 bytes of the stream are a segment of 1460 and one of 590.
    assert [frame.most for frame in line.frames(2048, OUT)] == [8 * (1460 + 78), 8 * (590 + 78)]


def test_usb():
    line = UsbCdcLine(section=UsbCdc(), tick=None)
    # 27 bytes in one packet with 13 more.
    assert time_on(line, line.frames(INT64, IN))[0] == (27 + 13) * 8 * 10**6 // 12
    # With all 26 bytes after the flag escaped, 53 bytes: a full packet of 42 and one of 11, a bit stuffed after six, and before each
    # one a full packet of the other direction.
    assert [frame.most for frame in line.frames(INT64, IN)] == [513 + 513, 224 + 513]
    assert line.is_duplex
    assert line.link.most is None


def test_a_custom_transport():
    rows = [{"size": "32 B", "time": {"min": "1 ms", "max": "2 ms"}}, {"size": "64 B", "time": "5 ms"}]
    line = CustomLine(section=CustomTransport.model_validate({"table": rows}), tick=None)
    assert [time_on(line, line.frames(length, OUT)) for length in (32, 33)] == [(MS, 2 * MS), (5 * MS, 5 * MS)]
    assert line.largest == 64
    framed = CustomLine(section=CustomTransport.model_validate({"table": rows, "framing": True}), tick=None)
    # 25 bytes are a frame of 32 to 63.
    assert time_on(framed, framed.frames(25, OUT)) == (MS, 5 * MS)
    assert framing.longest_frame(framed.largest) <= 64 < framing.longest_frame(framed.largest + 1)


@pytest.mark.parametrize("data_bytes", range(9))
def test_the_longest_frame_of_davis_2007(data_bytes):
    # Equations (1) and (2) of the paper: 55 + 10 s bits with 11-bit identifiers, 80 + 10 s with 29-bit ones.
    assert CanBus(bit_rate=1).max_frame_bits(data_bytes) == 55 + 10 * data_bytes
    assert CanBus(bit_rate=1, identifier=Identifier.EXTENDED).max_frame_bits(data_bytes) == 80 + 10 * data_bytes


def stuffed_length(bits):
    """Bit stuffing by ISO 11898-1: after five equal bits one of the other value, which counts for the next five."""
    sent, run, last = 0, 0, None
    for bit in bits:
        run = run + 1 if bit == last else 1
        last, sent = bit, sent + 1
        if run == 5:
            last, run, sent = 1 - bit, 1, sent + 1
    return sent


@given(st.integers(0, 8), st.sampled_from(Identifier), st.data())
def test_no_frame_is_longer_than_the_longest_nor_shorter_than_the_shortest(data_bytes, identifier, data):
    bus = CanBus(bit_rate=1, identifier=identifier)
    count = identifier.value + 8 * data_bytes
    bits = data.draw(st.lists(st.integers(0, 1), min_size=count, max_size=count))
    length = stuffed_length(bits) + 13
    assert bus.min_frame_bits(data_bytes) <= length <= bus.max_frame_bits(data_bytes)


def test_the_longest_frame_exists():
    # Five equal bits, then runs of four of alternating value, each completed to five by the stuff bit before it.
    bits = [0] * 5 + [bit for index in range(30) for bit in [1 - index % 2] * 4]
    assert stuffed_length(bits[:98]) + 13 == CanBus(bit_rate=1).max_frame_bits(8) == 135


@pytest.mark.parametrize(
    ("length", "count"),
    # Lengths of the messages that create entities, and the two ends of a block.
    [(24, 4), (52, 8), (84, 12), (40, 6), (19, 3), (14, 2), (7, 1), (8, 2), (0, 1)],
)
def test_frames_of_a_message(length, count):
    assert frames(length) == count
    # Each of 135 bits at 4 us.
    bus = CanBus(bit_rate=250_000)
    assert bus.duration(max_message_bits(bus, length)) == count * 540 * US
