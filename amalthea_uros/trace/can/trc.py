"""Logs of PCAN-View and PCAN-Explorer of PEAK-System (.trc), by python-can."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import IO, TYPE_CHECKING

from amalthea_uros.trace.can.python_can import python_can
from amalthea_uros.trace.can.text_log import TextLog
from amalthea_uros.trace.problems import Place

if TYPE_CHECKING:
    from can import Message

#: Number of the message, with a parenthesis in older versions, and milliseconds since the start.
_STAMP = re.compile(r"\s*[0-9]+\)?\s+([0-9]{1,12})(?:\.([0-9]{1,9}))?\s")
_MILLISECOND_DIGITS = 9


class TrcLog(TextLog):
    """Gives the frames of a .trc file; the channels have the numbers that the file gives them."""

    def _reader(self, stream: IO[str]) -> Iterable[Message]:
        reader: Iterable[Message] = python_can().TRCReader(stream)
        return reader

    def _prepared(self, line: str) -> str:
        if match := _STAMP.match(line):
            decimals = match[2] or ""
            step = 10 ** (_MILLISECOND_DIGITS - len(decimals))
            self._time = int(match[1] + decimals) * step
            self._resolution = max(step, self._resolution or 0)
        return line

    def _channel_name(self, message: Message) -> str:
        return str(message.channel)

    def _leave_out(self, line: str, place: Place) -> None:
        if line.strip() and not line.lstrip().startswith(";"):
            super()._leave_out(line, place)
