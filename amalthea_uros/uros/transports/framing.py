"""The frames of XRCE-DDS on streams of bytes: serial lines, virtual serial ports, and custom transports that ask for framing.

A frame has a flag, the addresses of source and destination, the length in two bytes, the message, and a CRC in two bytes
(eProsima/Micro-XRCE-DDS-Client `src/c/profile/transport/stream_framing/stream_framing_protocol.c`). A byte after the flag that equals
the flag or the escape byte is sent as two. Client and agent fill a buffer of 42 bytes and write it as soon as it is full.

How many bytes are escaped depends on their values, which are not specified: at most all, and if each value is as frequent as any other,
2 of 256. Bounds have the former, simulations the latter.
"""

from __future__ import annotations

from collections.abc import Sequence
from decimal import Context, Decimal, localcontext
from functools import cache
from itertools import accumulate, zip_longest

from amalthea_uros.uros.transports.line import Frame

#: Bytes of a frame besides the message, if none is escaped.
OVERHEAD = 7
#: Bytes that are written at once.
CHUNK = 42
#: Bytes that are read at first: the head of a frame.
_HEAD = 5
#: Most bytes that are read at once after the head.
_PIECE = CHUNK - 1
#: Values of a byte, and those of them that are escaped: 0x7D and 0x7E.
BYTES, ESCAPED = 256, 2
BILLION = 10**9
#: Chances that are smaller than that of the most frequent number by such a factor change no billionth.
_NEGLIGIBLE = Decimal("1e-20")


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


def spread(length: int, least: Sequence[int], most: Sequence[int], bits_per_byte: int) -> tuple[Frame, ...]:
    """Frames of so many bytes each, in bits; the last ones are only there if bytes are escaped.

    Each escaped byte makes the first frame that is not full one byte longer. Values of frames are independent of each other: a later
    one can be longer although this one is not full.

    Parameters
    ----------
    length : of the message, in bytes
    """
    frames, before = [], 0
    for low, high in zip_longest(least, most, fillvalue=0):
        weights = _weights(length + OVERHEAD - 1, before, high - low)
        in_bits = tuple(((low + more) * bits_per_byte, weight) for more, weight in weights)
        frames.append(Frame(least=low * bits_per_byte, most=high * bits_per_byte, weights=in_bits))
        before += high - low
    return tuple(frames)


def _weights(count: int, before: int, room: int) -> tuple[tuple[int, int], ...]:
    """How many escaped bytes are in a frame with room for so many, and how often, if so many of them are in those before.

    Parameters
    ----------
    count : bytes that can be escaped
    """
    if not room:
        return ()
    chances = _escaped(count)
    up_to = _at_most(count)
    weights = {0: up_to[min(before, len(up_to) - 1)]} | dict(enumerate(chances[before + 1 : before + room], 1))
    weights[room] = up_to[-1] - up_to[min(before + room, len(up_to)) - 1]
    # What is possible is not excluded, however rare it is.
    return tuple((more, max(1, weight)) for more, weight in weights.items() if weight or more in (0, room))


@cache
def _at_most(count: int) -> tuple[int, ...]:
    """How often at most so many of some random bytes are escaped, from 0 on, in billionths."""
    return tuple(accumulate(_escaped(count)))


@cache
def _escaped(count: int) -> tuple[int, ...]:
    """How often so many of some random bytes are escaped, from 0 on, in billionths; what is rarer is left out.

    These are binomial numbers, as ratios to that of the most frequent number, in decimals: the same ones on each machine.
    """
    with localcontext(Context(prec=40)):
        ratios: dict[int, Decimal] = {(usual := count * ESCAPED // BYTES): Decimal(1)}
        for number in range(usual, count):
            if ratios[number] < _NEGLIGIBLE:
                break
            ratios[number + 1] = ratios[number] * (count - number) * ESCAPED / ((number + 1) * (BYTES - ESCAPED))
        for number in range(usual, 0, -1):
            if ratios[number] < _NEGLIGIBLE:
                break
            ratios[number - 1] = ratios[number] * number * (BYTES - ESCAPED) / ((count - number + 1) * ESCAPED)
        whole = sum(ratios.values())
        counts = {number: round(ratio * BILLION / whole) for number, ratio in ratios.items()}
    return tuple(counts.get(number, 0) for number in range(1 + max(number for number, each in counts.items() if each)))


def in_chunks(length: int, bits_per_byte: int) -> tuple[Frame, ...]:
    """The chunks of the frame with a message of so many bytes."""
    return spread(length, chunks(least_frame(length)), chunks(longest_frame(length)), bits_per_byte)


def in_bytes(length: int, bits_per_byte: int) -> tuple[Frame, ...]:
    """The bytes of the frame with a message of so many bytes."""
    return spread(length, (1,) * least_frame(length), (1,) * longest_frame(length), bits_per_byte)
