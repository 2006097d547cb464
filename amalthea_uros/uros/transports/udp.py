"""XRCE-DDS over UDP: a message per datagram."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.perf.network import Direction, Span, WireKind
from amalthea_uros.spec.transports import NetworkSection
from amalthea_uros.units import Time
from amalthea_uros.uros.transports.driver import read_wait, written
from amalthea_uros.uros.transports.ethernet import packet_bytes
from amalthea_uros.uros.transports.line import Frame, span_of

#: Bytes of the headers of IPv4 and UDP.
_HEADERS = 28
_BITS = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class UdpLine:
    """The link of the controller; both directions can send at the same time. Its clock ticks once per bit."""

    section: NetworkSection
    tick: Time | None

    kind = WireKind.UDP
    name = "UDP"
    key = "udp"
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
        """See `Line`: one packet."""
        bits = packet_bytes(length, _HEADERS, self.section.overhead) * _BITS
        packet = (Frame(least=bits, most=bits),)
        if direction is Direction.TO_AGENT:
            return written(packet, self.section.driver, self.tick, self.ticks_per_second)
        return packet

    def reading(self, length: int) -> Span:
        """See `Line`: a call gets a datagram."""
        return read_wait(1, self.section.driver, self.tick)
