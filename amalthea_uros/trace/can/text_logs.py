"""Text formats of Vector (.asc) and PEAK-System (.trc), which python-can reads line by line."""

from __future__ import annotations

import re
from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator
from typing import IO, TYPE_CHECKING, cast

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.can.frames import FrameKind, report_lost
from amalthea_uros.trace.can.python_can import FrameRow, PythonCanLog, python_can
from amalthea_uros.trace.files import TracePlace, opened_text

if TYPE_CHECKING:
    from can import Message


class LineFeed:
    """A file that a reader of python-can takes its lines from.

    Parameters
    ----------
    prepare : gives the line that the reader gets
    left_out : called with a line of which the reader has made nothing

    Attributes
    ----------
    is_at_end : whether all lines have been read
    failure : why no more lines can be read; None: all could be
    """

    def __init__(
        self, lines: Iterator[str], prepare: Callable[[str], str], left_out: Callable[[str, TracePlace], None]
    ) -> None:
        self._lines, self._prepare, self._left_out = lines, prepare, left_out
        self._number, self._text, self._is_used = 0, "", True
        self._first: list[str] = []
        self.is_at_end = False
        self.failure: Exception | None = None

    def __iter__(self) -> Iterator[str]:
        return self

    def __next__(self) -> str:
        if self._first:
            return self._first.pop()
        self._settle()
        try:
            self._text = next(self._lines)
        except StopIteration:
            self.is_at_end = True
            raise
        except Exception as error:  # readers of python-can take it for their own
            self.is_at_end, self.failure = True, error
            raise
        self._number += 1
        self._is_used = False
        return self._prepare(self._text)

    @property
    def place(self) -> TracePlace:
        """Where the line is that was read last."""
        return TracePlace(self._number, 1, self._text.rstrip("\r\n")[:200])

    def use(self) -> None:
        """State that something was made of the last line."""
        self._is_used = True

    def push(self, line: str) -> None:
        """Let a line be the next, which is not in the file."""
        self._first.append(line)

    def close(self) -> None:
        """Readers call it at the end; the lines are closed by those who opened them."""
        self._settle()

    def _settle(self) -> None:
        if not self._is_used:
            self._is_used = True
            self._left_out(self._text, self.place)


# Text formats that python-can reads line by line; a line on which it fails is left out, and the rest is read.


class TextLog(PythonCanLog):
    """A log in a text format.

    Attributes
    ----------
    _time : of the line that was read last, in picoseconds
    _gap : where frames were lost before the line that was read last; None if none were
    _before : time of the last frame
    """

    #: For a reader that is started again: a line that ends the header, None if the next frame does.
    header_end: str | None = None

    _time = _before = 0
    _gap: FrameRow | None = None

    def _rows(self) -> Iterator[FrameRow]:
        python_can()
        with opened_text(self._path, self._problems) as lines:
            feed = LineFeed(lines, self._prepared, self._leave_out)
            for message in self._messages(self._reader(cast("IO[str]", feed)), feed):
                row = self._row(message, self._time, self._channel_name(message), feed.place)
                if row is None:
                    self._note_loss(feed.place)
                yield from filter(None, (self._gap, row))
                self._gap, self._before = None, self._before if row is None else row.time
            yield from filter(None, (self._gap,))

    @abstractmethod
    def _reader(self, stream: IO[str]) -> Iterable[Message]:
        """The reader of python-can."""

    @abstractmethod
    def _prepared(self, line: str) -> str:
        """The line that the reader is given, after its time has been read."""

    @abstractmethod
    def _channel_name(self, message: Message) -> str:
        """The channel as the file names it."""

    def _leave_out(self, line: str, place: TracePlace) -> None:
        """Report a line of which the reader has made nothing, if it could be more than a remark; it may have been a frame."""
        message = "a record is not a frame; it is ignored"
        self._problems.add("CAN006", Severity.INFO, message, place)
        self._note_loss(place)

    def _note_loss(self, place: TracePlace) -> None:
        """Note that it is not known what a line was."""
        self._gap = self._gap or FrameRow(self._before, None, 0, FrameKind.GAP, place.line or 0, b"")

    def _messages(self, reader: Iterable[Message], feed: LineFeed) -> Iterator[Message]:
        messages = iter(reader)
        while not feed.is_at_end:
            try:
                message = next(messages)
            except StopIteration:
                return
            except Exception as error:  # of many kinds, which python-can does not document; the line is to blame
                if feed.failure is not None:
                    raise feed.failure from error
                self._report_damage("a line cannot be read; it is ignored", feed.place)
                self._note_loss(feed.place)
                feed.use()
                if self.header_end is not None:
                    feed.push(self.header_end)
                messages = iter(reader)
            else:
                feed.use()
                yield message


# Logs of CANalyzer and CANoe in the text format of Vector (.asc), by python-can.

_BASE = re.compile(r"base\s+(?:hex|dec)\s+timestamps\s+relative", re.IGNORECASE)
_ASC_STAMP = re.compile(r"\s*([0-9]{1,9})\.([0-9]{1,12})\s+(\S*)")
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
        if match := _ASC_STAMP.match(line):
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

    def _leave_out(self, line: str, place: TracePlace) -> None:
        match = _ASC_STAMP.match(line)
        if match and _OVERRUN.search(line):
            report_lost(self._problems, place)
            if self._channel(match[3]) < 0:
                self._report_channel(place)
                return
            self._gap = FrameRow(self._time, match[3], 0, FrameKind.GAP, place.line or 0, b"")
        elif _RECORD.match(line):
            self._problems.add("CAN006", Severity.INFO, "a record is not a frame; it is ignored", place)
        elif not _REMARK.match(line):
            super()._leave_out(line, place)


# Logs of PCAN-View and PCAN-Explorer of PEAK-System (.trc), by python-can.

#: Number of the message, with a parenthesis in older versions, and milliseconds since the start.
_TRC_STAMP = re.compile(r"\s*[0-9]+\)?\s+([0-9]{1,12})(?:\.([0-9]{1,9}))?\s")
_MILLISECOND_DIGITS = 9


class TrcLog(TextLog):
    """Gives the frames of a .trc file; the channels have the numbers that the file gives them."""

    def _reader(self, stream: IO[str]) -> Iterable[Message]:
        reader: Iterable[Message] = python_can().TRCReader(stream)
        return reader

    def _prepared(self, line: str) -> str:
        if match := _TRC_STAMP.match(line):
            decimals = match[2] or ""
            step = 10 ** (_MILLISECOND_DIGITS - len(decimals))
            self._time = int(match[1] + decimals) * step
            self._resolution = max(step, self._resolution or 0)
        return line

    def _channel_name(self, message: Message) -> str:
        return str(message.channel)

    def _leave_out(self, line: str, place: TracePlace) -> None:
        if line.strip() and not line.lstrip().startswith(";"):
            super()._leave_out(line, place)
