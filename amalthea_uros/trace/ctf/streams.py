"""The events of one file of a CTF trace, packet by packet; what is damaged is left out up to where the next packet begins."""

from __future__ import annotations

import mmap
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.ctf.decoding import Decoder, Fields
from amalthea_uros.trace.ctf.metadata import EventType, Metadata, StreamType, TraceClock
from amalthea_uros.trace.ctf.types import IntegerType, StructType
from amalthea_uros.trace.files import TraceProblems, UnreadableError

_MAGIC = 0xC1FC1FC1
#: A pause of a short clock at its overflow is uncertain if it is so many times the longest one before, and long at all.
_UNCERTAIN = 2
_SHORT_PAUSE = 10**10
_WORD = 64
_LARGER = "Record into a larger buffer, or fewer kinds of events."


class CtfEvent(NamedTuple):
    """An event; the name is "" where events have been lost.

    Attributes
    ----------
    time : picoseconds from the origin of the clock
    core : the number of the core, None if the trace does not say it
    context : fields that all events of the stream or of this kind have
    lost : the number of lost events, None if it is not known
    """

    time: int
    name: str
    core: int | None
    fields: Fields
    context: Fields
    lost: int | None = None


class _Packet(NamedTuple):
    """Where a packet and its content are, in bits of the file."""

    end: int
    content_end: int
    is_whole: bool


