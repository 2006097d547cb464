"""Model -> files."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from pathlib import Path

from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import WriteError
from amalthea_uros.metamodel.model import Document, Model
from amalthea_uros.xmi.files import ZIP_ENTRY, FileText, is_folder, not_writable, write_text
from amalthea_uros.xmi.load import SUFFIX, StrPath
from amalthea_uros.xmi.writer import document_text


def save(model: Model, path: StrPath | None = None, *, canonical: bool = False, compress: bool | None = None) -> None:
    """Write a model.

    Parameters
    ----------
    path : the file for a model of one document; the folder for one of several, which keep their names. None: where it was
        read from
    canonical : lay everything out as EMF does; otherwise what was read and not changed is written to the letter
    compress : as a ZIP (as EMF's OPTION_ZIP), or not; None: as it was read

    Raises
    ------
    WriteError : values that the AMALTHEA version does not allow (all of them are named), or a file that cannot be written.
        Either all files are prepared without error or none is touched.
    """
    _save([(document, target, canonical) for document, target in _targets(model, path)], compress)


def save_documents(documents: Iterable[Document], canonical: Collection[Document] = ()) -> None:
    """Write some documents of a model to where they were read from.

    Parameters
    ----------
    canonical : those of them that are laid out as EMF does

    Raises
    ------
    WriteError : as for `save`.
    """
    _save([(document, _own_path(document), document in canonical) for document in documents], compress=None)


def _save(files: Iterable[tuple[Document, Path, bool]], compress: bool | None) -> None:
    prepared = []
    problems: list[Finding] = []
    for document, target, canonical in files:
        try:
            prepared.append((target, _file_text(document, canonical, compress)))
        except WriteError as error:
            problems += error.findings
    if problems:
        raise WriteError(problems)
    for target, content in prepared:
        write_text(target, content)


def _file_text(document: Document, canonical: bool, compress: bool | None) -> FileText:
    source = document.source
    text = document_text(document, canonical)
    zip_entry = source.zip_entry if source else None
    if compress is not None:
        zip_entry = (zip_entry or ZIP_ENTRY) if compress else None
    # The canonical header declares UTF-8.
    return FileText(text, source.encoding if source and not canonical else "utf-8", zip_entry)


def _targets(model: Model, path: StrPath | None) -> list[tuple[Document, Path]]:
    """Which document goes where."""
    if path is None:
        return [(document, _own_path(document)) for document in model.documents]
    given = Path(path)
    if len(model.documents) == 1 and not is_folder(given):
        return [(model.documents[0], given)]
    try:
        given.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        message = f"the model has {len(model.documents)} files, but this is one file and no folder"
        raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(given), "Name a folder.")]) from None
    except (OSError, ValueError) as error:
        raise not_writable(given, error) from None
    return [(document, given / _own_path(document).name) for document in model.documents]


def _own_path(document: Document) -> Path:
    if document.path is None:
        message = "a new document has no path yet"
        raise WriteError([Finding("XMI101", Severity.ERROR, message, None, f"Set document.path, such as hw{SUFFIX}.")])
    return document.path
