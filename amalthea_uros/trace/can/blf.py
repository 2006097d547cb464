"""Logs of CANalyzer and CANoe in the binary format of Vector (.blf), by python-can."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from amalthea_uros.diagnostics import Severity
from amalthea_uros.trace.can.python_can import PythonCanLog, Row, python_can
from amalthea_uros.trace.problems import Place
from amalthea_uros.trace.text_lines import opened_bytes

if TYPE_CHECKING:
    from can import BLFReader

_NANOSECOND = 1000


class BlfLog(PythonCanLog):
    """Gives the frames of a .blf file; a line is the number of a frame."""

    def _rows(self) -> Iterator[Row]:
        can = python_can()
        number = 0
        with opened_bytes(self._path, self._problems) as stream:
            try:
                reader: BLFReader = can.BLFReader(stream)
                # Times from the start are small enough for floating-point numbers to be exact in nanoseconds.
                reader.start_timestamp = 0.0
                self._resolution = _NANOSECOND
                for number, message in enumerate(reader, 1):
                    time = round(message.timestamp * 10**9) * _NANOSECOND
                    # python-can subtracts 1 from the number in the file.
                    channel = str(message.channel + 1) if isinstance(message.channel, int) else ""
                    row = self._row(message, time, channel, Place(number))
                    if row is not None:
                        yield row
            except OSError:
                raise
            except Exception as error:  # of many kinds, which python-can does not document
                self._report_end(error, Place(number))
                return
        self._check_size(reader)

    def _check_size(self, reader: BLFReader) -> None:
        """Check that the file has not become shorter; python-can stops at its end without a word."""
        size = self._path.stat().st_size
        if not self._path.name.lower().endswith(".gz") and size < reader.file_size:
            message = f"the file has {size:,} bytes, but its header says {reader.file_size:,}; the end is missing"
            self._problems.add(
                "CAN002", Severity.WARNING, message, advice="Check that the log was written and copied completely."
            )
