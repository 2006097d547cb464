"""Files of any kind: what a path leads to, and content that is read whole up to a size limit and decoded without loss."""

from __future__ import annotations

import codecs
import io
import os
import stat
import sys
from collections.abc import Iterator, Mapping, MutableMapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from enum import Enum, auto
from functools import cache
from pathlib import Path
from typing import IO

from amalthea_uros._internal.limits import ADVICE, DESCRIPTION_SIZE, MODEL_SIZE

_BYTE_ORDER_MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
#: Codecs that treat a byte order mark as an ordinary character. Without a mark, such text cannot be told from binary data.
_UNMARKED = frozenset({"utf-16-le", "utf-16-be"})
_MARK = "\ufeff"
_BLOCK = 1 << 16

#: What `-` stands for on the command line.
STANDARD_INPUT = Path("/dev/stdin")
STANDARD_OUTPUT = Path("/dev/stdout")
STANDARD_ERROR = Path("/dev/stderr")

#: What these are where there are no such paths.
_STANDARD_DESCRIPTORS = {STANDARD_OUTPUT: 1, STANDARD_ERROR: 2}
_MAX_LINKS = 40

#: Contents that are read instead of those of files.
_OVERLAY: ContextVar[Mapping[Path, bytes]] = ContextVar("overlay", default={})  # noqa: B039 - nobody changes it
#: What has been read by what runs at present, None where each reader reads for itself.
_KEPT: ContextVar[MutableMapping[Path, bytes] | None] = ContextVar("kept", default=None)

#: What a path can be wrong by: a path with a zero byte is a ValueError, one in a circle of links a RuntimeError before Python 3.13.
IMPOSSIBLE = (OSError, ValueError, RuntimeError)


class FileFlaw(Enum):
    """The flaws that a file can have."""

    ACCESS = auto()
    SIZE = auto()
    ENCODING = auto()


class FileError(Exception):
    """A file cannot be read or written.

    Attributes
    ----------
    path : the file
    reason : what is wrong, without a full stop: "file not found"
    advice : what to do about it, "" if the reason says it all
    flaw : whether it, or what is packed in it, is larger than a limit, or its bytes are not text in the expected encoding
    """

    def __init__(self, path: Path, reason: str, advice: str = "", flaw: FileFlaw = FileFlaw.ACCESS) -> None:
        super().__init__(f"{path}: {reason}")
        self.path, self.reason, self.advice, self.flaw = path, reason, advice, flaw


def larger(path: Path, limit: int, what: str = "the file") -> FileError:
    """The error for more than a number of bytes."""
    return FileError(path, f"{what} is larger than {_size_text(limit)}", ADVICE, FileFlaw.SIZE)


def read_bytes(path: Path, max_size: int) -> bytes:
    """The content of a file; of a larger one, or an endless device, no more is read than `max_size`.

    Raises
    ------
    FileError : more than `max_size` bytes, not found, not permitted, or a directory.
    """
    kept = _KEPT.get()
    for contents in (_OVERLAY.get(), kept or {}):
        if path in contents:
            return _limited(contents[path], path, max_size)
    data = _limited(_read(path, max_size), path, max_size)
    # Models are read once; their bytes would take memory beside their text.
    if kept is not None and (max_size <= DESCRIPTION_SIZE or is_stream(path)):
        kept[path] = data
    return data


def _read(path: Path, max_size: int) -> bytes:
    """The content of a file, or more of it than `max_size`."""
    try:
        if path == STANDARD_INPUT:
            return _standard_input()
        if path.is_dir():
            raise FileError(path, "expected a file, found a directory")
        with path.open("rb") as stream:
            # Asked for at once, the limit would be reserved as memory: `stream.read(limit)` makes a buffer of that size.
            size = os.fstat(stream.fileno()).st_size
            return read_up_to(stream, max_size + 1, max(size + 1, _BLOCK))
    except FileNotFoundError:
        raise FileError(path, "file not found", "Check the path.") from None
    except (OSError, ValueError) as error:
        raise FileError(path, f"the file cannot be read: {_cause(error)}") from None


@contextmanager
def reading_once() -> Iterator[None]:
    """Read each description and each pipe once while the block runs, in this thread, and keep the content for further readers.

    A pipe has nothing for a second reader, and all of them see the same text, even if the file is changed or removed meanwhile. What
    is written in the block is read again. A block in another one uses the contents of that one.
    """
    if _KEPT.get() is not None:
        yield
        return
    token = _KEPT.set({})
    try:
        yield
    finally:
        _KEPT.reset(token)


def forget_files() -> None:
    """Read files again from now on, because some were written; a path can lead to any of them."""
    kept = _KEPT.get() or {}
    for path in [each for each in kept if not is_stream(each)]:
        del kept[path]


@contextmanager
def overlaid(contents: Mapping[Path, bytes]) -> Iterator[None]:
    """Let files have other contents than on disk while the block runs, in this thread; they need not exist.

    What is read is what would be read if they were saved: all limits hold.
    """
    token = _OVERLAY.set(contents)
    try:
        yield
    finally:
        _OVERLAY.reset(token)


def _limited(data: bytes, path: Path, max_size: int) -> bytes:
    if len(data) > max_size:
        raise larger(path, max_size)
    return data


@cache
def _standard_input() -> bytes:
    """The content of standard input; it can be read only once, but several readers may ask for it."""
    return read_up_to(sys.stdin.buffer, MODEL_SIZE + 1) if sys.stdin is not None else b""


