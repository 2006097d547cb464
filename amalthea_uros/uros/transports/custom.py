"""A transport that is described by measured transfer times."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from amalthea_uros.perf.network import Direction, Span, WireKind
from amalthea_uros.spec.transports import CustomTransport, LatencySection
from amalthea_uros.units import NANOSECOND, SECOND, Time
from amalthea_uros.uros.transports.driver import read_wait, written
from amalthea_uros.uros.transports.framing import OVERHEAD, least_frame, longest_frame, reads
from amalthea_uros.uros.transports.line import Frame


@dataclass(frozen=True, slots=True, kw_only=True)
class CustomLine:
    """A transport with a table of times, in which only one message can be at a time. Its clock ticks once per nanosecond."""

    section: CustomTransport
    tick: Time | None

    kind = WireKind.CUSTOM
    name = "Transport"
    key = "custom"
    is_duplex = False
    ticks_per_second = SECOND // NANOSECOND
    link = Span(most=0)

    @property
    def largest(self) -> int:
        """See `Line`: that of the last row."""
        last = self.section.table[-1].size // 8
        return max(0, (last - 1) // 2 + 1 - OVERHEAD) if self.section.framing else last

    def frames(self, length: int, direction: Direction) -> Sequence[Frame]:
        """See `Line`: one frame."""
        least, most = (least_frame(length), longest_frame(length)) if self.section.framing else (length, length)
        frame = Frame(least=self._time(least).min // NANOSECOND, most=max(1, -(-self._time(most).max // NANOSECOND)))
        if direction is Direction.TO_AGENT:
            return written((frame,), self.section.driver, self.tick, self.ticks_per_second)
        return (frame,)

    def _time(self, length: int) -> LatencySection:
        """The time of the first row that is long enough, or of the last one."""
        rows = self.section.table
        return next((row.time for row in rows if row.size >= 8 * length), rows[-1].time)

    def reading(self, length: int) -> Span:
        """See `Line`."""
        calls = reads(longest_frame(length))[1] if self.section.framing else 1
        return read_wait(calls, self.section.driver, self.tick)
