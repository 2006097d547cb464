"""Messages over classic CAN: frames of a header byte and up to 7 bytes of a message."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.perf.network import Direction, Span, WireKind
from amalthea_uros.spec.transports import Can
from amalthea_uros.uros.transports.bus_messages import bus_of
from amalthea_uros.uros.transports.can import block_bytes
from amalthea_uros.uros.transports.line import Frame


@dataclass(frozen=True, slots=True, kw_only=True)
class CanLine:
    """A CAN bus. Its clock ticks once per bit."""

    section: Can

    kind = WireKind.CAN
    name = "CAN"
    key = "can"
    is_duplex = False
    largest = None
    link = Span(most=0)

    @property
    def ticks_per_second(self) -> int:
        """Bits per second."""
        return self.section.bitrate

    def frames(self, length: int, direction: Direction) -> Sequence[Frame]:
        """See `Line`: the blocks of a message."""
        bus = bus_of(self.section)
        return tuple(Frame(least=bus.min_frame_bits(low), most=bus.max_frame_bits(high)) for low, high in block_bytes(length))

    def foreign(self, data_bytes: int, *, extended: bool) -> Frame:
        """A foreign frame."""
        bus = bus_of(self.section.model_copy(update={"identifier": "extended" if extended else "standard"}))
        return Frame(least=bus.min_frame_bits(data_bytes), most=bus.max_frame_bits(data_bytes))

    def reading(self, length: int) -> Span:
        """See `Line`."""
        return Span(most=0)
