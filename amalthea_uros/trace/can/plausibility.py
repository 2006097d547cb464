"""What frames tell about their recording: steps and pauses of clocks, the same bus recorded twice."""

from __future__ import annotations

from collections import Counter
from itertools import combinations

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.can.frames import FrameKind, FrameTable
from amalthea_uros.trace.files import TracePlace, TraceProblems

#: A pause is worth a word if it is so many times as long as the second longest, and at least so long.
_FACTOR, _SHORTEST = 10, 10**12


class ClockWatch:
    """Watches the times of consecutive tables.

    The clock of each channel is watched for itself: a computer that reads several buses need not store their frames in the order of
    their times.
    """

    def __init__(self, problems: TraceProblems) -> None:
        self._problems = problems
        self._last: dict[int, int] = {}
        self._end: int | None = None
        self._longest, self._second, self._line = 0, 0, 0

    def watch(self, table: FrameTable, resolution: int) -> FrameTable:
        """The table with a gap wherever the time of a channel steps back by more than the resolution."""
        steps = np.zeros(len(table), np.bool_)
        for channel in np.unique(table.channel).tolist():
            places = np.flatnonzero((table.channel == channel) & (table.kind != FrameKind.GAP))
            if len(places):
                time = table.time[places]
                before = np.concatenate(([self._last.get(channel, time[0])], time[:-1]))
                steps[places] = before - time > resolution
                self._last[channel] = int(time[-1])
        self._note_pauses(table)
        places = np.flatnonzero(steps)
        for place in places.tolist():
            message = f"the clock of {table.channels[table.channel[place]]!r} steps back; nothing is paired across the step"
            advice = "Keep the clock from being set while recording, e.g. by a time server."
            self._problems.add("CAN009", Severity.WARNING, message, TracePlace(int(table.line[place])), advice)
        return _with_gaps(table, places) if len(places) else table

    def report(self) -> None:
        """Report a pause that is much longer than all others."""
        if self._longest >= max(_SHORTEST, _FACTOR * self._second) and self._second:
            seconds = self._longest / 10**12
            message = f"no frame for {seconds:.4g} s, more than {_FACTOR} times as long as in all other pauses"
            advice = "Check whether the bus was silent, the recording was interrupted, or the clock was set."
            self._problems.add("CAN010", Severity.INFO, message, TracePlace(self._line), advice)

    def _note_pauses(self, table: FrameTable) -> None:
        before = np.concatenate(([table.time[0] if self._end is None else self._end], table.time[:-1]))
        pauses = table.time - before
        place = int(np.argmax(pauses))
        longest = int(pauses[place])
        pauses[place] = 0
        if longest > self._longest:
            self._longest, self._line, others = longest, int(table.line[place]), (self._longest, self._second)
        else:
            others = (longest, self._second)
        self._second = max(*others, int(pauses.max()))
        self._end = int(table.time[-1])


def _with_gaps(table: FrameTable, places: Numbers) -> FrameTable:
    """The table with a gap before the frames at some places, at their times."""
    rows = np.sort(np.concatenate((np.arange(len(table)), places)))
    taken = table.take(rows)
    gaps = places + np.arange(len(places))
    taken.kind[gaps], taken.identifier[gaps] = FrameKind.GAP, 0
    data = list(taken.data)
    for gap in gaps.tolist():
        data[gap] = b""
    return FrameTable(table.channels, taken.time, taken.channel, taken.identifier, taken.kind, taken.line, data)


# Channels of one log compared: the same bus recorded twice, or two buses on which the same identifiers mean other frames.

#: Two stamps of the same frame differ by what two adapters and the scheduling of the computer add.
_TOLERANCE = 10**9
#: From this share on, equal frames of two channels are no coincidence.
_SHARE = 0.5
#: Only so many channels are compared, those with the most frames, and none with fewer than 1 in 100 of those of the busiest: damaged
#: names look like further channels.
_COMPARED, _STRAY = 4, 100


class BusWatch:
    """Watches which frames consecutive tables have on several channels."""

    def __init__(self, problems: TraceProblems) -> None:
        self._problems = problems
        self._frames: Counter[tuple[int, int]] = Counter()
        self._twice: Counter[tuple[int, int]] = Counter()
        self._channels: tuple[str, ...] = ()

    def watch(self, table: FrameTable) -> None:
        """Count the frames of a table."""
        self._channels = tuple(table.channels)
        self._count(table)
        if len(self._channels) > 1:
            self._count_twice(table)

    def report(self) -> None:
        """Report what pairs of channels have in common."""
        identifiers: dict[int, Counter[int]] = {}
        for (channel, identifier), count in self._frames.items():
            identifiers.setdefault(channel, Counter())[identifier] = count
        totals = {channel: found.total() for channel, found in identifiers.items()}
        largest = [
            channel
            for channel in sorted(totals, key=lambda channel: -totals[channel])[:_COMPARED]
            if totals[channel] * _STRAY >= max(totals.values())
        ]
        for first, second in combinations(sorted(largest), 2):
            common = identifiers[first].keys() & identifiers[second].keys()
            frames = min(sum(identifiers[channel][one] for one in common) for channel in (first, second))
            if common:
                self._report_pair(first, second, len(common), frames)

    def _report_pair(self, first: int, second: int, identifiers: int, frames: int) -> None:
        names = f"{self._channels[first]!r} and {self._channels[second]!r}"
        twice = self._twice[first, second]
        if twice >= _SHARE * frames:
            message = f"{names} have {twice} equal frames at the same times: one bus was recorded twice"
            advice = "Choose one of them with --channel, so that no frame counts twice."
        else:
            message = f"{names} use {identifiers} equal identifiers for different frames: they are two buses"
            advice = "Choose one of them with --channel, so that frames of one are not paired with those of the other."
        self._problems.add("CAN011", Severity.WARNING, message, advice=advice)

    def _count(self, table: FrameTable) -> None:
        frames = table.kind <= FrameKind.REMOTE
        # An identifier has up to 33 bits.
        keys, counts = np.unique(table.channel[frames].astype(np.int64) << 40 | table.identifier[frames], return_counts=True)
        for key, count in zip(keys.tolist(), counts.tolist(), strict=True):
            self._frames[key >> 40, key & (1 << 40) - 1] += count

    def _count_twice(self, table: FrameTable) -> None:
        """Count frames that are neighbours in time among those with the same identifier and data, on different channels."""
        data = np.array([hash(payload) for payload in table.data], np.int64)
        order = np.lexsort((table.time, data, table.identifier))
        first, second = order[:-1], order[1:]
        is_twice = (
            (table.identifier[first] == table.identifier[second])
            & (data[first] == data[second])
            & (table.channel[first] != table.channel[second])
            & (table.time[second] - table.time[first] <= _TOLERANCE)
            & (table.kind[first] <= FrameKind.REMOTE)
            & (table.kind[second] <= FrameKind.REMOTE)
        )
        pairs = zip(table.channel[first[is_twice]].tolist(), table.channel[second[is_twice]].tolist(), strict=True)
        self._twice.update((min(pair), max(pair)) for pair in pairs)
