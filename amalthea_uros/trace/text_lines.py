"""The lines of trace files, plain or packed with gzip."""

from __future__ import annotations

import gzip
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.trace.problems import Problems

_DAMAGED = (EOFError, gzip.BadGzipFile, zlib.error)


@contextmanager
def opened_text(path: Path, problems: Problems) -> Iterator[TextIO]:
    """The text of a file; that the rest of it is damaged is a problem, and what comes before it has been read.

    Raises
    ------
    ReadError : there is no such file, or it may not be read.
    """
    is_packed = path.name.lower().endswith(".gz")
    opening = gzip.open if is_packed else open
    try:
        # Bytes that are not UTF-8 come from names of old files; a wrong character there does no harm to the times.
        with opening(path, "rt", encoding="utf-8-sig", errors="replace", newline="\n") as stream:
            yield stream
    except _DAMAGED as error:
        message = f"the compressed file is damaged: {error}; only the events before that are used"
        problems.add("TRC006", Severity.ERROR, message, advice="Check that it was written completely.")
    except FileNotFoundError:
        raise _not_readable(path, "file not found", "Check the path.") from None
    except OSError as error:
        raise _not_readable(path, f"the file cannot be read: {error.strerror or error}") from None


def _not_readable(path: Path, reason: str, advice: str = "") -> ReadError:
    return ReadError([Finding("TRC001", Severity.ERROR, reason, Location(path), advice)])
