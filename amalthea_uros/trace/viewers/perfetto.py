"""Traces as Perfetto files: track events (protos/perfetto/trace/track_event in the sources of Perfetto).

Times are nanoseconds from 0, rounded down; the order, and so the nesting, is that of the picoseconds. A step of a chain is an instant
on the track of its process; the steps of one occurrence are connected by a flow.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from amalthea_uros.trace.table import Entity
from amalthea_uros.trace.viewers.timeline import (
    FIRST_TRACK,
    GROUPS,
    SHOWN_STATES,
    TimelineEncoder,
    TrackChange,
    TrackMark,
)

# The wire format of Protocol Buffers, as far as writing needs it (protobuf.dev, "Encoding").

_VARINT, _FIXED64, _LENGTH = 0, 1, 2
#: The numbers that are one byte, which most are.
_SINGLE = [bytes([number]) for number in range(0x80)]


def varint(number: int) -> bytes:
    """A number that is not negative, in groups of seven bits, the lowest first."""
    if number <= 0x7F:
        return _SINGLE[number]
    groups = bytearray()
    while number > 0x7F:
        groups.append(number & 0x7F | 0x80)
        number >>= 7
    groups.append(number)
    return bytes(groups)


def integer(field: int, number: int) -> bytes:
    """A field of type uint32, uint64, int32, int64 or an enumeration."""
    return varint(field << 3 | _VARINT) + varint(number)


def fixed64(field: int, number: int) -> bytes:
    """A field of type fixed64."""
    return varint(field << 3 | _FIXED64) + number.to_bytes(8, "little")


def message(field: int, *parts: bytes) -> bytes:
    """A field with a message in it, of which the fields are given."""
    content = b"".join(parts)
    return varint(field << 3 | _LENGTH) + varint(len(content)) + content


def text(field: int, value: str) -> bytes:
    """A field of type string."""
    return message(field, value.encode())


# Numbers of fields; the names are those of the messages.
_TRACE_PACKET = 1
_TIMESTAMP, _SEQUENCE_ID, _TRACK_EVENT, _INTERNED_DATA, _SEQUENCE_FLAGS, _TRACK_DESCRIPTOR = 8, 10, 11, 12, 13, 60
_TYPE, _NAME_IID, _TRACK_UUID, _FLOW_IDS = 9, 10, 11, 47
_UUID, _NAME, _PARENT_UUID, _CHILD_ORDERING, _SIBLING_ORDER_RANK, _SIBLING_MERGE_BEHAVIOR = 1, 2, 5, 11, 12, 15
_EVENT_NAMES, _EVENT_NAME_IID, _EVENT_NAME_NAME = 2, 1, 2

_EXPLICIT = 3  # ChildTracksOrdering
_NEVER_MERGED = 1  # SiblingMergeBehavior: else tracks of the same name are one
_CLEARED, _NEEDS_STATE = 1, 2  # SequenceFlags
_SEQUENCE = integer(_SEQUENCE_ID, 1)
_FLAGS = integer(_SEQUENCE_FLAGS, _NEEDS_STATE)

#: What comes before the fields of an event, and before those of the packet around it, by their lengths, which are small.
_TRACK_EVENT_HEADS = [message(_TRACK_EVENT, bytes(length)).removesuffix(bytes(length)) for length in range(64)]
_PACKET_HEADS = [message(_TRACE_PACKET, bytes(length)).removesuffix(bytes(length)) for length in range(128)]

_STATES = {state: number for number, state in enumerate(SHOWN_STATES, 1)}


class PerfettoEncoder(TimelineEncoder):
    """Makes the packets of a Perfetto file."""

    def __init__(self, entities: Sequence[Entity]) -> None:
        super().__init__(entities)
        self._tracks: set[int] = set()
        self._names: set[int] = set()
        self._events: dict[tuple[object, ...], bytes] = {}

    def begin(self) -> bytes:
        """The groups of tracks, and the names of the states."""
        names = [_name(number, state) for state, number in _STATES.items()]
        first = _packet(integer(_SEQUENCE_FLAGS, _CLEARED), message(_INTERNED_DATA, *names))
        groups = (
            message(_TRACK_DESCRIPTOR, integer(_UUID, group), text(_NAME, title), integer(_CHILD_ORDERING, _EXPLICIT))
            for group, title in GROUPS.items()
        )
        return first + b"".join(map(_packet, groups))

    def _encoded(self, marks: Iterable[TrackMark]) -> bytes:
        packets: list[bytes] = []
        time, stamp = -1, b""
        for mark in marks:
            key = mark[1:5]  # what comes again, other than flows
            fields = self._events.get(key)
            if fields is None:
                packets += self._new_packets(mark)
                fields = self._events[key] = self._event(mark)
            if mark.flow:
                fields = fields + fixed64(_FLOW_IDS, mark.flow)
            if mark.time != time:
                time = mark.time
                stamp = _SEQUENCE + _FLAGS + integer(_TIMESTAMP, time // 1000)
            inner = _TRACK_EVENT_HEADS[len(fields)]
            packets += (_PACKET_HEADS[len(stamp) + len(inner) + len(fields)], stamp, inner, fields)
        return b"".join(packets)

    def _event(self, mark: TrackMark) -> bytes:
        event = integer(_TYPE, mark.change) + integer(_TRACK_UUID, FIRST_TRACK + mark.track)
        if mark.change is TrackChange.END:
            return event
        return event + integer(_NAME_IID, _STATES[mark.state] if mark.state else FIRST_TRACK + mark.entity)

    def _new_packets(self, mark: TrackMark) -> list[bytes]:
        """The packets that say what the track and the name of a mark are, unless earlier ones do."""
        packets = []
        if mark.track not in self._tracks:
            self._tracks.add(mark.track)
            packets.append(_packet(self._descriptor(mark.track)))
        if mark.change is not TrackChange.END and not mark.state and mark.entity not in self._names:
            self._names.add(mark.entity)
            name = _name(FIRST_TRACK + mark.entity, self._entities[mark.entity].name)
            packets.append(_packet(_FLAGS, message(_INTERNED_DATA, name)))
        return packets

    def _descriptor(self, track: int) -> bytes:
        entity = self._entities[track]
        return message(
            _TRACK_DESCRIPTOR,
            integer(_UUID, FIRST_TRACK + track),
            text(_NAME, entity.name),
            integer(_PARENT_UUID, self._group(track)),
            integer(_SIBLING_ORDER_RANK, track),
            integer(_SIBLING_MERGE_BEHAVIOR, _NEVER_MERGED),
        )


def _packet(*fields: bytes) -> bytes:
    return message(_TRACE_PACKET, _SEQUENCE, *fields)


def _name(number: int, name: str) -> bytes:
    return message(_EVENT_NAMES, integer(_EVENT_NAME_IID, number), text(_EVENT_NAME_NAME, name))
