"""Channels of one log compared: the same bus recorded twice, or two buses on which the same identifiers mean other frames."""

from __future__ import annotations

from collections import Counter
from itertools import combinations

import numpy as np

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.can.frames import FrameKind, FrameTable
from amalthea_uros.trace.problems import Problems

#: Two stamps of the same frame differ by what two adapters and the scheduling of the computer add.
_TOLERANCE = 10**9
#: From this share on, equal frames of two channels are no coincidence.
_SHARE = 0.5
#: Only so many channels are compared, those with the most frames, and none with fewer than 1 in 100 of those of the busiest: damaged
#: names look like further channels.
_COMPARED, _STRAY = 4, 100


class BusWatch:
    """Watches which frames consecutive tables have on several channels."""

    def __init__(self, problems: Problems) -> None:
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
