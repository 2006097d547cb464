"""The paths that callers give: what each of them names, and which of them belong to one model."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from os import PathLike
from pathlib import Path

from amalthea_uros._internal.files import FileError, is_open_file, is_stream, read_bytes
from amalthea_uros._internal.limits import DESCRIPTION_SIZE, MODEL_SIZE

StrPath = str | PathLike[str]

#: What a text is called in findings that has no file.
TEXT = Path("<text>")

_DESCRIPTION_SUFFIXES = (".yaml", ".yml")

#: The key of a description that says what the file is.
_KEY = re.compile(rb"""^(?:\xef\xbb\xbf)?["']?amuros["']?[ \t]*:""", re.MULTILINE)
#: How models begin: as XML in one of the encodings with a byte order mark or in none of them, or as a ZIP.
_MODEL_STARTS = (b"<", b"\xef\xbb\xbf<", b"\xff\xfe", b"\xfe\xff", b"PK")


def has_description_name(path: StrPath) -> bool:
    """Whether a file to be written is an `app.yaml`."""
    return Path(path).suffix in _DESCRIPTION_SUFFIXES


def is_description(path: StrPath) -> bool:
    """Whether a file is an `app.yaml`, by its name; a pipe or standard input without such a name, by its content."""
    file = Path(path)
    if has_description_name(file) or not is_stream(file):
        return has_description_name(file)
    try:
        return not read_bytes(file, MODEL_SIZE).lstrip().startswith(_MODEL_STARTS)
    except FileError:
        return False


def folder_of(path: Path) -> Path:
    """The folder to which relative paths in a file refer; for an open file such as standard input, the current one."""
    return Path() if is_open_file(path) else path.parent


def is_other_yaml(path: Path) -> bool:
    """Whether a YAML file can be read, but has no key `amuros` at its top level, so that it is of some other program."""
    try:
        return is_description(path) and _KEY.search(read_bytes(path, DESCRIPTION_SIZE)) is None
    except FileError:
        return False


def without_other_yaml(paths: Iterable[Path]) -> Iterator[Path]:
    """The paths without YAML files of other programs."""
    return (path for path in paths if not is_other_yaml(path))


def by_model(paths: Iterable[Path], each: bool = False) -> Iterator[tuple[Path, ...]]:
    """The paths that make one model together: all models, but each description on its own.

    Parameters
    ----------
    each : every path is a model of its own
    """
    models = []
    for path in paths:
        if each or is_description(path):
            yield (path,)
        else:
            models.append(path)
    if models:
        yield tuple(models)
