"""CAN frames against the figures of the papers."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from amalthea_uros.units import MICROSECOND
from amalthea_uros.uros.transports.can import CanBus, Identifier, frames, transmission_time


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


def test_bus_time_of_a_message():
    # Two frames of 135 bits at 4 us each.
    assert transmission_time(CanBus(bit_rate=250_000), 14) == 1080 * MICROSECOND