def read_up_to(stream: IO[bytes], limit: int, block: int = _BLOCK) -> bytes:
    """The content of a stream, at most `limit` bytes of it, in parts of `block` bytes."""
    first = stream.read(min(max(limit, 0), block))
    limit -= len(first)
    found = io.BytesIO(first)  # which gives its content without a copy, and copies this only if more is written
    found.seek(0, io.SEEK_END)
    while limit > 0 and (part := stream.read(min(limit, block))):
        limit -= found.write(part)
    return found.getvalue()


def read_text(path: Path, max_size: int) -> str:
    """The characters of a UTF-8 file, without its byte order mark.

    Raises
    ------
    FileError : not UTF-8, or as for `read_bytes`.
    """
    try:
        return read_bytes(path, max_size).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        reason = f"the file is not UTF-8 (byte {error.start})"
        raise FileError(path, reason, "Save it as UTF-8.", FileFlaw.ENCODING) from None


def is_stream(path: Path) -> bool:
    """Whether a path is a pipe, a device or an open file of this process, which must not become another file."""
    if descriptor_of(path) is not None:
        return True
    try:
        mode = mode_of(path)
    except FileError:  # who writes it reports that
        return False
    return mode is not None and not stat.S_ISREG(mode) and not stat.S_ISDIR(mode)


def descriptor_of(path: Path) -> int | None:
    """The number of the open file that a path such as `/dev/stdout` or `/dev/fd/63` stands for, None for all other paths.

    Where standard output is redirected to a file, `/dev/stdout` leads to that file; to replace it would leave the output in a file
    without a name.
    """
    if path in _STANDARD_DESCRIPTORS:
        return _STANDARD_DESCRIPTORS[path]
    folders = ("/dev/fd", "/proc/self/fd", f"/proc/{os.getpid()}/fd")
    with suppress(*IMPOSSIBLE):
        for _ in range(_MAX_LINKS):
            if path.name.isdecimal() and path.absolute().parent.as_posix() in folders:
                return int(path.name)
            if not path.is_symlink():
                return None
            path = path.parent / path.readlink()
    return None


def is_open_file(path: Path) -> bool:
    """Whether a path stands for an open file of this process: standard input, or what a shell puts in place of `<(command)`."""
    return path == STANDARD_INPUT or descriptor_of(path) is not None


def is_standard_output(path: Path) -> bool:
    """Whether a path leads to the standard output of this process."""
    return descriptor_of(path) == 1


def mode_of(path: Path) -> int | None:
    """Kind and permissions of what is at a path, at the end of symbolic links; None if there is nothing."""
    try:
        return path.stat().st_mode
    except FileNotFoundError:
        return None
    except IMPOSSIBLE as error:
        raise not_writable(path, error) from None


def not_writable(path: Path, error: OSError | ValueError | RuntimeError) -> FileError:
    """The error for a path at which a file or a directory cannot be created."""
    return FileError(path, f"the file cannot be written: {_cause(error)}")


def is_directory(path: Path) -> bool:
    """Whether there is such a directory; False for an impossible path, for which opening it reports the cause."""
    try:
        return path.is_dir()
    except (OSError, ValueError):
        return False


def is_fifo(path: Path) -> bool:
    """Whether there is such a named pipe; False for an impossible path."""
    try:
        return path.is_fifo()
    except (OSError, ValueError):
        return False


def is_file(path: Path) -> bool:
    """Whether there is such a file; False for an impossible path."""
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def resolved(path: Path) -> Path:
    """The path without links; of an impossible one, or one in a circle of links, itself: opening it reports the cause."""
    try:
        return path.resolve()
    except IMPOSSIBLE:
        return path.absolute()


def list_directory(path: Path) -> list[Path]:
    """The files that are directly in a directory, sorted.

    Raises
    ------
    FileError : not permitted, or no directory.
    """
    try:
        return sorted(entry for entry in path.iterdir() if entry.is_file())
    except (OSError, ValueError) as error:
        raise FileError(path, f"the directory cannot be read: {_cause(error)}") from None


def marked_encoding(data: bytes) -> str | None:
    """The codec that the byte order mark of some bytes names, None if they have none."""
    return next((encoding for mark, encoding in _BYTE_ORDER_MARKS if data.startswith(mark)), None)


def decode(data: bytes, encoding: str) -> str:
    """The characters of some bytes, provided that `encode` gives the same bytes again.

    Raises
    ------
    UnicodeError : not text of that encoding.
    LookupError : no such encoding.
    """
    text = data.decode(encoding)
    if encoding in _UNMARKED:
        text = text.removeprefix(_MARK)
    if not encoding.startswith("utf-8"):
        text.encode()  # some encodings allow lone surrogates, which no file format of ours does
        if encode(text, encoding) != data:
            raise UnicodeError("encoding the text again gives other bytes")
    return text


def check_utf8(data: bytes) -> None:
    """Check that bytes are text in UTF-8: in pieces, because memory for the whole text takes longer than the check.

    Raises
    ------
    UnicodeError : they are not.
    """
    decoder, view = codecs.getincrementaldecoder("utf-8")(), memoryview(data)
    try:
        for at in range(0, len(data), _BLOCK):
            decoder.decode(view[at : at + _BLOCK])
        decoder.decode(b"", final=True)
    except UnicodeError:
        data.decode()  # the position in all of them


def encode(text: str, encoding: str, errors: str = "strict") -> bytes:
    """The bytes of a text, with a byte order mark where the codec stands for one; `errors` as for `str.encode`."""
    return (_MARK + text if encoding in _UNMARKED else text).encode(encoding, errors)


def _size_text(size: int) -> str:
    return f"{size // 2**20} MiB" if size >= 2**20 else f"{size:,} bytes"


def _cause(error: OSError | ValueError | RuntimeError) -> str:
    return getattr(error, "strerror", None) or str(error)
