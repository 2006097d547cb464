"""Text formats that python-can reads line by line; a line on which it fails is left out, and the rest is read."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable, Iterator
from typing import IO, TYPE_CHECKING, cast

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.can.frames import FrameKind
from amalthea_uros.trace.can.line_feed import LineFeed
from amalthea_uros.trace.can.python_can import PythonCanLog, Row, python_can
from amalthea_uros.trace.problems import Place
from amalthea_uros.trace.text_lines import opened_text

if TYPE_CHECKING:
    from can import Message


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
    _gap: Row | None = None

    def _rows(self) -> Iterator[Row]:
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

    def _leave_out(self, line: str, place: Place) -> None:
        """Report a line of which the reader has made nothing, if it could be more than a remark; it may have been a frame."""
        message = "a record is not a frame; it is ignored"
        self._problems.add("CAN006", Severity.INFO, message, place)
        self._note_loss(place)

    def _note_loss(self, place: Place) -> None:
        """Note that it is not known what a line was."""
        self._gap = self._gap or Row(self._before, None, 0, FrameKind.GAP, place.line or 0, b"")

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
