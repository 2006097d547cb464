"""Files -> model."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from amalthea_uros._internal.files import FileError, is_directory, list_directory
from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros._internal.limits import MODEL_SIZE
from amalthea_uros._internal.one_or_several import one_or_several
from amalthea_uros._internal.paths import StrPath
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.source import FileText
from amalthea_uros.metamodel.versions import newest_version
from amalthea_uros.xmi.emf.files import SUFFIX, is_model_name, not_readable, read_text
from amalthea_uros.xmi.emf.reader import ReadResult, read
from amalthea_uros.xmi.emf.references import resolve
from amalthea_uros.xmi.emf.versions import is_older, version_of


def load(*paths: StrPath | Iterable[StrPath], max_size: int = MODEL_SIZE) -> Model:
    """Read a model.

    Parameters
    ----------
    paths : files (plain or zipped), directories, which stand for all `.amxmi` files in them (and `.amxmi-sw` and the like of
        ITEA versions), or lists of these. Several files form one model, in which every object can refer to every other. Files of
        versions before 0.9.7 are migrated to the newest version in memory, together with those to which they refer by file names
    max_size : largest size of a file, unpacked, in bytes; more than the default also allows more elements in proportion

    Returns
    -------
    Model : its `findings` list what was found while reading: unresolved references, unknown elements, an unknown version,
        a migration and what was lost in it

    Raises
    ------
    ReadError : a file is missing, not a model, of a version that was never published, or refused for safety; carries the
        findings of all files.
    """
    with paused_garbage_collection():
        results, linked, findings = _read(model_files(_flat(paths)), max_size)
        model = Model(result.document for result in results)
        model.findings = (*findings, *resolve(results, linked))
    return model


def _read(paths: Iterable[Path], max_size: int) -> tuple[list[ReadResult], dict[str, Element], list[Finding]]:
    """Read the files, those of older versions as one set that is migrated."""
    results: list[ReadResult] = []
    older: list[tuple[Path, FileText]] = []
    refused: list[Finding] = []
    for path in paths:
        try:
            content = read_text(path, max_size)
            if is_older(version_of(content.utf8)):
                older.append((path, content))
            else:
                results.append(read(path, content))
        except ReadError as error:
            refused += error.findings
    if older:
        from amalthea_uros.xmi.migrate.load import migrate_set
        from amalthea_uros.xmi.migrate.losses import announcements

        try:
            as_they_are = [result.document.path for result in results if result.document.path]
            migrated = migrate_set(older, newest_version(), max_size, elsewhere=as_they_are)
            migrated_results, linked = migrated.read()
        except ReadError as error:
            refused += error.findings
        else:
            if not refused:
                return [*results, *migrated_results], linked, announcements(migrated)
    if refused:
        raise ReadError(refused)
    return results, {}, []


def _flat(paths: Iterable[StrPath | Iterable[StrPath]]) -> Iterator[StrPath]:
    for path in paths:
        yield from one_or_several(path)


def model_files(paths: Iterable[StrPath]) -> list[Path]:
    """The files that some paths stand for: a directory stands for the `.amxmi` files in it.

    Raises
    ------
    ReadError : a directory contains none, or cannot be read.
    """
    found: dict[Path, None] = {}
    for path in map(Path, paths):
        found |= dict.fromkeys(_files_in(path) if is_directory(path) else [path])
    if not found:
        raise TypeError("load() needs at least one path")
    return list(found)


def _files_in(directory: Path) -> list[Path]:
    try:
        found = [file for file in list_directory(directory) if is_model_name(file)]
        if not found:
            raise FileError(directory, f"the directory contains no {SUFFIX} file")
    except FileError as error:
        raise not_readable(error) from None
    return found
