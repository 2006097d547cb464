"""The begin of files, by which their format is recognised."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros._internal.files import is_file
from amalthea_uros.trace.packed_files import DAMAGED, opened


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
