"""Opening the log of a CAN bus in any known format."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import cast

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.can.frames import CanLog

#: The modules that read a format, and their classes, by the ends of the names of files.
_READERS = {
    ".log": ("candump", "CandumpLog"),
    ".asc": ("asc", "AscLog"),
    ".blf": ("blf", "BlfLog"),
    ".trc": ("trc", "TrcLog"),
    ".mf4": ("mf4", "Mf4Log"),
}
#: The ends of the names of files. `.gz` may follow them, apart from .mf4.
SUFFIXES = tuple(_READERS)
_NEVER_PACKED = ".mf4"


def is_can_log(path: Path) -> bool:
    """Whether the name of a file is one of a log of a CAN bus."""
    return _suffix(path) is not None


def open_can_log(path: Path, *, channel: str | None = None) -> CanLog:
    """The frames of a log, by the end of the name of its file.

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
            f"the format of the log {path.name!r} is not known; the name of the file must end in one of {', '.join(SUFFIXES)}, "
            f"and, apart from {_NEVER_PACKED}, may be followed by .gz, e.g. run.log.gz"
        )
    module, name = _READERS[suffix]
    reader = getattr(import_module(f"amalthea_uros.trace.can.{module}"), name)
    return cast("Callable[[Path, str | None], CanLog]", reader)(path, channel)


def _suffix(path: Path) -> str | None:
    name = path.name.lower()
    plain = name.removesuffix(".gz")
    return next((end for end in SUFFIXES if (name if end == _NEVER_PACKED else plain).endswith(end)), None)
