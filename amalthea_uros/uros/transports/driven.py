"""Wires with a driver that moves the bytes: serial lines, virtual serial ports, networks, and those with a table of times.

The modes of drivers are those of the transports that micro-ROS delivers. With DMA and interrupts, a write call starts the transfer of
a chunk and asks in each tick whether it has ended (micro-ROS/micro_ros_stm32cubemx_utils
`extra_sources/microros_transports/dma_transport.c`), so that each chunk takes a tick at least, whatever the baud rate; a read call
waits a tick, too. Polling copies byte by byte (micro-ROS/micro_ros_zephyr_module `modules/libmicroros/microros_transports/serial`):
the processor is busy for the whole transfer. Calls that block are woken when the transfer has ended.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from typing import ClassVar

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.network import Direction, Span, WireKind
from amalthea_uros.spec.transports import CustomTransport, Driver, LatencySection, NetworkSection, Serial, UsbCdc
from amalthea_uros.units import NANOSECOND, SECOND, Time
from amalthea_uros.uros.transports.framing import CHUNK, OVERHEAD, in_bytes, in_chunks, least_frame, longest_frame, reads
from amalthea_uros.uros.transports.line import Frame, Line, span_of

#: Modes whose calls wait in ticks.
WAITING = ("dma", "interrupt")
_BITS = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class DrivenLine(Line):
    """A wire with a driver.

    Attributes
    ----------
    tick : of the operating system, for a driver that states no other one; None if it is unknown
    """

    section: Serial | NetworkSection | UsbCdc | CustomTransport
    tick: Time | None

    @property
    def driver(self) -> Driver:
        """How it moves bytes."""
        return self.section.driver

    @property
    def driver_tick(self) -> Time | None:
        """The tick in which its calls wait; None if it is unknown."""
        return self.driver.tick or self.tick

    def frames(self, length: int, direction: Direction) -> tuple[Frame, ...]:
        """See `Line`; what the controller sends waits for the ticks of the driver.

        The first chunk is started at any time within a tick, and its end is seen up to a tick late; each further one is started right
        after a tick, and its time is rounded up to whole ticks. While a writer waits for the tick, nothing else can be written: so this
        time counts as time on the wire. If the tick is unknown, the waiting is, too, which is reported elsewhere.
        """
        chunks, tick = self.chunks(length, direction), self.driver_tick
        if direction is Direction.TO_CONTROLLER or self.driver.write not in WAITING or tick is None:
            return chunks
        period = -(-tick * self.ticks_per_second // SECOND)
        return tuple(
            Frame(least=chunk.least, most=chunk.most + period if number == 0 else max(1, -(-chunk.most // period)) * period)
            for number, chunk in enumerate(chunks)
        )

    @abstractmethod
    def chunks(self, length: int, direction: Direction) -> tuple[Frame, ...]:
        """What is on the wire for a message of the middleware, without waiting."""

    @property
    def is_framed(self) -> bool:
        """See `Line`: on streams of bytes."""
        return True

    def reading(self, length: int) -> Span:
        """See `Line`: up to a tick for each read call, if the driver waits in ticks; an interrupt-driven read returns at once."""
        if self.driver.read != "dma":
            return Span(most=0)
        return Span(most=None if self.driver_tick is None else self.read_calls(length) * self.driver_tick)

    def read_calls(self, length: int) -> int:
        """The most calls that read a message."""
        return reads(longest_frame(length))[1]


@dataclass(frozen=True, slots=True, kw_only=True)
class SerialLine(DrivenLine):
    """A serial line. Its clock ticks once per symbol."""

    section: Serial

    kind = WireKind.SERIAL
    name = "Serial"
    key = "serial"
    rate_key = "baud_rate"
    is_duplex = True
    keeps_sender = True

    @property
    def ticks_per_second(self) -> int:
        """Symbols per second."""
        return self.section.baud_rate

    def chunks(self, length: int, direction: Direction) -> tuple[Frame, ...]:
        """The chunks of a frame; each byte where each causes an interrupt."""
        is_by_bytes = direction is Direction.TO_CONTROLLER and self.driver.read == "interrupt"
        return (in_bytes if is_by_bytes else in_chunks)(length, self.section.bits_per_byte)


@dataclass(frozen=True, slots=True, kw_only=True)
class UsbCdcLine(DrivenLine):
    """A virtual serial port. Its clock ticks once per bit.

    Each direction has an endpoint of its own. They share the bus, but not the waiting of the driver: a packet of the other direction
    can be before each one (Universal Serial Bus Specification 2.0, section 5.8: bulk transfers of endpoints take turns).
    """

    section: UsbCdc

    kind = WireKind.USB_CDC
    name = "USB"
    key = "usb_cdc"
    rate_key = "throughput"
    is_duplex = True
    keeps_sender = True

    @property
    def link(self) -> Span:
        """The time until the host polls."""
        return span_of(self.section.latency)

    @property
    def ticks_per_second(self) -> int:
        """Bits per second."""
        return self.section.throughput

    def chunks(self, length: int, direction: Direction) -> tuple[Frame, ...]:
        """The chunks of a frame, with the head, the CRC and the stuff bits of a packet of USB each.

        A packet has a token, the data and a handshake; 13 bytes besides the content are those of a full-speed bulk transaction
        (Universal Serial Bus Specification 2.0, section 5.8.4), and after six ones a bit is stuffed (section 7.1.9).
        """
        return tuple(
            Frame(least=chunk.least + _PACKET if chunk.least else 0, most=_stuffed(chunk.most) + _stuffed(CHUNK * _BITS))
            for chunk in in_chunks(length, _BITS)
        )


_PACKET = 13 * _BITS
#: Ones in a row after which a bit is stuffed.
_ONES = 6


def _stuffed(content: int) -> int:
    """The most bits of a packet with a content."""
    bits = content + _PACKET
    return bits + bits // _ONES


@dataclass(frozen=True, slots=True, kw_only=True)
class CustomLine(DrivenLine):
    """A transport with a table of times, in which only one message can be at a time. Its clock ticks once per nanosecond."""

    section: CustomTransport

    kind = WireKind.CUSTOM
    name = "Transport"
    key = "custom"
    rate_key = "table"
    keeps_sender = True

    @property
    def ticks_per_second(self) -> int:
        """Nanoseconds."""
        return SECOND // NANOSECOND

    @property
    def is_framed(self) -> bool:
        """See `Line`: if it is stated."""
        return self.section.framing

    @property
    def largest(self) -> int:
        """See `Line`: that of the last row."""
        last = self.section.table[-1].size // 8
        return max(0, (last - 1) // 2 + 1 - OVERHEAD) if self.is_framed else last

    def chunks(self, length: int, direction: Direction) -> tuple[Frame, ...]:
        """One frame."""
        least, most = (least_frame(length), longest_frame(length)) if self.is_framed else (length, length)
        return (Frame(least=self._time(least).min // NANOSECOND, most=max(1, -(-self._time(most).max // NANOSECOND))),)

    def _time(self, length: int) -> LatencySection:
        """The time of the first row that is long enough, or of the last one."""
        rows = self.section.table
        return next((row.time for row in rows if row.size >= 8 * length), rows[-1].time)

    def read_calls(self, length: int) -> int:
        """See `DrivenLine`."""
        return reads(longest_frame(length))[1] if self.is_framed else 1


#: Header, type and checksum of an Ethernet frame; preamble and gap to the next one (IEEE 802.3).
_FRAME, _GAP = 18, 20
#: Bytes of content of the shortest and of the longest Ethernet frame.
_LEAST_CONTENT, _MTU = 46, 1500


@dataclass(frozen=True, slots=True, kw_only=True)
class NetworkLine(DrivenLine):
    """The link of the controller to an IP network, Ethernet if its overhead is not stated. Its clock ticks once per bit.

    Attributes
    ----------
    headers : bytes of the headers of IPv4 and of the transport layer
    """

    section: NetworkSection

    headers: ClassVar[int]
    is_duplex = True

    @property
    def link(self) -> Span:
        """The time in the network after the link."""
        return span_of(self.section.latency)

    @property
    def ticks_per_second(self) -> int:
        """Bits per second."""
        return self.section.bitrate

    @property
    def is_framed(self) -> bool:
        """See `Line`: packets have headers of their own."""
        return False

    def chunks(self, length: int, direction: Direction) -> tuple[Frame, ...]:
        """The packets of a message."""
        bits = [self._packet_bytes(content) * _BITS for content in self.packets(length)]
        return tuple(Frame(least=each, most=each) for each in bits)

    @abstractmethod
    def packets(self, length: int) -> Sequence[int]:
        """The content of each packet of a message, in bytes."""

    def _packet_bytes(self, content: int) -> int:
        if self.section.overhead is not None:
            return content + -(-self.section.overhead // 8)
        return max(_LEAST_CONTENT, content + self.headers) + _FRAME + _GAP


@dataclass(frozen=True, slots=True, kw_only=True)
class UdpLine(NetworkLine):
    """A link with a message per datagram."""

    kind = WireKind.UDP
    name = "UDP"
    key = "udp"
    headers = 28

    def packets(self, length: int) -> Sequence[int]:
        """See `NetworkLine`."""
        return (length,)

    def read_calls(self, length: int) -> int:
        """See `DrivenLine`: a call gets a datagram."""
        return 1


@dataclass(frozen=True, slots=True, kw_only=True)
class TcpLine(NetworkLine):
    """A link with a stream in which a length of two bytes precedes each message.

    The acknowledgements of TCP itself and what it sends again are not part of the model: it describes a link without losses.
    """

    kind = WireKind.TCP
    name = "TCP"
    key = "tcp"
    headers = 40

    def packets(self, length: int) -> Sequence[int]:
        """See `NetworkLine`: as many as the stream needs."""
        segment = _MTU - self.headers
        full, rest = divmod(length + 2, segment)
        return [*[segment] * full, *([rest] if rest else [])]

    def read_calls(self, length: int) -> int:
        """See `DrivenLine`: a call gets the length, another one the message."""
        return 2


def steady_time(chunks: Sequence[Frame], tick: Time, ticks_per_second: int) -> Time:
    """The time of a message whose write calls wait in ticks, if it is written right after the one before."""
    ends = (-(-chunk.least * SECOND // ticks_per_second) for chunk in chunks)
    return sum(max(1, -(-end // tick)) * tick for end in ends)


def bytes_between_reads(baud_rate: int, bits_per_byte: int, gap: Time) -> int:
    """The most bytes that arrive on a serial line in a time in which nothing is read; a smaller buffer overflows."""
    return -(-gap * baud_rate // (bits_per_byte * SECOND))
