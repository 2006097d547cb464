"""Files before and after a change of their text."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class FileChange:
    """A file of which the text changes."""

    path: Path
    before: str
    after: str


@dataclass(frozen=True, slots=True)
class FilesDiff:
    """What changes in files, line by line.

    Attributes
    ----------
    label : what the files are after the change
    """

    files: tuple[FileChange, ...]
    label: str
