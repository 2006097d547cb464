"""Bus logging in files of ASAM MDF 4 (.mf4), by python-can and asammdf."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.can.python_can import PythonCanLog, Row, python_can
from amalthea_uros.trace.problems import Place
from amalthea_uros.trace.text_lines import opened_bytes

_MICROSECOND = 10**6
_SECOND = 10**12


class Mf4Log(PythonCanLog):
    """Gives the frames of an .mf4 file; a line is the number of a frame.

    python-can gives seconds since 1970 as floating-point numbers, which are exact to 0.24 us: times are rounded to microseconds.
    """

    def _rows(self) -> Iterator[Row]:
        can = python_can()
        _require_asammdf()
        number = 0
        with opened_bytes(self._path, self._problems):
            pass  # a file that cannot be opened is reported as for other formats
        try:
            with can.MF4Reader(self._path) as reader:
                for number, message in enumerate(reader, 1):
                    micros = round(message.timestamp * 10**6)
                    if self._origin is None:
                        self._origin = micros * _MICROSECOND // _SECOND * _SECOND
                        self._resolution = _MICROSECOND
                    channel = "" if message.channel is None else str(message.channel)
                    row = self._row(message, micros * _MICROSECOND - self._origin, channel, Place(number))
                    if row is not None:
                        yield row
        except Exception as error:  # of many kinds, which asammdf does not document
            self._report_end(error, Place(number))


def _require_asammdf() -> None:
    try:
        import asammdf  # noqa: F401
    except ImportError as error:
        raise InvalidArgumentError(".mf4 files need asammdf; install it with: pip install asammdf") from error
