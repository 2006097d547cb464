"""Frames from the readers of python-can, which is optional, and what becomes of the exceptions that damaged files cause in them.

Times are not taken from `can.Message.timestamp` where the file has them exactly: those are floating-point seconds, of which since 1970
one step is 238 ns.
"""

from __future__ import annotations

import logging
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from itertools import islice
from types import ModuleType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.can.frames import EXTENDED, UNKNOWN, FrameKind, FrameTable, report_error
from amalthea_uros.trace.can.logs import CanLog
from amalthea_uros.trace.files import TracePlace

if TYPE_CHECKING:
    from can import Message

_ROWS = 1 << 13
_MAX_STANDARD, _MAX_EXTENDED, _MAX_BYTES = 0x7FF, 0x1FFF_FFFF, 64
#: Times that cannot be right, and would not fit into 64 bits.
_MAX_TIME = 4 * 10**18


class FrameRow(NamedTuple):
    """A row of a table of frames, with the name of the channel; None of a gap of which it is not known."""

    time: int
    channel: str | None
    identifier: int
    kind: FrameKind
    line: int
    data: bytes


def python_can() -> ModuleType:
    """The package.

    Raises
    ------
    InvalidArgumentError : it is not installed.
    """
    try:
        import can
    except ImportError as error:
        raise InvalidArgumentError("this format needs python-can; install it with: pip install amuros[can]") from error
    # Else what it logs of damaged files goes to standard error, besides our findings.
    logging.getLogger("can").addHandler(logging.NullHandler())
    return can


class PythonCanLog(CanLog):
    """A log that python-can reads."""

    def _tables(self) -> Iterator[FrameTable]:
        rows = self._rows()
        while part := list(islice(rows, _ROWS)):
            yield self._table(part)

    @abstractmethod
    def _rows(self) -> Iterator[FrameRow]:
        """The frames of the file."""

    def _row(self, message: Message, time: int, channel: str, place: TracePlace) -> FrameRow | None:
        """The row of a message; None, and a finding, if python-can took something for a frame that is none."""
        largest = _MAX_EXTENDED if message.is_extended_id else _MAX_STANDARD
        data = bytes(message.data or b"")
        if not (0 <= message.arbitration_id <= largest and len(data) <= _MAX_BYTES and abs(time) <= _MAX_TIME):
            self._report_damage("an identifier, a length or a time is too large; the frame is ignored", place)
            return None
        if self._channel(channel) < 0:
            self._report_channel(place)
            return None
        if message.is_error_frame:
            report_error(self._problems, 0, b"", place)
            return FrameRow(time, channel, 0, FrameKind.ERROR, place.line or 0, data)
        identifier = message.arbitration_id | (EXTENDED if message.is_extended_id else 0)
        kind = FrameKind.REMOTE if message.is_remote_frame else FrameKind.DATA
        return FrameRow(time, channel, identifier, kind, place.line or 0, data if kind is FrameKind.DATA else b"")

    def _table(self, rows: Sequence[FrameRow]) -> FrameTable:
        time, channel, identifier, kind, line, data = zip(*rows, strict=True)
        return FrameTable(
            self._channels,
            np.array(time, np.int64),
            np.array([UNKNOWN if name is None else self._channel(name) for name in channel], np.int16),
            np.array(identifier, np.int64),
            np.array(kind, np.int8),
            np.array(line, np.int64),
            data,
        )

    def _report_damage(self, message: str, place: TracePlace) -> None:
        self._problems.add("CAN001", Severity.ERROR, message, place, "Check that the log is complete.")

    def _report_end(self, error: Exception, place: TracePlace) -> None:
        """Report that the rest of the file cannot be read."""
        message = f"the file is damaged ({type(error).__name__}: {error}); only the frames before that are used"
        self._problems.add("CAN008", Severity.ERROR, message, place, "Check that it was written and copied completely.")
