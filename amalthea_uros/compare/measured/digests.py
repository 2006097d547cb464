"""Digests of traces, by which a measurement is recognised."""

from __future__ import annotations

from hashlib import file_digest, sha256
from pathlib import Path

from amalthea_uros._internal.files import is_directory, is_file
from amalthea_uros.trace.files import trace_files


def digest_of(path: Path) -> str:
    """The SHA-256 of a file, or of all files of a folder, as hexadecimal digits; "" of a stream."""
    if is_directory(path):
        digests = (f"{digest_of(file)}  {file.relative_to(path).as_posix()}\n" for file in trace_files(path))
        return sha256("".join(digests).encode()).hexdigest()
    if not is_file(path):  # a stream that has been read
        return ""
    with path.open("rb") as stream:
        return file_digest(stream, "sha256").hexdigest()
