"""Opening the log of a CAN bus in any known format."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import cast

from amalthea_uros._internal.files import STANDARD_INPUT, is_fifo
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.can.candump_lines import is_frame
from amalthea_uros.trace.can.frames import CanLog
from amalthea_uros.trace.files import first_bytes
from amalthea_uros.trace.readers import format_of

#: The modules that read a format, and their classes, by the ends of the names of files.
_READERS = {
    ".log": ("candump", "CandumpLog"),
    ".asc": ("text_logs", "AscLog"),
    ".blf": ("blf", "BlfLog"),
    ".trc": ("text_logs", "TrcLog"),
    ".mf4": ("mf4", "Mf4Log"),
}
#: The ends of the names of files. `.gz` may follow them, apart from .mf4.
SUFFIXES = tuple(_READERS)
_NEVER_PACKED = ".mf4"
#: The first bytes of formats that are recognised by them.
_BEGINS = {".blf": b"LOGG", ".mf4": b"MDF     4", ".trc": b";$FILEVERSION"}
#: So many bytes and lines are looked at, of which the first may be damaged.
_HEAD, _LINES = 1 << 14, 50
#: What comes from standard input or another pipe: candump writes to it.
_PIPED = ".log"


def is_can_log(path: Path) -> bool:
    """Whether a file is a log of a CAN bus, by its first bytes, or by its name if they say nothing."""
    return _suffix(path) is not None


def open_can_log(path: Path, *, channel: str | None = None) -> CanLog:
    """The frames of a log, by the first bytes or the end of the name of its file.

    Parameters
    ----------
    channel : give only the frames of this one; by default those of all

    Raises
    ------
    InvalidArgumentError : no reader is known for it; when frames are read, if it needs a package that is not installed.
    ReadError : when frames are read, if the file cannot be.
    """
    suffix = _suffix(path)
    if suffix is None:
        raise InvalidArgumentError(
            f"the format of the log {path.name!r} is not known; its first lines are not those of candump, and its name does not end in "
            f"one of {', '.join(SUFFIXES)}, which, apart from {_NEVER_PACKED}, may be followed by .gz, e.g. run.log.gz"
        )
    module, name = _READERS[suffix]
    reader = getattr(import_module(f"amalthea_uros.trace.can.{module}"), name)
    return cast("Callable[[Path, str | None], CanLog]", reader)(path, channel)


def _suffix(path: Path) -> str | None:
    if path == STANDARD_INPUT or is_fifo(path):
        return _PIPED
    return _recognised(first_bytes(path, _HEAD)) or _named(path)


def _named(path: Path) -> str | None:
    name = path.name.lower()
    plain = name.removesuffix(".gz")
    found = next((end for end in SUFFIXES if (name if end == _NEVER_PACKED else plain).endswith(end)), None)
    # Logs of operating systems have the same name.
    return None if found == _PIPED and format_of(path) is not None else found


def _recognised(head: bytes) -> str | None:
    """The usual end of the name of a file with this begin."""
    for end, begin in _BEGINS.items():
        if head.startswith(begin):
            return end
    lines = head.decode("utf-8-sig", errors="replace").splitlines()[:_LINES]
    return _PIPED if any(map(is_frame, lines)) else None
