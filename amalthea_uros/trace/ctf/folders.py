"""The files of CTF traces: each trace is a folder with `metadata` and streams; recorders put several into folders of a session."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

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
