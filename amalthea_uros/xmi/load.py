"""The library's doors: files -> model -> files."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path

from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.model import Model
from amalthea_uros.xmi.files import MAX_SIZE, is_folder, not_readable, read_text
from amalthea_uros.xmi.reader import ReadResult, read
from amalthea_uros.xmi.references import resolve

SUFFIX = ".amxmi"

StrPath = str | os.PathLike[str]


def load(*paths: StrPath | Iterable[StrPath], max_size: int = MAX_SIZE) -> Model:
    """Read a model.

    Parameters
    ----------
    paths : files (plain or zipped), folders, which stand for all `.amxmi` files in them, or lists of such. Several files make
        one model, in which every object can refer to every other
    max_size : bytes, unpacked, beyond which a file is refused

    Returns
    -------
    Model : its `findings` tell what was odd: dangling references, unknown elements, an unknown version

    Raises
    ------
    ReadError : a file is missing, not a model, too old or refused for safety; carries all findings.
    """
    results: list[ReadResult] = []
    refused: list[Finding] = []
    with paused_garbage_collection():
        for path in model_files(_flat(paths)):
            try:
                results.append(read(path, read_text(path, max_size)))
            except ReadError as error:
                refused += error.findings
        if refused:
            raise ReadError(refused)
        model = Model(result.document for result in results)
        model.findings = tuple(resolve(results))
    return model


def _flat(paths: Iterable[StrPath | Iterable[StrPath]]) -> Iterator[StrPath]:
    for path in paths:
        if isinstance(path, str | os.PathLike):
            yield path
        else:
            yield from path


def model_files(paths: Iterable[StrPath]) -> list[Path]:
    """The files behind paths: a folder stands for the `.amxmi` files in it.

    Raises
    ------
    ReadError : a folder has none.
    """
    found: dict[Path, None] = {}
    for path in map(Path, paths):
        if is_folder(path):
            try:
                inside = sorted(entry for entry in path.iterdir() if entry.suffix == SUFFIX and entry.is_file())
            except OSError as error:
                raise not_readable(path, error) from None
            if not inside:
                raise ReadError(
                    [Finding("XMI001", Severity.ERROR, f"there is no {SUFFIX} file in this folder", Location(path))]
                )
            found |= dict.fromkeys(inside)
        else:
            found[path] = None
    if not found:
        raise TypeError("load() needs at least one path")
    return list(found)
