"""Binary formats: files of Vector (.blf) by python-can, and ASAM MDF 4 (.mf4) by python-can and asammdf."""

from __future__ import annotations

import gc
import logging
import struct
import sys
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import IO, TYPE_CHECKING

from amalthea_uros._internal.files import read_up_to
from amalthea_uros._internal.limits import ADVICE, MODEL_SIZE
from amalthea_uros.diagnostics import Severity
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.can.python_can import FrameRow, PythonCanLog, python_can
from amalthea_uros.trace.files import TracePlace, UnreadableError, opened_bytes

if TYPE_CHECKING:
    from can import BLFReader, MF4Reader

#: Signature and size of the header of the file.
_FILE = struct.Struct("<4sL")
#: Signature, size and version of the header, size and type of the object.
_OBJECT = struct.Struct("<4sHHLL")
#: Method of compression, size of the content.
_CONTAINER = struct.Struct("<H6xL4x")
_CONTAINER_TYPE = 10
_PLAIN, _DEFLATED = 0, 2


def damages(stream: IO[bytes]) -> Iterator[str]:
    """What is wrong with the containers of a file, from its beginning.

    Raises
    ------
    UnreadableError : a container must not be unpacked.
    """
    header = stream.read(_FILE.size)
    if len(header) < _FILE.size:
        return
    read_up_to(stream, max(_FILE.unpack(header)[1] - _FILE.size, 0))
    while base := stream.read(_OBJECT.size):
        if len(base) < _OBJECT.size:
            yield "the file ends in a header"
            return
        signature, _, _, size, kind = _OBJECT.unpack(base)
        if signature != b"LOBJ" or size < _OBJECT.size:
            yield "a container does not begin with LOBJ; it and the rest are not used"
            return
        if size > MODEL_SIZE:
            raise UnreadableError(ADVICE)
        content = read_up_to(stream, size - _OBJECT.size)
        if len(content) < size - _OBJECT.size:
            yield "the file ends in a container"
        elif kind != _CONTAINER_TYPE:
            yield "a record is not a container; it is ignored"
        elif not _is_sound(content):
            yield "a container is damaged; its frames are missing"
        stream.read(size % 4)


def _is_sound(content: bytes) -> bool:
    if len(content) < _CONTAINER.size:
        return False
    method, size = _CONTAINER.unpack_from(content)
    packed = content[_CONTAINER.size :]
    if method != _DEFLATED:
        return bool(method == _PLAIN)
    unpacking = zlib.decompressobj()
    try:
        unpacked = len(unpacking.decompress(packed, min(size, MODEL_SIZE) + 1))
    except zlib.error:
        return False
    if unpacked > MODEL_SIZE or unpacking.unconsumed_tail:
        raise UnreadableError(ADVICE)
    return unpacking.eof and unpacked == size


_NANOSECOND = 1000


class BlfLog(PythonCanLog):
    """Gives the frames of a .blf file; a line is the number of a frame."""

    def _rows(self) -> Iterator[FrameRow]:
        can = python_can()
        if not self._is_safe():
            return
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
                    row = self._row(message, time, channel, TracePlace(number))
                    if row is not None:
                        yield row
            except OSError:
                raise
            except Exception as error:  # of many kinds, which python-can does not document
                self._report_end(error, TracePlace(number))
                return
            self._check_size(reader)

    def _is_safe(self) -> bool:
        """Whether all containers may be unpacked; reports those that are damaged."""
        with opened_bytes(self._path, self._problems) as stream:
            try:
                for damage in damages(stream):
                    self._report_damage(damage, TracePlace())
            except UnreadableError as error:
                message = "a container of the file is too large to be unpacked; nothing is read"
                self._problems.add("CAN008", Severity.ERROR, message, advice=str(error))
                return False
        return True

    def _check_size(self, reader: BLFReader) -> None:
        """Check that the file has not become shorter; python-can stops at its end without a word."""
        size = self._path.stat().st_size
        if not self._path.name.lower().endswith(".gz") and size < reader.file_size:
            message = f"the file has {size:,} bytes, but its header says {reader.file_size:,}; the end is missing"
            self._problems.add(
                "CAN002", Severity.WARNING, message, advice="Check that the log was written and copied completely."
            )


# Bus logging in files of ASAM MDF 4 (.mf4), by python-can and asammdf.


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
