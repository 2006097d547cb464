"""Reads what candump of can-utils writes: log files (`-l`, `-L`, `-f`), and its console with time stamps."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import IO, TYPE_CHECKING

import numpy as np

from amalthea_uros._internal.arrays import Flags, Numbers
from amalthea_uros._internal.limits import TRACE_LINE
from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.can.candump_lines import CandumpLine, CandumpLines, parse, read_lines
from amalthea_uros.trace.can.frames import UNKNOWN, FrameKind, FrameTable, is_receive_overflow, report_error, report_lost
from amalthea_uros.trace.can.logs import CanLog
from amalthea_uros.trace.files import LINE_TOO_LONG, TracePlace, UnreadableError, opened_bytes

if TYPE_CHECKING:
    from numpy.typing import NDArray

_BLOCK = 1 << 20
_SECOND = 10**12
#: As many picoseconds from the origin fit into 64 bits, with some left for differences: 46 days.
_RANGE = 4 * 10**18
#: A stamp further from the middle of the first ones cannot be meant as the beginning of the log.
_NEAR = 10**6 * _SECOND
#: candump writes times since 1970 with ten digits, others with three or a few more.
_ABSOLUTE_DIGITS = 10
#: candump writes all times of a log with the same number of digits; a digit more or less moves those after it.
_MICROSECOND, _NANOSECOND = 10**6, 10**3
_SHOWN = 200
_FAR = "the time of a frame is years or months from that of the others; it is ignored"
_DIGITS = "the time of a frame has more or fewer decimals than those of the others; it is ignored"
_ADVICE = "Check that the log is complete, and that candump wrote it (e.g. with -l)."


class CandumpLog(CanLog):
    """Gives the frames of a text of candump."""

    def __init__(self, path: Path, channel: str | None) -> None:
        super().__init__(path, channel)
        self._line = 1
        self._last = 0
        self._has_differences = False

    def _tables(self) -> Iterator[FrameTable]:
        with opened_bytes(self._path, self._problems) as stream:
            for block in self._blocks(stream):
                table = self._table(block)
                if len(table):
                    self._last = int(table.time[-1])
                yield table

    def _blocks(self, stream: IO[bytes]) -> Iterator[bytes]:
        """Whole lines, some at a time; a last one without an end may have been cut, so that its data are not known."""
        rest = stream.read(3).removeprefix(b"\xef\xbb\xbf")
        # One read of the file at a time, so that what precedes the damage of a packed file is given.
        while part := stream.read1(_BLOCK):  # type: ignore[attr-defined]
            block = rest + part
            size = block.rfind(b"\n") + 1
            rest = block[size:]
            if size:
                yield block[:size]
            if len(rest) > TRACE_LINE:
                raise UnreadableError(LINE_TOO_LONG, self._line)
        if rest.endswith(b"\n"):
            yield rest
        elif rest:
            message = "the last line has no end, so it may be incomplete; it is ignored"
            self._problems.add("CAN002", Severity.WARNING, message, self._place(rest, 0), "Check that the log is complete.")

    def _table(self, block: bytes) -> FrameTable:
        """A row for each line that is not empty; those that cannot be used are gaps, since nobody knows what they were."""
        lines = read_lines(block, self._channel)
        others = self._other_lines(block, lines)
        if self._origin is None:
            self._begin(lines, others)
        is_frame = lines.is_plain & self._is_usual(block, lines)
        lines.channel[~is_frame], lines.identifier[~is_frame], lines.length[~is_frame] = UNKNOWN, 0, 0
        first_second = self.origin // _SECOND
        time = np.where(is_frame, (lines.seconds - first_second) * _SECOND + lines.fraction * 1000, 0)
        kind, data = np.where(is_frame, FrameKind.DATA, FrameKind.GAP).astype(np.int8), lines.payloads()
        for number, line in others.items():
            channel = self._channel_of(line, self._place(_line(block, lines, number), number))
            if channel != UNKNOWN:
                if line.stamp is not None and line.kind is not FrameKind.GAP:  # that has the time of the frame before it
                    time[number] = line.stamp.time - self.origin
                kind[number], lines.channel[number], lines.identifier[number] = line.kind, channel, line.identifier
                data[number] = line.data
        numbers = np.arange(self._line, self._line + len(time))
        self._line += len(time)
        table = FrameTable(self._channels, time, lines.channel, lines.identifier, kind, numbers, data)
        is_row = lines.end > lines.start
        table = table if is_row.all() else table.take(np.flatnonzero(is_row))
        return replace(table, time=self._completed(table.time, table.kind))

    def _is_usual(self, block: bytes, lines: CandumpLines) -> Flags:
        """Whether the times of plain lines are like those of the other lines; others are reported."""
        is_near: Flags = abs(lines.seconds - self.origin // _SECOND) < _RANGE // _SECOND
        has_digits: Flags = np.where(lines.has_nanoseconds, _NANOSECOND, _MICROSECOND) == self._resolution
        for number in np.flatnonzero(lines.is_plain & ~(is_near & has_digits)).tolist():
            place = self._place(_line(block, lines, number), number)
            self._report_time(_DIGITS if is_near[number] else _FAR, place)
        return is_near & has_digits

    def _channel_of(self, line: CandumpLine, place: TracePlace) -> int:
        """The channel of a line that is not plain, `UNKNOWN` if it cannot be used; that is reported."""
        if line.kind is FrameKind.GAP:
            return self._channel(line.channel)
        if line.stamp is not None and abs(line.stamp.time - self.origin) > _RANGE:
            self._report_time(_FAR, place)
        elif line.stamp is not None and line.stamp.step != self._resolution:
            self._report_time(_DIGITS, place)
        elif (channel := self._channel(line.channel)) == UNKNOWN:
            self._report_channel(place)
        else:
            return channel
        return UNKNOWN

    def _completed(self, time: Numbers, kind: NDArray[np.int8]) -> Numbers:
        """The times in which differences are added up, and gaps have the time of the frame before them."""
        is_gap = kind == FrameKind.GAP
        if self._has_differences:
            time = self._last + np.cumsum(np.where(is_gap, 0, time))
        last = np.maximum.accumulate(np.where(is_gap, -1, np.arange(len(time))))
        return np.where(last < 0, self._last, time[last])

    def _other_lines(self, block: bytes, lines: CandumpLines) -> dict[int, CandumpLine]:
        """The lines that are not plain, by their numbers in the block; those that are no frames are reported."""
        found = {}
        for number in np.flatnonzero(~lines.is_plain & (lines.end > lines.start)).tolist():
            text = _line(block, lines, number)
            place = self._place(text, number)
            try:
                line = parse(text.decode(errors="replace"))
            except UnreadableError as error:
                self._problems.add("CAN001", Severity.ERROR, str(error), place, _ADVICE)
                continue
            if line.kind is FrameKind.ERROR:
                report_error(self._problems, line.identifier, line.data, place)
                if is_receive_overflow(line.identifier, line.data):
                    line = replace(line, identifier=0, kind=FrameKind.GAP)
            elif line.kind is FrameKind.GAP:
                report_lost(self._problems, place)
            found[number] = line
        return found

    def _begin(self, lines: CandumpLines, others: Mapping[int, CandumpLine]) -> None:
        """Find the origin of the times, their digits, and whether they are differences, from the first lines."""
        stamps = {number: line.stamp for number, line in others.items() if line.stamp is not None}
        times = {number: stamp.time for number, stamp in stamps.items()}
        times |= {int(number): int(lines.seconds[number]) * _SECOND for number in np.flatnonzero(lines.is_plain)}
        if not times:
            return
        middle = sorted(times.values())[len(times) // 2]
        steps = Counter(stamp.step for stamp in stamps.values())
        steps.update(np.where(lines.has_nanoseconds, _NANOSECOND, _MICROSECOND)[lines.is_plain].tolist())
        self._resolution = max(steps, key=lambda step: (steps[step], step))
        first = next(time for _, time in sorted(times.items()) if abs(time - middle) < _NEAR)
        self._origin = first // _SECOND * _SECOND
        relative = [stamp.time for stamp in stamps.values() if stamp.digits < _ABSOLUTE_DIGITS]
        if not lines.is_plain.any() and any(later < earlier for earlier, later in pairwise(relative)):
            self._has_differences, self._origin = True, 0
            message = "the times decrease, so they are differences between frames (candump -td); they are added up"
            self._problems.add("CAN005", Severity.WARNING, message, advice="Record with candump -ta, or better with -l.")
        if any(stamp.is_local for stamp in stamps.values()):
            message = "the times are dates in a local time zone, which may change between summer and winter"
            self._problems.add("CAN005", Severity.WARNING, message, advice="Record with candump -ta, or better with -l.")

    def _place(self, text: bytes, number: int) -> TracePlace:
        return TracePlace(self._line + number, 1, text[:_SHOWN].decode(errors="replace"))

    def _report_time(self, message: str, place: TracePlace) -> None:
        self._problems.add("CAN001", Severity.ERROR, message, place, _ADVICE)


def _line(block: bytes, lines: CandumpLines, number: int) -> bytes:
    return block[lines.start[number] : lines.end[number]]
