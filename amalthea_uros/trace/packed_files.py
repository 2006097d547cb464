"""Files that may be packed with gzip, by their names or their first bytes: loggers and copies lose suffixes."""

from __future__ import annotations

import gzip
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, cast

#: What a packed file that is damaged raises while it is read.
DAMAGED = (EOFError, gzip.BadGzipFile, zlib.error)
_MAGIC = b"\x1f\x8b"


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
