"""The bytes and the lines of trace files, plain or packed with gzip."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from io import TextIOWrapper
from pathlib import Path
from typing import IO, TextIO

from amalthea_uros._internal.limits import TRACE_LINE
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.trace.packed_files import DAMAGED, opened
from amalthea_uros.trace.problems import Place, Problems


@contextmanager
def opened_bytes(path: Path, problems: Problems) -> Iterator[IO[bytes]]:
    """The unpacked bytes of a file; that the rest of it is damaged is a problem, and what comes before it has been read.

    Raises
    ------
    ReadError : there is no such file, or it may not be read.
    """
    try:
        with opened(path) as stream:
            yield stream
    except DAMAGED as error:
        message = f"the compressed file is damaged: {error}; only the events before that are used"
        problems.add("TRC006", Severity.ERROR, message, advice="Check that it was written completely.")
    except LineTooLongError as error:
        message = f"a line is longer than {TRACE_LINE:,} characters; only the events before that are used"
        problems.add("TRC002", Severity.ERROR, message, Place(error.line, 1), "Check that this is a trace.")
    except FileNotFoundError:
        raise _not_readable(path, "file not found", "Check the path.") from None
    except OSError as error:
        raise _not_readable(path, f"the file cannot be read: {error.strerror or error}") from None


@contextmanager
def opened_text(path: Path, problems: Problems) -> Iterator[Iterator[str]]:
    """The lines of a file, as `opened_bytes` gives its bytes.

    Raises
    ------
    ReadError : there is no such file, or it may not be read.
    """
    # Bytes that are not UTF-8 come from names of old files; a wrong character there does no harm to the times.
    with (
        opened_bytes(path, problems) as stream,
        TextIOWrapper(stream, encoding="utf-8-sig", errors="replace", newline="\n") as text,
    ):
        yield _lines(text)


class LineTooLongError(Exception):
    """A line has more than `TRACE_LINE` characters: the file is no text.

    Attributes
    ----------
    line : its number
    """

    def __init__(self, line: int) -> None:
        super().__init__(line)
        self.line = line


def _lines(stream: TextIO) -> Iterator[str]:
    """The lines of a stream; a file without line ends, such as a device, would else become one in memory."""
    for number, line in enumerate(iter(partial(stream.readline, TRACE_LINE), ""), 1):
        if len(line) == TRACE_LINE:
            raise LineTooLongError(number)
        yield line


def _not_readable(path: Path, reason: str, advice: str = "") -> ReadError:
    return ReadError([Finding("TRC001", Severity.ERROR, reason, Location(path), advice)])
