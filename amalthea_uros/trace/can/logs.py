"""Logs of CAN buses: what their readers have in common, and opening one in any known format."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import cast

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.files import STANDARD_INPUT, is_fifo
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.can.candump_lines import is_frame
from amalthea_uros.trace.can.frames import UNKNOWN, FrameTable
from amalthea_uros.trace.can.plausibility import BusWatch, ClockWatch
from amalthea_uros.trace.files import TracePlace, TraceProblems, first_bytes
from amalthea_uros.trace.readers import format_of

#: A computer has a few buses.
_MOST_CHANNELS = 256
_SHOWN = 16


class CanLog(ABC):
    """Gives the frames of a log file, in consecutive tables; it can be used once.

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
        """The problems met so far; everything else has been read."""
        return self._problems.findings

    @property
    def resolution(self) -> int | None:
        """The smallest step of the time stamps in picoseconds; None if the format does not say, or nothing has been read."""
        return self._resolution

    @property
    def origin(self) -> int:
        """What times of frames are added to, to get those of the log, in picoseconds: 64 bits are too few for times since 1970."""
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


# Opening a log in any known format.


#: The modules that read a format, and their classes, by the ends of the names of files.
_READERS = {
    ".log": ("candump", "CandumpLog"),
    ".asc": ("text_logs", "AscLog"),
    ".blf": ("binary_logs", "BlfLog"),
    ".trc": ("text_logs", "TrcLog"),
    ".mf4": ("binary_logs", "Mf4Log"),
}
#: The ends of the names of files. `.gz` may follow them, apart from .mf4.
SUFFIXES = tuple(_READERS)
_NEVER_PACKED = ".mf4"
#: The first bytes of formats that are recognised by them.
_BEGINS = {".blf": b"LOGG", ".mf4": b"MDF     4", ".trc": b";$FILEVERSION"}
#: So many bytes and lines are looked at, of which the first may be damaged.
_HEAD, _LINES = 1 << 14, 50
#: What comes from standard input or another pipe: candump writes to it.
_PIPED = ".log"


def is_can_log(path: Path) -> bool:
    """Whether a file is a log of a CAN bus, by its first bytes, or by its name if they say nothing."""
    return _suffix(path) is not None


def open_can_log(path: Path, *, channel: str | None = None) -> CanLog:
    """The frames of a log, by the first bytes or the end of the name of its file.

    Parameters
    ----------
    channel : give only the frames of this one; by default those of all

    Raises
    ------
    InvalidArgumentError : no reader is known for it; when frames are read, if it needs a package that is not installed.
    ReadError : when frames are read, if the file cannot be.
    """
    suffix = _suffix(path)
    if suffix is None:
        raise InvalidArgumentError(
            f"the format of the log {path.name!r} is not known; its first lines are not those of candump, and its name does not end in "
            f"one of {', '.join(SUFFIXES)}, which, apart from {_NEVER_PACKED}, may be followed by .gz, e.g. run.log.gz"
        )
    module, name = _READERS[suffix]
    reader = getattr(import_module(f"amalthea_uros.trace.can.{module}"), name)
    return cast("Callable[[Path, str | None], CanLog]", reader)(path, channel)


def _suffix(path: Path) -> str | None:
    if path == STANDARD_INPUT or is_fifo(path):
        return _PIPED
    return _recognised(first_bytes(path, _HEAD)) or _named(path)


def _named(path: Path) -> str | None:
    name = path.name.lower()
    plain = name.removesuffix(".gz")
    found = next((end for end in SUFFIXES if (name if end == _NEVER_PACKED else plain).endswith(end)), None)
    # Logs of operating systems have the same name.
    return None if found == _PIPED and format_of(path) is not None else found


def _recognised(head: bytes) -> str | None:
    """The usual end of the name of a file with this begin."""
    for end, begin in _BEGINS.items():
        if head.startswith(begin):
            return end
    lines = head.decode("utf-8-sig", errors="replace").splitlines()[:_LINES]
    return _PIPED if any(map(is_frame, lines)) else None
