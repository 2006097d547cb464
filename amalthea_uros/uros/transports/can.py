"""CAN 2.0: the transmission time of frames and messages.

Frame lengths are those of R. I. Davis, A. Burns, R. J. Bril, J. J. Lukkien: "Controller Area Network (CAN) schedulability analysis:
Refuted, revisited and revised", Real-Time Systems 35, 2007, section 2: g bits of a frame and its s data bytes are subject to bit
stuffing, 13 bits are not (delimiters, acknowledgement, end of frame, inter-frame space); after the first of the bits subject to it,
every four bits can add a stuff bit.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from amalthea_uros.units import SECOND, BitRate, Time

#: Maximum data bytes of a frame.
FRAME_BYTES = 8
#: Bytes of a message in a frame: the first byte of the frame is the header of the block.
BLOCK_BYTES = FRAME_BYTES - 1
_UNSTUFFED_BITS = 13


class Identifier(Enum):
    """The two frame formats; the value is g, the bits besides the data that are subject to bit stuffing."""

    STANDARD = 34
    EXTENDED = 54


@dataclass(frozen=True, slots=True, kw_only=True)
class CanBus:
    """A CAN bus.

    Attributes
    ----------
    bit_rate : bits per second
    """

    bit_rate: BitRate
    identifier: Identifier = Identifier.STANDARD

    def max_frame_bits(self, data_bytes: int) -> int:
        """Maximum length of a frame, with all possible stuff bits: 135 bits for 8 bytes and a standard identifier."""
        stuffed = self.identifier.value + 8 * data_bytes
        return stuffed + _UNSTUFFED_BITS + (stuffed - 1) // 4

    def min_frame_bits(self, data_bytes: int) -> int:
        """Minimum length of a frame, without stuff bits."""
        return self.identifier.value + 8 * data_bytes + _UNSTUFFED_BITS

    def duration(self, bits: int) -> Time:
        """The transmission time of bits, rounded up."""
        return -(-bits * SECOND // self.bit_rate)


def frames(message_bytes: int) -> int:
    """The number of frames of a message that is sent in blocks of 7 bytes; an empty message needs one."""
    return max(1, -(-message_bytes // BLOCK_BYTES))


def max_message_bits(bus: CanBus, message_bytes: int) -> int:
    """Maximum bits of a message on the bus: all its frames with full data, since a transport may pad the last block."""
    return frames(message_bytes) * bus.max_frame_bits(FRAME_BYTES)


def transmission_time(bus: CanBus, message_bytes: int) -> Time:
    """Maximum transmission time of a message, without waiting for the bus."""
    return bus.duration(max_message_bits(bus, message_bytes))


def block_bytes(length: int) -> list[tuple[int, int]]:
    """Minimum and maximum data bytes of the frames of a message: a transport may pad the last block."""
    full, rest = divmod(max(1, length) - 1, BLOCK_BYTES)
    return [*[(FRAME_BYTES, FRAME_BYTES)] * full, (rest + 2, FRAME_BYTES)]
