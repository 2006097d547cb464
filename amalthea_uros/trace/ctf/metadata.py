"""What the metadata of a CTF trace say: streams, events, clocks."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from fractions import Fraction
from pathlib import Path

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.trace.ctf.tsdl import MetadataBlock, parse
from amalthea_uros.trace.ctf.types import FieldType, IntegerType, StructType, VariantType
from amalthea_uros.trace.files import UnreadableError

#: Of packets of metadata: the magic number, and the header after it (section 7.1): uuid, checksum, content and packet size in bits,
#: compression, encryption, checksum scheme, version.
_MAGIC = 0x75D11D57
_HEADER = struct.Struct("I16sIIIBBBBB")
_COMMENT = b"/* CTF 1."
_MOST_BYTES = 64 * 2**20
_SECOND = 10**12
#: The clock of stamps that name none: nanoseconds.
NO_CLOCK = "\0"
_STAMPS = ("timestamp", "timestamp_begin", "timestamp_end")


@dataclass(frozen=True, slots=True)
class TraceClock:
    """A clock.

    Attributes
    ----------
    frequency : Hz
    offset : of its zero from 1970 or another origin, in picoseconds
    """

    frequency: int = 10**9
    offset: int = 0

    def time(self, ticks: int) -> int:
        """A stamp as picoseconds."""
        return self.offset + ticks * _SECOND // self.frequency

    @property
    def tick(self) -> Fraction:
        """Picoseconds of a tick."""
        return Fraction(_SECOND, self.frequency)


@dataclass(frozen=True, slots=True)
class EventType:
    """A kind of event; None where there are no fields."""

    name: str
    context: StructType | None
    fields: StructType | None


@dataclass(slots=True)
class StreamType:
    """A kind of stream.

    Attributes
    ----------
    events : by their ids
    """

    packet_context: StructType | None = None
    event_header: StructType | None = None
    event_context: StructType | None = None
    events: dict[int, EventType] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Metadata:
    """The metadata of a trace."""

    packet_header: StructType | None
    streams: Mapping[int, StreamType]
    clocks: Mapping[str, TraceClock]
    environment: Mapping[str, int | str]


def is_metadata(path: Path) -> bool:
    """Whether a file begins as metadata do (sections 7.1 and 7.2)."""
    try:
        with path.open("rb") as stream:
            head = stream.read(len(_COMMENT))
    except OSError:
        return False
    return head == _COMMENT or head[:4] in (struct.pack(f"{order}I", _MAGIC) for order in "<>")


def read_metadata(path: Path) -> Metadata:
    """The metadata in a file, as text or in packets.

    Raises
    ------
    UnreadableError : they cannot be understood.
    OSError : the file cannot be read.
    """
    with path.open("rb") as stream:
        data = stream.read(_MOST_BYTES + 1)
    if len(data) > _MOST_BYTES:
        raise UnreadableError(f"the metadata have more than {_MOST_BYTES:,} bytes", 1)
    return described(_text(data).replace("\x00", " "))


def described(source: str) -> Metadata:
    """The metadata in a text.

    Raises
    ------
    UnreadableError : they cannot be understood.
    """
    blocks = parse(source)
    trace = next((block for block in blocks if block.kind == "trace"), MetadataBlock("trace"))
    environment = next((block for block in blocks if block.kind == "env"), MetadataBlock("env"))
    streams: dict[int, StreamType] = {}
    for block in blocks:
        if block.kind == "stream":
            streams[block.number("id", 0)] = StreamType(
                _stamped(block.struct("packet.context")), _stamped(block.struct("event.header")), block.struct("event.context")
            )
    for block in blocks:
        if block.kind == "event":
            events = streams.setdefault(block.number("stream_id", 0), StreamType()).events
            events[block.number("id", 0)] = EventType(block.text("name"), block.struct("context"), block.struct("fields"))
    values = {key: value for key, value in environment.values.items() if isinstance(value, (int, str))}
    return Metadata(trace.struct("packet.header"), streams, _clocks(blocks), values)


def _clocks(blocks: list[MetadataBlock]) -> dict[str, TraceClock]:
    found = {NO_CLOCK: TraceClock()}
    for block in blocks:
        if block.kind == "clock":
            frequency = block.number("freq", 10**9)
            if frequency <= 0:
                raise UnreadableError("the frequency of a clock is not positive", 1)
            offset = block.number("offset_s", 0) * _SECOND + block.number("offset", 0) * _SECOND // frequency
            found[block.text("name")] = TraceClock(frequency, offset)
    return found


def _text(data: bytes) -> str:
    """The text of metadata, taken out of packets if there are any."""
    for order in "<>":
        if data[:4] == struct.pack(f"{order}I", _MAGIC):
            return _unpacked(data, order).decode("utf-8", "replace")
    return data.decode("utf-8", "replace")


def _unpacked(data: bytes, order: str) -> bytes:
    header, parts, place = struct.Struct(order + _HEADER.format), [], 0
    while place + header.size <= len(data):
        magic, _, _, content, packet, *schemes, _, _ = header.unpack_from(data, place)
        if magic != _MAGIC or any(schemes[:2]):
            raise UnreadableError("a packet of metadata has a wrong magic number, or is compressed or encrypted", 1)
        if not header.size * 8 <= content <= packet:
            raise UnreadableError("a packet of metadata has a wrong size", 1)
        parts.append(data[place + header.size : place + content // 8])
        place += packet // 8
    return b"".join(parts)


def _stamped(kind: StructType | None) -> StructType | None:
    """A header in which stamps that name no clock have the one of nanoseconds."""
    return None if kind is None else _with_clock(kind, "", 0)  # type: ignore[return-value]


def _with_clock(kind: FieldType, name: str, depth: int) -> FieldType:
    if depth > 4:
        return kind
    if isinstance(kind, IntegerType) and name in _STAMPS and not kind.clock:
        return replace(kind, clock=NO_CLOCK)
    if isinstance(kind, StructType):
        return replace(kind, fields=tuple((each, _with_clock(inner, each, depth + 1)) for each, inner in kind.fields))
    if isinstance(kind, VariantType):
        return replace(kind, options={each: _with_clock(inner, each, depth + 1) for each, inner in kind.options.items()})
    return kind
