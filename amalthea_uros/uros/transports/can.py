"""CAN and CAN FD: how long frames and messages are on the bus, whose frames these are, and which one wins the arbitration.

Frame lengths of CAN 2.0 are those of R. I. Davis, A. Burns, R. J. Bril, J. J. Lukkien: "Controller Area Network (CAN) schedulability
analysis: Refuted, revisited and revised", Real-Time Systems 35, 2007, section 2: g bits of a frame and its s data bytes are subject to
bit stuffing, 13 bits are not (delimiters, acknowledgement, end of frame, inter-frame space); after the first of the bits subject to it,
every four bits can add a stuff bit.

The framing of XRCE-DDS over CAN FD, a length byte and one message in each frame, is that of eProsima/Micro-XRCE-DDS-Client
`src/c/profile/transport/can/can_transport*.c`: the frame is filled up to the next size that a data length code stands for.

Bits of a CAN FD frame are those of ISO 11898-1:2015: the part from the start of frame to the bit rate switch and the part from the CRC
delimiter to the end of the interframe space are sent at the lower bit rate, what is between at the higher one. Up to the end of the
data, stuff bits are as in CAN (U. D. Bordoloi, S. Samii: "The frame packing problem for CAN-FD", RTSS 2014); those of the longest frame
are where bits are slow, as far as they can be there. The CRC field has fixed stuff bits: one before it, and one after every four of its
bits.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from enum import Enum
from math import lcm

from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Location
from amalthea_uros.perf.network import Direction, WireKind
from amalthea_uros.spec.transports import Can, CanFd
from amalthea_uros.units import SECOND, BitRate, Time
from amalthea_uros.uros.transports.line import Frame, Line

#: Maximum data bytes of a frame.
FRAME_BYTES = 8
#: Bytes of a message in a frame: the first byte of the frame is the header of the block.
BLOCK_BYTES = FRAME_BYTES - 1
_UNSTUFFED_BITS = 13
#: The greatest identifier of 11 bits.
GREATEST_STANDARD = 0x7FF
#: After the bits that both formats share, a standard frame wins against an extended one.
_EXTENSION_BITS = 18


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

    def frame(self, least: int, most: int) -> Frame:
        """A frame of so many data bytes at least and at most."""
        return Frame(least=self.min_frame_bits(least), most=self.max_frame_bits(most))

    def duration(self, bits: int) -> Time:
        """The transmission time of bits, rounded up."""
        return -(-bits * SECOND // self.bit_rate)


def frames(message_bytes: int) -> int:
    """The number of frames of a message that is sent in blocks of 7 bytes; an empty message needs one."""
    return max(1, -(-message_bytes // BLOCK_BYTES))


def max_message_bits(bus: CanBus, message_bytes: int) -> int:
    """Maximum bits of a message on the bus: all its frames with full data, since a transport may pad the last block."""
    return frames(message_bytes) * bus.max_frame_bits(FRAME_BYTES)


def block_bytes(length: int) -> list[tuple[int, int]]:
    """Minimum and maximum data bytes of the frames of a message: a transport may pad the last block."""
    full, rest = divmod(max(1, length) - 1, BLOCK_BYTES)
    return [*[(FRAME_BYTES, FRAME_BYTES)] * full, (rest + 2, FRAME_BYTES)]


def bus_of(can: Can, identifier: str | None = None) -> CanBus:
    """The bus of a description; with another frame format, if that is given."""
    return CanBus(bit_rate=can.bitrate, identifier=Identifier[(identifier or can.identifier).upper()])


@dataclass(frozen=True, slots=True, kw_only=True)
class ForeignFrame:
    """A foreign frame: one that neither the controller nor the agent sends.

    Attributes
    ----------
    period : minimum time between two of them; None if it is not known
    jitter : maximum delay against its nominal time
    """

    name: str
    identifier: int
    extended: bool
    data_bytes: int
    period: Time | None
    jitter: Time = 0
    origin: Location | None = None

    @property
    def rank(self) -> int:
        """Its place in the arbitration; the lowest one wins."""
        return arbitration_rank(self.identifier, extended=self.extended)


def arbitration_rank(identifier: int, *, extended: bool) -> int:
    """The place of an identifier in the arbitration; the lowest one wins.

    The first 11 bits are compared first; then the bit that marks an extended identifier loses (ISO 11898-1).
    """
    if not extended:
        return identifier << _EXTENSION_BITS + 1
    base, extension = divmod(identifier, 1 << _EXTENSION_BITS)
    return (base << _EXTENSION_BITS + 1) + (1 << _EXTENSION_BITS) + extension


def described_frames(bus: Can | CanFd) -> Iterator[ForeignFrame]:
    """The foreign frames of a description."""
    for frame in bus.foreign:
        yield ForeignFrame(
            name=frame.name,
            identifier=frame.identifier,
            extended=bus.identifier == "extended" or frame.identifier > GREATEST_STANDARD,
            data_bytes=frame.bytes,
            period=frame.period,
            jitter=frame.jitter or 0,
            origin=frame.location(),
        )


def without_own(frames: Sequence[ForeignFrame], bus: Can | CanFd) -> tuple[ForeignFrame, ...]:
    """The frames whose identifiers are not those of the messages of the application itself."""
    own = {*bus.identifiers.values()}
    return tuple(frame for frame in frames if frame.identifier not in own)


@dataclass(frozen=True, slots=True, kw_only=True)
class BusLine(Line):
    """A bus: identifiers decide who sends."""

    section: Can | CanFd

    is_bus = True

    @abstractmethod
    def foreign(self, data_bytes: int, *, extended: bool) -> Frame:
        """A foreign frame."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CanLine(BusLine):
    """A CAN bus; messages are sent in frames of a header byte and up to 7 bytes. Its clock ticks once per bit."""

    section: Can

    kind = WireKind.CAN
    name = "CAN"
    key = "can"

    @property
    def ticks_per_second(self) -> int:
        """Bits per second."""
        return self.section.bitrate

    def frames(self, length: int, direction: Direction) -> Sequence[Frame]:
        """See `Line`: the blocks of a message."""
        return tuple(bus_of(self.section).frame(*data) for data in block_bytes(length))

    def foreign(self, data_bytes: int, *, extended: bool) -> Frame:
        """See `BusLine`."""
        return bus_of(self.section, "extended" if extended else "standard").frame(data_bytes, data_bytes)


