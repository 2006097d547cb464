"""What readers of logs have in common: channels, findings, and what the clock says."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.trace.can.frames import UNKNOWN, FrameTable
from amalthea_uros.trace.can.plausibility import BusWatch, ClockWatch
from amalthea_uros.trace.problems import TracePlace, TraceProblems

#: A computer has a few buses.
_MOST_CHANNELS = 256
_SHOWN = 16


class LogReader(ABC):
    """Gives the frames of a log; `amalthea_uros.trace.can.frames.CanLog` tells how it is used.

    Parameters
    ----------
    channel : the only one whose frames are given; None: those of all
    """

    def __init__(self, path: Path, channel: str | None) -> None:
        self._path, self._wanted = path, channel
        self._problems = TraceProblems(path)
        self._channels: list[str] = []
        self._indices: dict[str, int] = {}
        self._resolution: int | None = None
        self._origin: int | None = None

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The problems so far."""
        return self._problems.findings

    @property
    def resolution(self) -> int | None:
        """The step of the time stamps."""
        return self._resolution

    @property
    def origin(self) -> int:
        """The time in the log that is time 0 of the frames."""
        return self._origin or 0

    def __iter__(self) -> Iterator[FrameTable]:
        clock, buses = ClockWatch(self._problems), BusWatch(self._problems)
        for table in map(self._selected, self._tables()):
            if len(table):
                buses.watch(table)
                yield clock.watch(table, self._resolution or 0)
        clock.report()
        buses.report()
        if self._wanted is not None and self._wanted not in self._channels:
            self._report_missing_channel(self._wanted)

    @abstractmethod
    def _tables(self) -> Iterator[FrameTable]:
        """The frames of all channels, as the file has them."""

    def _channel(self, name: str) -> int:
        """The index of a channel, which gets one with its first frame; `UNKNOWN` if there are too many: then the names are damaged."""
        index = self._indices.get(name)
        if index is None:
            if len(self._channels) == _MOST_CHANNELS:
                return UNKNOWN
            index = self._indices[name] = len(self._channels)
            self._channels.append(name)
        return index

    def _report_channel(self, place: TracePlace) -> None:
        message = f"the log has more than {_MOST_CHANNELS} channels; a frame of another one is ignored"
        self._problems.add("CAN001", Severity.ERROR, message, place, "Check that the log is not damaged.")

    def _selected(self, table: FrameTable) -> FrameTable:
        if self._wanted is None:
            return table
        wanted = [UNKNOWN, self._indices.get(self._wanted, UNKNOWN)]
        places: Numbers = np.flatnonzero(np.isin(table.channel, wanted))
        return table if len(places) == len(table) else table.take(places)

    def _report_missing_channel(self, channel: str) -> None:
        known = ", ".join(self._channels[:_SHOWN]) or "none"
        message = f"the log has no channel {channel!r}; the channels of the log: {known}"
        self._problems.add("CAN007", Severity.ERROR, message, TracePlace(), "Name one of these channels.")
