"""CAN 2.0: how long frames and messages occupy the bus.

Frame lengths after R. I. Davis, A. Burns, R. J. Bril, J. J. Lukkien: "Controller Area Network (CAN) schedulability analysis: Refuted,
revisited and revised", Real-Time Systems 35, 2007, section 2: g bits of a frame are subject to bit stuffing beside its s data bytes,
13 bits are not (delimiters, acknowledgement, end of frame, inter-frame space); of those subject to it, four bits may bring a stuff bit
after the first one.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from amalthea_uros.units import SECOND, BitRate, Time

#: Most data bytes of a frame.
FRAME_BYTES = 8
#: Bytes of a message in a frame: the first byte is the header of the block.
BLOCK_BYTES = FRAME_BYTES - 1
_UNSTUFFED_BITS = 13


class Identifier(Enum):
    """The two formats; the value is g, the bits beside the data that are subject to stuffing."""

    STANDARD = 34
    EXTENDED = 54


@dataclass(frozen=True, slots=True, kw_only=True)
class Bus:
    """A CAN bus.

    Attributes
    ----------
    bit_rate : bits per second
    """

    bit_rate: BitRate
    identifier: Identifier = Identifier.STANDARD

    def frame_bits(self, data_bytes: int) -> int:
        """Most bits of a frame, with all stuff bits that there can be: 135 for 8 bytes and a standard identifier."""
        stuffed = self.identifier.value + 8 * data_bytes
        return stuffed + _UNSTUFFED_BITS + (stuffed - 1) // 4

    def least_frame_bits(self, data_bytes: int) -> int:
        """Bits of a frame without any stuff bit."""
        return self.identifier.value + 8 * data_bytes + _UNSTUFFED_BITS

    def time(self, bits: int) -> Time:
        """Picoseconds that bits take, rounded up."""
        return -(-bits * SECOND // self.bit_rate)


def frames(message_bytes: int) -> int:
    """Frames of a message that is sent in blocks of 7 bytes; an empty message takes one."""
    return max(1, -(-message_bytes // BLOCK_BYTES))


def block_header(index: int, count: int) -> int:
    """The first byte of a block: bit 0 marks the first one of a message, bit 1 the last one."""
    return (index == 0) | (index == count - 1) << 1


def blocks(message: bytes) -> list[bytes]:
    """A message as the data of its frames: header byte, then up to 7 bytes."""
    count = frames(len(message))
    parts = (message[index * BLOCK_BYTES : (index + 1) * BLOCK_BYTES] for index in range(count))
    return [bytes([block_header(index, count)]) + part for index, part in enumerate(parts)]


def message_bits(bus: Bus, message_bytes: int) -> int:
    """Most bits on the bus of a message: all its frames with full data, since a transport may pad the last block."""
    return frames(message_bytes) * bus.frame_bits(FRAME_BYTES)


def message_time(bus: Bus, message_bytes: int) -> Time:
    """Most time that a message occupies the bus, without waiting for others."""
    return bus.time(message_bits(bus, message_bytes))
