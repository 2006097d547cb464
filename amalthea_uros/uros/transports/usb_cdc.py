"""XRCE-DDS over a virtual serial port of USB."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.perf.network import Direction, Span, WireKind
from amalthea_uros.spec.transports import UsbCdc
from amalthea_uros.units import Time
from amalthea_uros.uros.transports.driver import read_wait, written
from amalthea_uros.uros.transports.framing import CHUNK, in_chunks, longest_frame, reads
from amalthea_uros.uros.transports.line import Frame, span_of


@dataclass(frozen=True, slots=True, kw_only=True)
class UsbCdcLine:
    """A virtual serial port. Its clock ticks once per bit.

    Each direction has an endpoint of its own. They share the bus, but not the waiting of the driver: a packet of the other direction
    can be before each one (Universal Serial Bus Specification 2.0, section 5.8: bulk transfers of endpoints take turns).
    """

    section: UsbCdc
    tick: Time | None

    kind = WireKind.USB_CDC
    name = "USB"
    key = "usb_cdc"
    is_duplex = True
    largest = None

    @property
    def link(self) -> Span:
        """The time until the host polls."""
        return span_of(self.section.latency)

    @property
    def ticks_per_second(self) -> int:
        """Bits per second."""
        return self.section.throughput

    def frames(self, length: int, direction: Direction) -> Sequence[Frame]:
        """See `Line`: the chunks of a frame, with the head, the CRC and the stuff bits of a packet of USB each.

        A packet has a token, the data and a handshake; 13 bytes besides the content are those of a full-speed bulk transaction
        (Universal Serial Bus Specification 2.0, section 5.8.4), and after six ones a bit is stuffed (section 7.1.9).
        """
        packets = (_packet(chunk) for chunk in in_chunks(length, _BITS))
        if direction is Direction.TO_AGENT:
            return written(tuple(packets), self.section.driver, self.tick, self.ticks_per_second)
        return tuple(packets)

    def reading(self, length: int) -> Span:
        """See `Line`."""
        return read_wait(reads(longest_frame(length))[1], self.section.driver, self.tick)


_BITS = 8
_PACKET = 13 * _BITS
#: Ones in a row after which a bit is stuffed.
_ONES = 6


def _packet(chunk: Frame) -> Frame:
    return Frame(least=chunk.least + _PACKET if chunk.least else 0, most=_longest(chunk.most) + _longest(CHUNK * _BITS))


def _longest(content: int) -> int:
    """The bits of a packet with stuff bits."""
    bits = content + _PACKET
    return bits + bits // _ONES
