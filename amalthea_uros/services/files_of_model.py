"""The files that belong to the model of a file."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from amalthea_uros._internal.files import FileError, list_directory
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.element import references_of

#: In bytes. To read larger files of a folder takes too long to be repeated while somebody types.
MAX_SIZE_OF_OTHERS = 4 * 2**20


def files_of_model(path: Path) -> tuple[Path, ...]:
    """A model file alone, or with the others of its folder, as `check FOLDER` takes them, if references connect it with them."""
    others = _other_models(path)
    try:
        if not others or sum(other.stat().st_size for other in others) > MAX_SIZE_OF_OTHERS:
            return (path,)
        alone, rest = _unresolved([path]), _unresolved(others)
        together = _unresolved([path, *others])
    except (OSError, ReadError):
        return (path,)
    return tuple(sorted([path, *others])) if together < alone + rest else (path,)


def _other_models(path: Path) -> list[Path]:
    from amalthea_uros.xmi.emf.files import is_model_name

    try:
        return [other for other in list_directory(path.parent) if other != path and is_model_name(other)]
    except FileError:
        return []


def _unresolved(paths: Iterable[Path]) -> int:
    """The number of references to what the files do not define."""
    from amalthea_uros.xmi.load import load

    return sum(
        target.unresolved is not None
        for document in load(*paths).documents
        for holder in document.root.walk()
        for _, value in references_of(holder)
        for target in (value if isinstance(value, list) else (value,))
    )
