"""The files of traces: their bytes and lines, plain or packed with gzip, the folders of CTF traces, and problems in them."""

from __future__ import annotations

import gzip
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from io import TextIOWrapper
from pathlib import Path
from typing import IO, TextIO, cast

from amalthea_uros._internal.files import is_directory, is_file
from amalthea_uros._internal.limits import TRACE_LINE
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError


@dataclass(frozen=True, slots=True)
class TracePlace:
    """Where in a trace a problem is.

    Attributes
    ----------
    line, column : counted from 1
    text : of the line
    """

    line: int | None = None
    column: int | None = None
    text: str | None = None


#: In a file as a whole.
_NOWHERE = TracePlace()


class UnreadableError(Exception):
    """A part of a trace cannot be read; the text says why.

    Attributes
    ----------
    line : of the file, counted from 1; None if it is not known
    is_cut : whether the data end early
    """

    def __init__(self, message: str, line: int | None = None, *, is_cut: bool = False) -> None:
        super().__init__(message)
        self.line, self.is_cut = line, is_cut


class TraceProblems:
    """The problems of one trace, in the order in which they occur first."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._found: dict[tuple[str, str], tuple[Finding, int]] = {}

    def add(self, rule: str, severity: Severity, message: str, place: TracePlace = _NOWHERE, advice: str = "") -> None:
        """Add a problem, or an occurrence of one; the message says nothing that differs between occurrences."""
        finding, count = self._found.get((rule, message), (None, 0))
        if finding is None:
            location = None if self._path is None else Location(self._path, place.line, place.column, place.text)
            finding = Finding(rule, severity, message, location, advice)
        self._found[rule, message] = finding, count + 1

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The problems so far."""
        return tuple(
            replace(finding, message=f"{finding.message} ({count} times, this is the first)") if count > 1 else finding
            for finding, count in self._found.values()
        )


# Bytes and lines.


#: What a packed file that is damaged raises while it is read.
DAMAGED = (EOFError, gzip.BadGzipFile, zlib.error)
_MAGIC = b"\x1f\x8b"


#: Why a file is not text.
LINE_TOO_LONG = f"a line is longer than {TRACE_LINE:,} characters"


@contextmanager
def opened(path: Path) -> Iterator[IO[bytes]]:
    """The unpacked bytes of a file.

    Raises
    ------
    OSError : it cannot be opened.
    """
    with path.open("rb") as stream:
        if path.name.lower().endswith(".gz") or stream.peek(len(_MAGIC)).startswith(_MAGIC):
            with gzip.open(stream) as unpacked:
                yield cast("IO[bytes]", unpacked)
        else:
            yield stream


# The begin of files, by which their format is recognised.


def first_bytes(path: Path, number: int) -> bytes:
    """The unpacked begin of a file, nothing of one that cannot be read; pipes are left alone, since they can be read only once."""
    if not is_file(path):
        return b""
    try:
        with opened(path) as stream:
            return stream.read(number)
    except (OSError, *DAMAGED):
        return b""


def first_characters(path: Path, number: int) -> str:
    """The begin of a text file, as `first_bytes` gives it."""
    return first_bytes(path, number).decode("utf-8-sig", errors="replace")


@contextmanager
def opened_bytes(path: Path, problems: TraceProblems) -> Iterator[IO[bytes]]:
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
    except UnreadableError as error:
        message = f"{error}; only the events before that are used"
        problems.add("TRC002", Severity.ERROR, message, TracePlace(error.line, 1), "Check that this is a trace.")
    except FileNotFoundError:
        raise _not_readable(path, "file not found", "Check the path.") from None
    except OSError as error:
        raise _not_readable(path, f"the file cannot be read: {error.strerror or error}") from None


@contextmanager
def opened_text(path: Path, problems: TraceProblems) -> Iterator[Iterator[str]]:
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


def _lines(stream: TextIO) -> Iterator[str]:
    """The lines of a stream; a file without line ends, such as a device, would else become one in memory."""
    for number, line in enumerate(iter(partial(stream.readline, TRACE_LINE), ""), 1):
        if len(line) == TRACE_LINE:
            raise UnreadableError(LINE_TOO_LONG, number)
        yield line


def _not_readable(path: Path, reason: str, advice: str = "") -> ReadError:
    return ReadError([Finding("TRC001", Severity.ERROR, reason, Location(path), advice)])


# CTF: each trace is a folder with `metadata` and streams; recorders put several into folders of a session.

METADATA = "metadata"
#: Folders in folders of LTTng: session / ust / uid / 1000 / 64-bit.
_DEPTH = 6
_MOST_FOLDERS = 1000


def has_metadata(path: Path) -> bool:
    """Whether there is a CTF trace in a folder or in folders in it."""
    return next(trace_folders(path), None) is not None


def trace_folders(path: Path) -> Iterator[Path]:
    """The folders of traces in a folder, in the order of their names."""
    pending, seen = [(path, 0)], 0
    while pending and seen < _MOST_FOLDERS:
        folder, depth = pending.pop()
        seen += 1
        if (folder / METADATA).is_file():
            yield folder
            continue
        if depth < _DEPTH:
            inner = (
                each for each in _listed(folder) if each.is_dir() and not each.is_symlink() and not each.name.startswith(".")
            )
            pending += [(each, depth + 1) for each in sorted(inner, reverse=True)]


def stream_files(folder: Path) -> list[Path]:
    """The files of a trace that contain events."""
    return sorted(
        each for each in _listed(folder) if each.is_file() and each.name != METADATA and not each.name.startswith(".")
    )


def trace_files(path: Path) -> Iterator[Path]:
    """All files of the traces in a folder."""
    for folder in trace_folders(path):
        yield from (folder / METADATA, *stream_files(folder))


def _listed(folder: Path) -> list[Path]:
    try:
        return list(folder.iterdir())
    except OSError:
        return []


def digest_of(path: Path) -> str:
    """The SHA-256 of a file, or of all files of a folder, as hexadecimal digits; "" of a stream."""
    from hashlib import file_digest, sha256

    if is_directory(path):
        digests = (f"{digest_of(file)}  {file.relative_to(path).as_posix()}\n" for file in trace_files(path))
        return sha256("".join(digests).encode()).hexdigest()
    if not is_file(path):  # a stream that has been read
        return ""
    with path.open("rb") as stream:
        return file_digest(stream, "sha256").hexdigest()
