"""Markers: the frames of a CAN bus that say that something starts, ends, or how long it took; and where they occur in a log."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from typing import TypeAlias

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.trace.can.frames import EXTENDED, FrameKind, FrameTable
from amalthea_uros.units import Time

#: What a value in a payload is; None: the payload is too short for it, or says that there is none.
Decoder: TypeAlias = Callable[[bytes], Fraction | None]

#: Largest standard and extended identifiers.
_STANDARD, _LARGEST = 0x7FF, 0x1FFFFFFF
_FORM = re.compile(r"(?:(?P<channel>[^:#\s]+):)?(?:0[xX])?(?P<id>[0-9a-fA-F]{1,8})(?:#(?P<data>(?:[0-9a-fA-F]{2}|[xX]{2})+))?")
#: How markers are written, and an example for messages.
FORM = "[CHANNEL:]ID[#DATA]"
_EXAMPLE = "an example: 0x18000001, 123#01, or can0:123#xx02 (xx is any byte)"


@dataclass(frozen=True, slots=True)
class Marker:
    """Frames with an identifier, and with a payload that begins with some bytes.

    Attributes
    ----------
    identifier : with the bit `EXTENDED` if it has 29 bits
    data : the first bytes; None is any byte
    channel : the name of the bus; None: any
    """

    identifier: int
    data: tuple[int | None, ...] = ()
    channel: str | None = None

    def fits(self, payload: bytes) -> bool:
        """Whether a payload begins with the bytes."""
        return len(payload) >= len(self.data) and all(
            wanted is None or wanted == byte for wanted, byte in zip(self.data, payload, strict=False)
        )

    def overlaps(self, other: Marker) -> bool:
        """Whether a frame can be both."""
        is_one_bus = self.channel is None or other.channel is None or self.channel == other.channel
        bytes_ = zip(self.data, other.data, strict=False)
        is_one_payload = all(one is None or two is None or one == two for one, two in bytes_)
        return self.identifier == other.identifier and is_one_bus and is_one_payload

    def __str__(self) -> str:
        digits = f"{self.identifier & ~EXTENDED:08X}" if self.identifier & EXTENDED else f"{self.identifier:03X}"
        data = "".join("xx" if byte is None else f"{byte:02X}" for byte in self.data)
        return f"{f'{self.channel}:' if self.channel else ''}{digits}{f'#{data}' if data else ''}"


def parse_marker(text: str) -> Marker:
    """A marker as users write it: an identifier in hexadecimal, as candump shows it, with a bus and the first bytes if they matter.

    Identifiers with more than three digits, or above 7FF, have 29 bits.

    Raises
    ------
    ValueError : the text is no marker.
    """
    found = _FORM.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"{text!r} is not a marker of the form {FORM}; {_EXAMPLE}")
    number = int(found["id"], 16)
    if number > _LARGEST:
        raise ValueError(f"the identifier {found['id']} has more than 29 bits; the largest is {_LARGEST:X}")
    is_extended = number > _STANDARD or len(found["id"]) > 3
    pairs = re.findall("..", found["data"] or "")
    data = tuple(None if pair in ("xx", "XX", "xX", "Xx") else int(pair, 16) for pair in pairs)
    return Marker(number | (EXTENDED if is_extended else 0), data, found["channel"])


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkerCounter:
    """The number of the job in a payload, which counts up.

    Attributes
    ----------
    modulus : after so many numbers it starts again from 0
    """

    decode: Decoder = field(compare=False)
    modulus: int


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkerPair:
    """An object whose start and end are frames.

    Attributes
    ----------
    counter : None if the frames have no number
    period : the standard period; None if it is not stated
    baseline : name of the object whose times are subtracted; None: nothing is
    """

    name: str
    start: Marker
    end: Marker
    kind: MeasuredKind = MeasuredKind.INTERVAL
    quantity: str = "duration"
    counter: MarkerCounter | None = None
    period: Time | None = None
    baseline: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkerChain:
    """A chain from a stimulus to a response that are frames.

    Attributes
    ----------
    counter : in the frames of both: the number of the stimulus; None if there is none
    """

    name: str
    stimulus: Marker
    response: Marker
    counter: MarkerCounter | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportedValue:
    """Times that the controller measures itself, and sends one by one.

    Attributes
    ----------
    value : picoseconds
    """

    name: str
    marker: Marker
    value: Decoder = field(compare=False)
    kind: MeasuredKind = MeasuredKind.INTERVAL
    quantity: str = "duration"
    baseline: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportedStatistics:
    """Statistics that the controller computes itself, for example over a second, and sends.

    Attributes
    ----------
    min, mean, max, deviation : picoseconds; None: not sent
    count : of the values; None: not sent
    """

    name: str
    marker: Marker
    min: Decoder = field(compare=False)
    mean: Decoder = field(compare=False)
    max: Decoder = field(compare=False)
    deviation: Decoder | None = field(default=None, compare=False)
    count: Decoder | None = field(default=None, compare=False)
    kind: MeasuredKind = MeasuredKind.INTERVAL
    quantity: str = "duration"
    baseline: str | None = None


def refuse_overlap(first: Marker, second: Marker) -> None:
    """Refuse two markers that one frame can be.

    Raises
    ------
    ValueError : it would not be known which of them it is.
    """
    if first.overlaps(second):
        raise ValueError(f"a frame can be both {first} and {second}; give first bytes that differ, e.g. 123#01 and 123#02")


Measurable: TypeAlias = MarkerPair | MarkerChain | ReportedValue | ReportedStatistics


# Where markers occur in a log: one walk over the frames, of which only the marked ones are kept.


@dataclass(frozen=True, slots=True)
class MarkerOccurrences:
    """The frames of some markers, in the order of the log.

    Attributes
    ----------
    time : picoseconds from the first frame of the log
    marker : index of the marker
    channel : index of the bus
    segment : number of the part of the log between two gaps, from 0
    data : the payloads
    """

    time: Numbers
    marker: Numbers
    channel: Numbers
    segment: Numbers
    data: Sequence[bytes]

    def __len__(self) -> int:
        return len(self.time)

    def where(self, is_kept: Flags) -> MarkerOccurrences:
        """Those for which a value is true."""
        if is_kept.all():
            return self
        data = [self.data[number] for number in np.flatnonzero(is_kept).tolist()]
        return MarkerOccurrences(self.time[is_kept], self.marker[is_kept], self.channel[is_kept], self.segment[is_kept], data)


@dataclass(slots=True)
class MarkerCollector:
    """Collects the occurrences of markers, and what a log is like.

    Attributes
    ----------
    window : only frames in it are used
    frames, gaps : numbers in the window
    channels : names of the buses
    origin : time of the first frame of the log, in picoseconds as the log states it; None: there is none
    first, last : times of the first and the latest frame in the window, from `origin` on; None: there is none
    uncertain : for each marker the number of its frames at a step back of the clock, which are not used: one of the two stamps is wrong
    seen : how often identifiers occur on which bus: (channel, identifier) -> number
    """

    markers: Sequence[Marker]
    window: MeasurementWindow
    frames: int = 0
    gaps: int = 0
    channels: Sequence[str] = ()
    origin: int | None = None
    first: int | None = None
    last: int | None = None
    uncertain: dict[int, int] = field(default_factory=dict)
    seen: dict[tuple[int, int], int] = field(default_factory=dict)
    _parts: list[MarkerOccurrences] = field(default_factory=list)

    def add_all(self, tables: Iterable[FrameTable]) -> None:
        """Take the tables of a log in."""
        for table in tables:
            if len(table):
                self._add(table)

    def _add(self, table: FrameTable) -> None:
        self.channels = table.channels
        if self.origin is None:
            frames = table.time[table.kind != FrameKind.GAP]
            if not len(frames):
                return  # nothing is before the first frame
            self.origin = int(frames[0])
        time = table.time - self.origin
        is_inside = self.window.holds(time)
        if not is_inside.any():
            return
        is_gap = (table.kind == FrameKind.GAP) & is_inside
        segment = self.gaps + np.cumsum(is_gap)
        self.gaps += int(np.count_nonzero(is_gap))
        is_frame = (table.kind == FrameKind.DATA) & is_inside
        self.frames += int(np.count_nonzero(is_frame))
        if is_frame.any():
            inside = time[is_frame]
            self.first = int(inside[0]) if self.first is None else self.first
            self.last = max(int(inside.max()), self.last or 0)
        self._count(table, is_frame)
        is_uncertain = _at_steps_back(table)
        found = []
        for number, marker in enumerate(self.markers):
            places = self._found(table, is_frame, marker)
            is_used = ~is_uncertain[places]
            self.uncertain[number] = self.uncertain.get(number, 0) + int(np.count_nonzero(~is_used))
            found.append(places[is_used])
        rows = np.concatenate([np.empty(0, np.int64), *found])
        which = np.repeat(np.arange(len(found)), [len(each) for each in found])
        order = np.argsort(rows, kind="stable")
        rows, which = rows[order], which[order]
        data = [table.data[row] for row in rows.tolist()]
        self._parts.append(MarkerOccurrences(time[rows], which, table.channel[rows].astype(np.int64), segment[rows], data))

    def _count(self, table: FrameTable, is_frame: Flags) -> None:
        keys, numbers = np.unique(table.identifier[is_frame] << 16 | table.channel[is_frame], return_counts=True)
        for key, number in zip(keys.tolist(), numbers.tolist(), strict=True):
            place = key & 0xFFFF, key >> 16
            self.seen[place] = self.seen.get(place, 0) + number

    def _found(self, table: FrameTable, is_frame: Flags, marker: Marker) -> Numbers:
        """The rows of a marker."""
        is_found = is_frame & (table.identifier == marker.identifier)
        if marker.channel is not None:
            if marker.channel not in table.channels:
                return np.empty(0, np.int64)
            is_found &= table.channel == table.channels.index(marker.channel)
        rows = np.flatnonzero(is_found)
        if marker.data:
            rows = rows[np.array([marker.fits(table.data[row]) for row in rows.tolist()], bool)]
        return rows

    @property
    def occurrences(self) -> MarkerOccurrences:
        """All that were found so far."""
        empty = np.empty(0, np.int64)
        parts = [MarkerOccurrences(empty, empty, empty, empty, []), *self._parts]
        time, marker, channel, segment = (
            np.concatenate([getattr(part, name) for part in parts]) for name in ("time", "marker", "channel", "segment")
        )
        return MarkerOccurrences(time, marker, channel, segment, [data for part in parts for data in part.data])


def _at_steps_back(table: FrameTable) -> Flags:
    """Which frames are directly before or after a gap over which the time of their bus steps back."""
    found = np.zeros(len(table), bool)
    is_gap = table.kind == FrameKind.GAP
    for channel in np.unique(table.channel[is_gap]).tolist():
        places = np.flatnonzero(table.channel == channel)
        gaps = np.flatnonzero(is_gap[places][1:-1]) + 1
        before, after = places[gaps - 1], places[gaps + 1]
        is_back = table.time[before] > table.time[after]
        found[before[is_back]] = found[after[is_back]] = True
    return found
