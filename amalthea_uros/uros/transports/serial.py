"""XRCE-DDS over a serial line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.perf.network import Direction, Span, WireKind
from amalthea_uros.spec.transports import Serial
from amalthea_uros.units import Time
from amalthea_uros.uros.transports.driver import read_wait, written
from amalthea_uros.uros.transports.framing import in_bytes, in_chunks, longest_frame, reads
from amalthea_uros.uros.transports.line import Frame


@dataclass(frozen=True, slots=True, kw_only=True)
class SerialLine:
    """A serial line; both directions can send at the same time. Its clock ticks once per symbol."""

    section: Serial
    tick: Time | None

    kind = WireKind.SERIAL
    name = "Serial"
    key = "serial"
    is_duplex = True
    largest = None
    link = Span(most=0)

    @property
    def ticks_per_second(self) -> int:
        """Symbols per second."""
        return self.section.baud_rate

    def frames(self, length: int, direction: Direction) -> Sequence[Frame]:
        """See `Line`: the chunks of a frame; each byte where each causes an interrupt."""
        bits, driver = self.section.bits_per_byte, self.section.driver
        if direction is Direction.TO_AGENT:
            return written(in_chunks(length, bits), driver, self.tick, self.ticks_per_second)
        return in_bytes(length, bits) if driver.read == "interrupt" else in_chunks(length, bits)

    def reading(self, length: int) -> Span:
        """See `Line`."""
        return read_wait(reads(longest_frame(length))[1], self.section.driver, self.tick)
