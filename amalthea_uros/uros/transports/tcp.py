"""Messages over TCP: a stream in which the length precedes each message.

The acknowledgements of TCP itself and what it sends again are not part of the model: it describes a link without losses.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.perf.network import Direction, Span, WireKind
from amalthea_uros.spec.transports import NetworkSection
from amalthea_uros.units import Time
from amalthea_uros.uros.transports.driver import read_wait, written
from amalthea_uros.uros.transports.ethernet import MTU, packet_bytes
from amalthea_uros.uros.transports.line import Frame, span_of

#: Bytes of the headers of IPv4 and TCP.
_HEADERS = 40
#: Bytes of the length before a message.
_LENGTH = 2
#: Bytes of the stream in a packet.
_SEGMENT = MTU - _HEADERS
_BITS = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class TcpLine:
    """The link of the controller; both directions can send at the same time. Its clock ticks once per bit."""

    section: NetworkSection
    tick: Time | None

    kind = WireKind.TCP
    name = "TCP"
    key = "tcp"
    is_duplex = True
    largest = None

    @property
    def link(self) -> Span:
        """The time in the network behind the link."""
        return span_of(self.section.latency)

    @property
    def ticks_per_second(self) -> int:
        """Bits per second."""
        return self.section.bitrate

    def frames(self, length: int, direction: Direction) -> Sequence[Frame]:
        """See `Line`: as many packets as the stream needs."""
        full, rest = divmod(length + _LENGTH, _SEGMENT)
        segments = [*[_SEGMENT] * full, *([rest] if rest else [])]
        bits = [packet_bytes(segment, _HEADERS, self.section.overhead) * _BITS for segment in segments]
        packets = tuple(Frame(least=each, most=each) for each in bits)
        if direction is Direction.TO_AGENT:
            return written(packets, self.section.driver, self.tick, self.ticks_per_second)
        return packets

    def reading(self, length: int) -> Span:
        """See `Line`: a call gets the length, another one the message."""
        return read_wait(2, self.section.driver, self.tick)