class PacketStream:
    """Gives the events of a file; what is wrong with it becomes known to `problems`."""

    def __init__(self, path: Path, metadata: Metadata, problems: TraceProblems) -> None:
        self._path, self._metadata, self._problems = path, metadata, problems
        self._stamp = 0
        self._time = 0
        self._clock = TraceClock()
        self._longest = 0
        self._has_times_in_packets = False
        self._latest: int | None = None
        self._discarded = 0
        self._sequence: int | None = None
        self._core: int | None = None

    def __iter__(self) -> Iterator[CtfEvent]:
        try:
            with self._path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
                yield from self._packets(data)
        except ValueError:  # an empty file cannot be mapped
            return
        except OSError as error:
            self._problems.add("TRC001", Severity.ERROR, f"the file cannot be read: {error.strerror or error}")

    def _packets(self, data: mmap.mmap) -> Iterator[CtfEvent]:
        decoder, place, size = Decoder(data), 0, len(data) * 8
        while place < size:
            decoder.start_packet(place, size)
            decoder.start_event()
            try:
                kind, context = self._header(decoder)
                packet = self._extent(decoder, context, place, size)
            except UnreadableError as error:
                self._report(f"{error}; searching for the next packet")
                yield from self._loss(None)
                place = self._next_packet(data, place)
                continue
            lost = self._lost(context)
            if lost:
                yield from self._loss(max(lost, 0) or None)
            if self._misses_packets(context):
                yield from self._loss(None)
            yield from self._events(decoder, kind, packet)
            if lost:
                # Some recorders count events that are lost before a packet, others those after it, so neither is crossed.
                yield from self._loss(0)
            place = packet.end

    def _header(self, decoder: Decoder) -> tuple[StreamType, Fields]:
        """The kind of stream and the context of a packet."""
        header = decoder.structure(self._metadata.packet_header)
        if header.get("magic", _MAGIC) != _MAGIC:
            raise UnreadableError("a packet does not begin with the magic number of CTF")
        streams = self._metadata.streams
        kind = streams.get(header.get("stream_id", next(iter(streams), 0)))
        if kind is None:
            raise UnreadableError("a packet is of a stream that the metadata do not describe")
        decoder.stamps.clear()
        return kind, decoder.structure(kind.packet_context)

    def _extent(self, decoder: Decoder, context: Fields, place: int, size: int) -> _Packet:
        """Where a packet ends; in a file that ends early it is cut off there."""
        total = context.get("packet_size", size - place)
        content = context.get("content_size", total)
        if (
            not (isinstance(total, int) and isinstance(content, int))
            or not decoder.position - place <= content <= total
            or total % 8
        ):
            raise UnreadableError("the sizes of a packet are wrong")
        if place + total > size:
            if self._next_packet(decoder.data, place) < size:
                raise UnreadableError("the sizes of a packet are wrong")
            self._report("the file ends within a packet; the events before that are used")
        begin, end = context.get("timestamp_begin"), context.get("timestamp_end")
        self._has_times_in_packets = isinstance(begin, int)
        self._latest = end if isinstance(begin, int) and isinstance(end, int) and end >= begin else None
        if decoder.stamps:
            stamp, kind = decoder.stamps[0]
            self._clock = self._metadata.clocks.get(kind.clock, TraceClock())
            self._set(self._whole(stamp, kind))
        core = context.get("cpu_id", self._core)
        if self._core not in (None, core):
            message = "a file has packets of several cores, of which the times are not in order"
            self._problems.add("TRC020", Severity.ERROR, message, advice="Split it, e.g. with split_ctf_streams.py of Zephyr.")
        self._core = core
        decoder.end = min(place + content, size)
        return _Packet(min(place + total, size), decoder.end, place + content <= size)

    def _lost(self, context: Fields) -> int:
        """How many events more than at the packet before are lost by the count of the recorder; negative if it has started again."""
        discarded = context.get("events_discarded")
        if not isinstance(discarded, int):
            return 0
        lost, self._discarded = discarded - self._discarded, discarded
        if lost:
            self._problems.add("TRC022", Severity.WARNING, "the recorder has lost events", advice=_LARGER)
        return lost

    def _misses_packets(self, context: Fields) -> bool:
        """Whether packets are missing before one, by their numbers."""
        sequence = context.get("packet_seq_num")
        if not isinstance(sequence, int):
            return False
        misses = self._sequence is not None and sequence != self._sequence + 1
        self._sequence = sequence
        if misses:
            self._problems.add("TRC022", Severity.WARNING, "packets are missing", advice=_LARGER)
        return misses

    def _events(self, decoder: Decoder, kind: StreamType, packet: _Packet) -> Iterator[CtfEvent]:
        header_type, context_type = kind.event_header, kind.event_context
        while decoder.position < packet.content_end:
            decoder.start_event()
            start = decoder.position
            try:
                event, number = self._event_type(decoder, kind, header_type)
                stamps = decoder.stamps[-1:]
                context = decoder.structure(context_type)
                if event.context is not None:
                    context = {**context, **decoder.structure(event.context)}
                fields = decoder.structure(event.fields)
                if decoder.position <= start:
                    raise UnreadableError("an event has no size")
                is_uncertain = self._advance(stamps)
            except UnreadableError as error:
                if not error.is_cut or packet.is_whole:
                    self._report(f"{error}; the rest of the packet is ignored")
                yield from self._loss(None)
                return
            if is_uncertain:
                yield from self._loss(None)
            yield CtfEvent(self._time, event.name or f"event {number}", self._core, fields, context)

    def _event_type(self, decoder: Decoder, kind: StreamType, header_type: StructType | None) -> tuple[EventType, int]:
        decoder.stamps.clear()
        header = decoder.structure(header_type)
        extended = header.get("v")
        number = (
            extended["id"] if isinstance(extended, dict) and "id" in extended else header.get("id", next(iter(kind.events), 0))
        )
        event = kind.events.get(number)
        if event is None:
            raise UnreadableError("an event has an id that the metadata do not know, so its length is not known")
        return event, number

    def _advance(self, stamps: list[tuple[int, IntegerType]]) -> bool:
        """Take the time of an event over; whether it is uncertain that nothing is missing before it."""
        if not stamps:
            raise UnreadableError("events have no times")
        stamp, kind = stamps[0]
        self._clock = self._metadata.clocks.get(kind.clock, self._clock)
        before, whole = self._stamp, self._whole(stamp, kind)
        if self._latest is not None and whole > self._latest:
            raise UnreadableError("an event is later than the end of its packet")
        self._set(whole)
        return not self._has_times_in_packets and kind.size < _WORD and self._is_uncertain(before, whole, kind)

    def _whole(self, stamp: int, kind: IntegerType) -> int:
        """A stamp with the bits that a short clock does not show: it has overflown once at most since the last one."""
        if kind.size == _WORD:
            return stamp
        size = 1 << kind.size
        whole = (self._stamp & -size) | stamp
        return whole if whole >= self._stamp else whole + size

    def _set(self, stamp: int) -> None:
        self._stamp = stamp
        self._time = self._clock.time(stamp)

    def _is_uncertain(self, before: int, after: int, kind: IntegerType) -> bool:
        """Whether a clock has overflown and the pause is much longer than all before."""
        pause = self._clock.time(after) - self._clock.time(before)
        if before >> kind.size != after >> kind.size and pause > max(_UNCERTAIN * self._longest, _SHORT_PAUSE):
            message = "the clock has overflown early, or there is an unusually long pause; nothing is paired over it"
            self._problems.add("TRC023", Severity.WARNING, message, advice="Record with stamps of 64 bits.")
            return True
        if before:
            self._longest = max(self._longest, pause)
        return False

    def _loss(self, lost: int | None) -> Iterator[CtfEvent]:
        """A loss at the present time; none before the first event, where nothing can be open."""
        if self._time:
            yield CtfEvent(self._time, "", self._core, {}, {}, lost)

    def _next_packet(self, data: mmap.mmap | bytes, place: int) -> int:
        """Where the next magic number is, or the end of the file."""
        header = self._metadata.packet_header
        magic = dict(header.fields).get("magic") if header is not None else None
        if not isinstance(magic, IntegerType):
            return len(data) * 8
        octets = _MAGIC.to_bytes(4, "big" if magic.is_big_endian else "little")
        found = data.find(octets, place // 8 + 1)
        return len(data) * 8 if found < 0 else found * 8

    def _report(self, message: str) -> None:
        self._problems.add(
            "TRC020",
            Severity.ERROR,
            message,
            advice="Check that the metadata are of the same build.",
        )
