"""The frames of XRCE-DDS on streams of bytes: serial lines, virtual serial ports, and custom transports that ask for framing.

A frame has a flag, the addresses of source and destination, the length in two bytes, the message, and a CRC in two bytes
(eProsima/Micro-XRCE-DDS-Client `src/c/profile/transport/stream_framing/stream_framing_protocol.c`). A byte after the flag that equals
the flag or the escape byte is sent as two. Client and agent fill a buffer of 42 bytes and write it as soon as it is full.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from itertools import zip_longest

from amalthea_uros.uros.transports.line import Frame

#: Bytes of a frame besides the message, if none is escaped.
OVERHEAD = 7
#: Bytes that are written at once.
CHUNK = 42
#: Bytes that are read at first: the head of a frame.
_HEAD = 5
#: Most bytes that are read at once after the head.
_PIECE = CHUNK - 1


def least_frame(length: int) -> int:
    """The bytes of a frame with a message of so many bytes, none of which is escaped."""
    return length + OVERHEAD


def longest_frame(length: int) -> int:
    """The bytes of a frame if each byte but the flag is escaped."""
    return 1 + 2 * (length + OVERHEAD - 1)


def chunks(frame: int) -> tuple[int, ...]:
    """The sizes of the chunks in which a frame is written."""
    full, rest = divmod(frame, CHUNK)
    return (CHUNK,) * full + ((rest,) if rest else ())


def reads(frame: int) -> tuple[int, int]:
    """The least and the most read calls of the client for a frame.

    One gets the head and one each of the pieces of up to 41 bytes; a piece that goes round the end of the buffer of 42 bytes is read in
    two calls.
    """
    pieces = -(-max(0, frame - _HEAD) // _PIECE)
    return 1 + pieces, 1 + 2 * pieces


def spread(least: Sequence[int], most: Sequence[int], bits_per_byte: int) -> tuple[Frame, ...]:
    """Frames of so many bytes each, in bits; the last ones are only there if bytes are escaped."""
    frame = cache(lambda low, high: Frame(least=low * bits_per_byte, most=high * bits_per_byte))  # most are equal
    return tuple(frame(low, high) for low, high in zip_longest(least, most, fillvalue=0))


def in_chunks(length: int, bits_per_byte: int) -> tuple[Frame, ...]:
    """The chunks of the frame with a message of so many bytes."""
    return spread(chunks(least_frame(length)), chunks(longest_frame(length)), bits_per_byte)


def in_bytes(length: int, bits_per_byte: int) -> tuple[Frame, ...]:
    """The bytes of the frame with a message of so many bytes."""
    return spread((1,) * least_frame(length), (1,) * longest_frame(length), bits_per_byte)
