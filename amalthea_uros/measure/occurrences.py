"""Where markers occur in a log: one walk over the frames, of which only the marked ones are kept."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros.measure.markers import Marker
from amalthea_uros.measure.window import MeasurementWindow
from amalthea_uros.trace.can.frames import FrameKind, FrameTable


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
