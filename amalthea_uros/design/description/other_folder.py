"""A description that is written to another folder: what it names relative to its own folder stays the same files."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

from amalthea_uros._internal.files import is_stream
from amalthea_uros._internal.paths import folder_of
from amalthea_uros.design.description.text_edits import rendered
from amalthea_uros.design.description.text_nodes import AnyNode, TextMapping, TextScalar, TextSequence, read_document

#: Keys whose value is the name of a file.
_FILES = frozenset({"file", "dbc"})
#: Keys whose value is a file of the user if it ends so, and else a name that amuros knows.
_NAMES = frozenset({"hardware", "platform", "os", "rtos", "profile"})
_SUFFIXES = (".yaml", ".yml")


def moved(text: str, path: Path, target: Path) -> str:
    """The text of a description for another place.

    Parameters
    ----------
    path : of the description, to whose folder the names of files are relative
    target : where it is written; the text stays as it is for a stream, which has no folder
    """
    if is_stream(target):
        return text
    # Two dots after a symbolic link lead to the parent of what it refers to.
    folder, other = folder_of(path).resolve(), folder_of(target).resolve()
    if folder == other:
        return text
    for scalar in sorted(_file_names(read_document(text).root), key=lambda each: each.start, reverse=True):
        if not Path(scalar.value).is_absolute() and (folder / scalar.value).is_file():
            anchor = f"&{scalar.anchor} " if scalar.anchor else ""
            name = rendered(_relative(folder / scalar.value, other), scalar.quote)
            text = text[: scalar.start] + anchor + name + text[scalar.end :]
    return text


def _file_names(node: AnyNode) -> Iterator[TextScalar]:
    """The values that name files."""
    if isinstance(node, TextSequence):
        for item in node.items:
            yield from _file_names(item)
    elif isinstance(node, TextMapping):
        for entry in node.entries:
            value = entry.value
            if not isinstance(value, TextScalar):
                yield from _file_names(value)
            elif entry.key in _FILES or (entry.key in _NAMES and value.value.endswith(_SUFFIXES)):
                yield value


def _relative(path: Path, folder: Path) -> str:
    """The name of a file for a description in a folder; the whole path if they are on different drives."""
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:
        return path.as_posix()
