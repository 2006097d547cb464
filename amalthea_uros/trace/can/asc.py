"""Logs of CANalyzer and CANoe in the text format of Vector (.asc), by python-can."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import IO, TYPE_CHECKING

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.can.error_frames import report_lost
from amalthea_uros.trace.can.frames import FrameKind
from amalthea_uros.trace.can.python_can import Row, python_can
from amalthea_uros.trace.can.text_log import TextLog
from amalthea_uros.trace.problems import Place

if TYPE_CHECKING:
    from can import Message

_BASE = re.compile(r"base\s+(?:hex|dec)\s+timestamps\s+relative", re.IGNORECASE)
_STAMP = re.compile(r"\s*([0-9]{1,9})\.([0-9]{1,12})\s+(\S*)")
_REMARK = re.compile(
    r"\s*(?://|date\s|base\s|begin\s|end\s|(?:no\s+)?internal\s|[0-9.]+\s+start\s+of\s+measurement|$)", re.IGNORECASE
)
#: Records that recorders write between frames, with nothing lost.
_RECORD = re.compile(
    r"\s*[0-9.]+\s+\S*\s*(?:Statistic:|J1939TP|CAN\s+\d+\s+Status:|Status:|SV:|log\s+(?:direct|trigger)\b)", re.IGNORECASE
)
_OVERRUN = re.compile(r"over\s?run", re.IGNORECASE)
_PICOSECONDS = 12


class AscLog(TextLog):
    """Gives the frames of an .asc file; the channels have the numbers that the file gives them."""

    header_end = "no internal events logged\n"

    _is_relative = False

    def _reader(self, stream: IO[str]) -> Iterable[Message]:
        reader: Iterable[Message] = python_can().ASCReader(stream)
        return reader

    def _prepared(self, line: str) -> str:
        if match := _STAMP.match(line):
            step = 10 ** (_PICOSECONDS - len(match[2]))
            time = int(match[1]) * 10**_PICOSECONDS + int(match[2]) * step
            # All lines with a time count, whether they are frames or not.
            self._time = self._time + time if self._is_relative else time
            self._resolution = max(step, self._resolution or 0)
        elif _BASE.match(line.strip()):
            self._is_relative = True
            message = "the times are differences between lines (timestamps relative); they are added up"
            advice = "Save the log with absolute time stamps: a line that is missing or damaged shifts all that follow."
            self._problems.add("CAN005", Severity.WARNING, message, advice=advice)
        return line

    def _channel_name(self, message: Message) -> str:
        # python-can subtracts 1 from the number in the file.
        return str(message.channel + 1) if isinstance(message.channel, int) else ""

    def _leave_out(self, line: str, place: Place) -> None:
        match = _STAMP.match(line)
        if match and _OVERRUN.search(line):
            report_lost(self._problems, place)
            if self._channel(match[3]) < 0:
                self._report_channel(place)
                return
            self._gap = Row(self._time, match[3], 0, FrameKind.GAP, place.line or 0, b"")
        elif _RECORD.match(line):
            self._problems.add("CAN006", Severity.INFO, "a record is not a frame; it is ignored", place)
        elif not _REMARK.match(line):
            super()._leave_out(line, place)
