"""The files on which a result depends, so that a change of one of them is a reason to compute it again."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from amalthea_uros._internal.files import FileError, is_directory, list_directory, read_bytes
from amalthea_uros._internal.limits import DESCRIPTION_SIZE
from amalthea_uros._internal.paths import is_description
from amalthea_uros.xmi.emf.files import is_model_name

#: A platform file that a description names. It is looked for as text, because it shall be found also while the rest is being edited.
_PLATFORM = re.compile(rb"""\bplatform["']?[ \t]*:[ \t]*["']?([^\s"',}#]+\.ya?ml)\b""")


def watched_files(paths: Iterable[Path]) -> frozenset[Path]:
    """The files that paths name: themselves, the models of folders, and the platform files of descriptions."""
    return frozenset(file for path in paths for file in _files(path))


def _files(path: Path) -> Iterable[Path]:
    try:
        if is_directory(path):
            return [file for file in list_directory(path) if is_model_name(file)]
        if is_description(path):
            named = _PLATFORM.findall(read_bytes(path, DESCRIPTION_SIZE))
            return [path, *(path.parent / name.decode(errors="replace") for name in named)]
    except FileError:
        pass  # the command says what is wrong with it
    return [path]
