"""Files that are written, and what changes in those that are rewritten."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path

from amalthea_uros._internal.files import is_stream
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import WriteError


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


def save_text(path: StrPath, text: str) -> None:
    """Write a file whole or not at all; WriteError if it cannot be written."""
    save_texts({Path(path): text})


def save_texts(texts: Mapping[Path, str]) -> None:
    """Write all files whole, or none; WriteError if one of them cannot be written."""
    from amalthea_uros.metamodel.source import FileText
    from amalthea_uros.xmi.emf.files import write_texts

    write_texts({path: FileText(text) for path, text in texts.items()})


def save_new(texts: Mapping[Path, str], *, force: bool) -> None:
    """Write files as `save_texts`, and the folders that they are in.

    Parameters
    ----------
    force : replace files that exist
    """
    if not force:
        refuse(path for path in texts if not is_stream(path) and path.exists())
    for folder in {path.parent for path in texts if not is_stream(path)}:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except (OSError, ValueError) as error:
            message = f"the folder cannot be created: {getattr(error, 'strerror', None) or error}"
            raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(folder), "Name another folder.")]) from None
    save_texts(texts)


def refuse(paths: Iterable[Path], what: str = "", advice: str = "Use --force to replace it, or name another file.") -> None:
    """Refuse to replace files that exist.

    Parameters
    ----------
    what : the end of the message, why a file is not replaced

    Raises
    ------
    WriteError : there are some.
    """
    found = [Finding("XMI101", Severity.ERROR, f"the file exists already{what}", Location(path), advice) for path in paths]
    if found:
        raise WriteError(found)
