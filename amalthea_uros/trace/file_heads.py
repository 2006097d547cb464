"""The begin of text files, by which their format is recognised."""

from __future__ import annotations

import gzip
import zlib
from pathlib import Path


def first_characters(path: Path, number: int) -> str:
    """The begin of a file, nothing of one that cannot be read; pipes are left alone, since they can be read only once."""
    if not path.is_file():
        return ""
    opening = gzip.open if path.name.lower().endswith(".gz") else open
    try:
        with opening(path, "rt", encoding="utf-8-sig", errors="replace") as stream:
            return stream.read(number)
    except (OSError, EOFError, zlib.error):
        return ""