@dataclass(frozen=True, slots=True, kw_only=True)
class CanFdLine(BusLine):
    """A CAN FD bus. Its clock ticks a whole number of times per bit of either bit rate."""

    section: CanFd

    kind = WireKind.CAN_FD
    name = "CAN_FD"
    key = "can_fd"
    rate_key = "data_bitrate"

    @property
    def ticks_per_second(self) -> int:
        """The least common multiple of the bit rates."""
        return lcm(int(self.section.bitrate), int(self.section.data_bitrate))

    @property
    def largest(self) -> int:
        """See `Line`: a byte of a frame is the length."""
        return _LARGEST

    def frames(self, length: int, direction: Direction) -> Sequence[Frame]:
        """See `Line`: one frame."""
        return (self._frame(data_bytes(min(length, _LARGEST)), extended=self.section.identifier == "extended"),)

    def foreign(self, data_bytes: int, *, extended: bool) -> Frame:
        """See `BusLine`; a short one can also be a classic one."""
        fast = self._frame(next(size for size in SIZES if size >= data_bytes), extended=extended)
        if data_bytes > FRAME_BYTES:
            return fast
        bus = CanBus(bit_rate=self.section.bitrate, identifier=Identifier.EXTENDED if extended else Identifier.STANDARD)
        slow = self.ticks_per_second // self.section.bitrate
        return Frame(
            least=min(fast.least, slow * bus.min_frame_bits(data_bytes)),
            most=max(fast.most, slow * bus.max_frame_bits(data_bytes)),
        )

    def _frame(self, data: int, *, extended: bool) -> Frame:
        slow, fast = self.ticks_per_second // self.section.bitrate, self.ticks_per_second // self.section.data_bitrate
        least, most = bits(data, extended=extended)
        return Frame(least=least[0] * slow + least[1] * fast, most=most[0] * slow + most[1] * fast)


#: Numbers of data bytes that a frame can have.
SIZES: tuple[int, ...] = (*range(9), 12, 16, 20, 24, 32, 48, 64)
#: The longest message of the middleware in a frame: a byte is its length.
_LARGEST = SIZES[-1] - 1

#: Bits from the start of frame to the bit rate switch: SOF, identifier, control bits (with SRR and IDE of the extended format).
_STANDARD, _EXTENDED = 1 + 11 + 5, 1 + 11 + 2 + 18 + 4
#: ESI and the data length code.
_CONTROL = 5
#: CRC delimiter, acknowledgement and its delimiter, end of frame, interframe space.
_END = 1 + 2 + 7 + 3
#: Bits of the stuff count with its parity bit, and of the CRC of short and of long frames.
_STUFF_COUNT, _SHORT_CRC, _LONG_CRC = 4, 17, 21
#: Data bytes up to which the CRC is short.
_SHORT = 16


def data_bytes(length: int) -> int:
    """The data bytes of the frame with a message of so many bytes."""
    return min(size for size in SIZES if size > length)


def bits(data: int, *, extended: bool) -> tuple[tuple[int, int], tuple[int, int]]:
    """The least and the most bits of a frame: (at the lower bit rate, at the higher one) each."""
    head, body = _EXTENDED if extended else _STANDARD, _CONTROL + 8 * data
    checked = _STUFF_COUNT + (_SHORT_CRC if data <= _SHORT else _LONG_CRC)
    crc = checked + 1 + checked // 4
    stuffed, slowly = (head + body - 1) // 4, (head - 1) // 4
    return (head + _END, body + crc), (head + slowly + _END, body + stuffed - slowly + crc)
