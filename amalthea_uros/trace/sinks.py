"""Where traces are written to: table by table, into a file that appears only when it is complete, or into memory."""

from __future__ import annotations

import gzip
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from importlib import import_module
from pathlib import Path
from types import TracebackType
from typing import BinaryIO, Self, cast

from amalthea_uros._internal.file_writing import replacing, write_bytes
from amalthea_uros._internal.files import STANDARD_OUTPUT, FileError, is_stream, not_writable
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import InvalidArgumentError, WriteError
from amalthea_uros.trace.table import Entity, EventTable, concatenate

#: Only that many rows are formatted at a time, which bounds the memory.
_ROWS = 1 << 13
#: Much faster than the default, and traces are compressed to a few percent anyway.
_COMPRESSION = 4

#: The modules and classes that write a format, by the ends of file names. `.gz` may follow each of them.
WRITERS = {
    ".btf": ("btf_format", "BtfEncoder"),
    ".perfetto-trace": ("viewers.perfetto", "PerfettoEncoder"),
    ".pftrace": ("viewers.perfetto", "PerfettoEncoder"),
    ".perfetto.json": ("viewers.chrome_json", "ChromeEncoder"),
    ".json": ("viewers.chrome_json", "ChromeEncoder"),
    ".csv": ("csv_format", "CsvEncoder"),
    ".log": ("can.candump_writer", "CandumpEncoder"),
}


class Encoder(ABC):
    """Makes the bytes of a format: those at the beginning, those for each table, and those at the end.

    Parameters
    ----------
    entities : those of the tables; more may be appended to the sequence while the trace is written
    """

    def __init__(self, entities: Sequence[Entity]) -> None:
        self._entities = entities

    def begin(self) -> bytes:
        """The bytes before all events; nothing where a format has no header."""
        return b""

    @abstractmethod
    def encode(self, table: EventTable) -> bytes:
        """The bytes for some events."""

    def end(self) -> bytes:
        """The bytes after all events; nothing where a file ends with the last event."""
        return b""

    def companion(self) -> tuple[str, bytes] | None:
        """What a second file has after the name of the file, and its content, if one is needed to understand the first."""
        return None


class TraceSink(ABC):
    """Where events go, in the order in which they occur.

    As a context manager, it completes the trace at the end of the block, and discards it after an exception.
    """

    @abstractmethod
    def write(self, table: EventTable) -> None:
        """Add some events."""

    def close(self) -> None:  # noqa: B027 - many have nothing left to do
        """Complete the trace, if something is left to do."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        if error is None:
            self.close()


def open_sink(target: Path | BinaryIO, entities: Sequence[Entity], suffix: str | None = None) -> TraceSink:
    """A sink that writes a trace in the format that the end of the file name stands for.

    Parameters
    ----------
    target : a file, or an open stream, which is not closed; standard output gets the format BTF
    entities : those of the tables; more may be appended to the sequence while the trace is written
    suffix : stands for the format instead of the name, e.g. ".btf" or ".btf.gz"; a stream needs it

    Raises
    ------
    InvalidArgumentError : there is no such format.
    WriteError : the file cannot be written.
    """
    if suffix is None and target == STANDARD_OUTPUT:
        suffix = ".btf"
    name = (suffix if suffix is not None else target.name if isinstance(target, Path) else "").lower()
    encoder = _encoder(name.removesuffix(".gz"), name)(entities)
    return _EncodingSink(target, encoder, is_compressed=name.endswith(".gz"))


def _encoder(name: str, given: str) -> Callable[[Sequence[Entity]], Encoder]:
    found = next((writer for suffix, writer in WRITERS.items() if name.endswith(suffix)), None)
    if found is None:
        known = ", ".join(WRITERS)
        raise InvalidArgumentError(
            f"no trace format is known for {given!r}; the name of the file must end in one of {known}, and may be followed by .gz, "
            "e.g. run.btf.gz"
        )
    module, encoder = found
    return cast("Callable[[Sequence[Entity]], Encoder]", getattr(import_module(f"amalthea_uros.trace.{module}"), encoder))


class _EncodingSink(TraceSink):
    """Writes what an encoder makes of tables."""

    def __init__(self, target: Path | BinaryIO, encoder: Encoder, is_compressed: bool) -> None:
        self._target, self._encoder = target, encoder
        with ExitStack() as stack:
            self._stream = stack.enter_context(_opened(target))
            if is_compressed:
                # Without name and time, equal traces are equal files.
                packed = gzip.GzipFile("", "wb", _COMPRESSION, self._stream, mtime=0)
                self._stream = cast("BinaryIO", stack.enter_context(packed))
            self._put(encoder.begin())
            self._stack = stack.pop_all()
        self._is_open = True

    def write(self, table: EventTable) -> None:
        """Add some events."""
        for first in range(0, len(table), _ROWS):
            self._put(self._encoder.encode(table.rows(first, first + _ROWS)))

    def close(self) -> None:
        """Complete the trace."""
        if self._is_open:
            self._is_open = False
            with _reporting(self._target), self._stack:
                self._put(self._encoder.end())
            companion = self._encoder.companion()
            if companion is not None and isinstance(self._target, Path) and not is_stream(self._target):
                ending, content = companion
                path = self._target.with_name(self._target.name.removesuffix(".gz") + ending)
                with _reporting(path):
                    write_bytes(path, content)

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        if error is None:
            self.close()
        else:
            self._is_open = False
            self._stack.__exit__(kind, error, traceback)

    def _put(self, data: bytes) -> None:
        with _reporting(self._target):
            self._stream.write(data)


@contextmanager
def _opened(target: Path | BinaryIO) -> Iterator[BinaryIO]:
    if not isinstance(target, Path):
        yield target
        return
    with _reporting(target), replacing(target) as stream:
        yield stream


@contextmanager
def _reporting(target: Path | BinaryIO) -> Iterator[None]:
    """Errors of a file as those that users see; the holder of a stream knows best what one of the stream means."""
    try:
        yield
    except FileError as error:
        raise WriteError([_not_writable(error)]) from None
    except OSError as error:
        if isinstance(target, Path):
            raise WriteError([_not_writable(not_writable(target, error))]) from None
        raise


def _not_writable(error: FileError) -> Finding:
    return Finding("TRC101", Severity.ERROR, error.reason, Location(error.path), error.advice)


# Events that are kept in memory.


class EventRecorder(TraceSink):
    """A sink that keeps all events; it is its own opener."""

    def __init__(self) -> None:
        self._tables: list[EventTable] = []

    def __call__(self, entities: Sequence[Entity]) -> Self:
        """Open it."""
        self._tables = [EventTable.empty(entities)]
        return self

    @property
    def table(self) -> EventTable:
        """The events so far."""
        return concatenate(self._tables)

    def write(self, table: EventTable) -> None:
        """Keep some events."""
        self._tables.append(table)
