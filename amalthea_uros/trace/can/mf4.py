"""Bus logging in files of ASAM MDF 4 (.mf4), by python-can and asammdf."""

from __future__ import annotations

import gc
import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.can.python_can import FrameRow, PythonCanLog, python_can
from amalthea_uros.trace.files import opened_bytes
from amalthea_uros.trace.problems import TracePlace

if TYPE_CHECKING:
    from can import MF4Reader

_MICROSECOND = 10**6
_SECOND = 10**12


class Mf4Log(PythonCanLog):
    """Gives the frames of an .mf4 file; a line is the number of a frame.

    python-can gives seconds since 1970 as floating-point numbers, which are exact to 0.24 us: times are rounded to microseconds.
    """

    def _rows(self) -> Iterator[FrameRow]:
        python_can()
        _require_asammdf()
        with opened_bytes(self._path, self._problems):
            pass  # a file that cannot be opened is reported as for other formats
        reader = self._reader()
        if reader is None:
            return
        number = 0
        try:
            with reader:
                for number, message in enumerate(reader, 1):
                    micros = round(message.timestamp * 10**6)
                    if self._origin is None:
                        self._origin = micros * _MICROSECOND // _SECOND * _SECOND
                        self._resolution = _MICROSECOND
                    channel = "" if message.channel is None else str(message.channel)
                    row = self._row(message, micros * _MICROSECOND - self._origin, channel, TracePlace(number))
                    if row is not None:
                        yield row
        except Exception as error:  # of many kinds, which asammdf does not document
            self._report_end(error, TracePlace(number))

    def _reader(self) -> MF4Reader | None:
        """The reader of python-can; None, and a finding, if the file is none of the format."""
        with _ignoring_destructors():
            try:
                return python_can().MF4Reader(self._path)  # type: ignore[no-any-return]
            except Exception as error:  # of many kinds, which asammdf does not document
                self._report_end(error, TracePlace())
            gc.collect()  # the object is in a circle of references
        return None


@contextmanager
def _ignoring_destructors() -> Iterator[None]:
    """Print nothing about errors in destructors: that of an object of asammdf whose initialization fails does so itself."""
    hook, sys.unraisablehook = sys.unraisablehook, lambda _: None
    try:
        yield
    finally:
        sys.unraisablehook = hook


def _require_asammdf() -> None:
    try:
        import asammdf  # noqa: F401
    except ImportError as error:
        raise InvalidArgumentError(".mf4 files need asammdf; install it with: pip install asammdf") from error
    logging.getLogger("asammdf").addHandler(logging.NullHandler())
