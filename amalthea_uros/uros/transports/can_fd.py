"""XRCE-DDS over CAN FD: a length byte and one message in each frame.

The framing is that of eProsima/Micro-XRCE-DDS-Client `src/c/profile/transport/can/can_transport*.c`: the frame is filled up to the next
size that a data length code stands for.

Bits of a frame are those of ISO 11898-1:2015: the part from the start of frame to the bit rate switch and the part from the CRC
delimiter to the end of the interframe space are sent at the lower bit rate, what is between at the higher one. After the first of the
bits up to the end of the data, every four bits can add a stuff bit (Davis, Burns, Bril, Lukkien 2007, for CAN; U. D. Bordoloi,
S. Samii: "The frame packing problem for CAN-FD", RTSS 2014, for CAN FD); those of the longest frame are where bits are slow, as far as
they can be there. The CRC field has fixed stuff bits: one before it, and one after every four of its bits.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import lcm

from amalthea_uros.perf.network import Direction, Span, WireKind
from amalthea_uros.spec.transports import CanFd
from amalthea_uros.uros.transports.can import CanBus, Identifier
from amalthea_uros.uros.transports.line import Frame

#: Numbers of data bytes that a frame can have.
SIZES: tuple[int, ...] = (*range(9), 12, 16, 20, 24, 32, 48, 64)
#: The longest message of the middleware in a frame: a byte is its length.
LARGEST = SIZES[-1] - 1

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


@dataclass(frozen=True, slots=True, kw_only=True)
class CanFdLine:
    """A CAN FD bus. Its clock ticks a whole number of times per bit of either bit rate."""

    section: CanFd

    kind = WireKind.CAN_FD
    name = "CAN_FD"
    key = "can_fd"
    is_duplex = False
    largest = LARGEST
    link = Span(most=0)

    @property
    def ticks_per_second(self) -> int:
        """The least common multiple of the bit rates."""
        return lcm(int(self.section.bitrate), int(self.section.data_bitrate))

    def frames(self, length: int, direction: Direction) -> Sequence[Frame]:
        """See `Line`: one frame."""
        return (self._frame(data_bytes(min(length, LARGEST)), extended=self.section.identifier == "extended"),)

    def foreign(self, data_bytes: int, *, extended: bool) -> Frame:
        """A foreign frame; a short one can also be a classic one."""
        fast = self._frame(next(size for size in SIZES if size >= data_bytes), extended=extended)
        if data_bytes > 8:
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

    def reading(self, length: int) -> Span:
        """See `Line`."""
        return Span(most=0)


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
