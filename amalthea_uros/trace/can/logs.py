"""Opening the log of a CAN bus in any known format."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.trace.can.candump import CandumpLog
from amalthea_uros.trace.can.frames import CanLog

#: The ends of the names of files. `.gz` may follow those of text.
SUFFIXES = (".log",)


def is_can_log(path: Path) -> bool:
    """Whether the name of a file is one of a log of a CAN bus."""
    return path.name.lower().removesuffix(".gz").endswith(SUFFIXES)


def open_can_log(path: Path, *, channel: str | None = None) -> CanLog:
    """The frames of a log, by the end of the name of its file.

    Parameters
    ----------
    channel : give only the frames of this one; by default those of all

    Raises
    ------
    InvalidArgumentError : no reader is known for it.
    ReadError : when frames are read, if the file cannot be.
    """
    if is_can_log(path):
        return CandumpLog(path, channel)
    raise InvalidArgumentError(
        f"the format of the log {path.name!r} is not known; the name of the file must end in one of {', '.join(SUFFIXES)}, "
        "and those of text may be followed by .gz, e.g. run.log.gz"
    )
