"""Model -> files."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from pathlib import Path

from amalthea_uros._internal import files
from amalthea_uros._internal.paths import StrPath
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import WriteError
from amalthea_uros.metamodel.model import Document, Model
from amalthea_uros.metamodel.source import FileText
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.xmi.emf.files import SUFFIX, ZIP_ENTRY, not_writable, write_text
from amalthea_uros.xmi.emf.versions import migrated_name
from amalthea_uros.xmi.emf.writer import document_text, usable_source


def save(
    model: Model,
    path: StrPath | None = None,
    *,
    canonical: bool = False,
    compress: bool | None = None,
    version: str | None = None,
) -> None:
    """Write a model.

    Parameters
    ----------
    path : the file, for a model of one document; the directory, for a model of several, whose files keep their names.
        None: where it was read from
    canonical : write everything in EMF's layout; otherwise what was read and not modified is preserved byte for byte
    compress : write a ZIP (like EMF's OPTION_ZIP), or not; None: as it was read
    version : the AMALTHEA version of the model. It has to be given to write a model that was migrated while it was loaded over
        its files; `amuros.migrate` converts a model to another version

    Raises
    ------
    WriteError : values that the AMALTHEA version does not allow (all are listed), a model that was migrated, two documents that
        would become one file, or a file that cannot be written. No file is written unless all of them can be serialised.
    """
    if version is not None:
        _require_version(model, version)
    _save([(document, target, canonical) for document, target in _targets(model, path)], compress, version)


def save_documents(documents: Iterable[Document], canonical: Collection[Document] = ()) -> None:
    """Write some documents of a model to where they were read from.

    Parameters
    ----------
    canonical : those that are written in EMF's layout

    Raises
    ------
    WriteError : as for `save`.
    """
    _save([(document, _own_path(document), document in canonical) for document in documents])


def _save(saved: Iterable[tuple[Document, Path, bool]], compress: bool | None = None, version: str | None = None) -> None:
    prepared = []
    problems: list[Finding] = []
    taken: dict[Path, Document] = {}
    for document, target, canonical in saved:
        other = taken.setdefault(files.resolved(target), document)
        if other is not document:
            problems.append(_not_one_file(other, document, target))
            continue
        if version is None and document.migrated_from is not None and _is_same(target, document.path):
            problems.append(_not_over_the_old_file(document, target))
            continue
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
    zip_entry = source.file.zip_entry if source else None
    if compress is not None:
        zip_entry = (zip_entry or ZIP_ENTRY) if compress else None
    # The canonical header declares UTF-8.
    is_kept = not canonical and source is not None and usable_source(document) is source
    return FileText(text, source.file.encoding if source and is_kept else "utf-8", zip_entry)


def _require_version(model: Model, version: str) -> None:
    """Refuse a version that is not the one of the model."""
    others = dict.fromkeys(document.version for document in model.documents if document.version != version)
    if others:
        message = f"the model has AMALTHEA version {', '.join(others)}, not {version}"
        advice = f"Convert it first: amuros.migrate(model, to={version!r}).save(...)."
        raise WriteError([Finding("XMI104", Severity.ERROR, message, None, advice)])


def _not_one_file(one: Document, other: Document, path: Path) -> Finding:
    message = f"two documents would be written here: {one.path} and {other.path}"
    return Finding("XMI101", Severity.ERROR, message, Location(path), "Give one of them another file name.")


def _is_same(target: Path, path: Path | None) -> bool:
    """Whether two paths lead to the same file, however they are written."""
    return path is not None and files.resolved(target) == files.resolved(path)


def _not_over_the_old_file(document: Document, path: Path) -> Finding:
    message = (
        f"the file has {spelled(document.file_version)}, but the model was migrated to {document.version} when it was loaded"
    )
    advice = (
        f"Save it to another file, or replace this one with save(model, version={document.version!r}); "
        "amuros.migrate() or `amuros migrate` also report what is converted."
    )
    return Finding("XMI104", Severity.ERROR, message, Location(path), advice)


def _targets(model: Model, path: StrPath | None) -> list[tuple[Document, Path]]:
    """Which document goes where."""
    if path is None:
        return [(document, _own_path(document)) for document in model.documents]
    given = Path(path)
    if len(model.documents) == 1 and not files.is_directory(given):
        return [(model.documents[0], given)]
    try:
        given.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        message = f"the model has {len(model.documents)} files, so it is saved to a directory, but this is a file"
        raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(given), "Give a directory.")]) from None
    except (OSError, ValueError) as error:
        raise not_writable(files.not_writable(given, error)) from None
    return [(document, given / _new_name(document)) for document in model.documents]


def _new_name(document: Document) -> str:
    """The name in another folder: that of a sub-model of ITEA becomes one of APP4MC."""
    name = _own_path(document).name
    return name if document.migrated_from is None else migrated_name(name, document.version)


def _own_path(document: Document) -> Path:
    if document.path is None:
        advice = f'Set its path, e.g. document.path = Path("hw{SUFFIX}").'
        raise WriteError([Finding("XMI101", Severity.ERROR, "a new document has no path", None, advice)])
    return document.path
