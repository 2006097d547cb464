"""Models in canonical form, as APP4MC writes them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from amalthea_uros._internal.files import STANDARD_OUTPUT, is_stream
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError, WriteError
from amalthea_uros.metamodel.versions import spelled
from amalthea_uros.services.files import FileChange
from amalthea_uros.services.inputs import as_paths, refuse_descriptions
from amalthea_uros.xmi.emf.writer import document_text
from amalthea_uros.xmi.load import load, model_files
from amalthea_uros.xmi.save import save


@dataclass(frozen=True, slots=True, kw_only=True)
class FormatResult:
    """The files that were not in canonical form.

    Attributes
    ----------
    is_written : whether they are now
    findings : why a file could not be read or written
    """

    changed: tuple[FileChange, ...]
    is_written: bool
    findings: tuple[Finding, ...]


def format_files(paths: StrPath | Iterable[StrPath], write: bool = True) -> FormatResult:
    """Rewrite models in canonical form; files that are in it already are not touched. Standard input goes to standard output.

    Parameters
    ----------
    write : False: only find out which files would change

    Raises
    ------
    ReadError : a folder has no models.
    InvalidArgumentError : a file is a description.
    """
    files = as_paths(paths)
    refuse_descriptions(files)
    changed: list[FileChange] = []
    findings: list[Finding] = []
    for path in model_files(files):
        try:
            changed += _format(path, write)
        except (ReadError, WriteError) as error:
            findings += error.findings
    return FormatResult(changed=tuple(changed), is_written=write, findings=tuple(findings))


def _format(path: Path, write: bool) -> Iterable[FileChange]:
    model = load(path)
    document = model.documents[0]
    if document.migrated_from is not None:
        message = f"a model of {spelled(document.migrated_from)} has no canonical form"
        raise WriteError(
            [Finding("XMI104", Severity.ERROR, message, Location(path), f"Migrate it first: amuros migrate {path}")]
        )
    source = document.source
    assert source is not None
    # The canonical form is UTF-8 without a byte order mark, as EMF writes it.
    before = "\ufeff" + source.text if source.file.encoding == "utf-8-sig" else source.text
    after = document_text(document, canonical=True)
    is_filter = is_stream(path)
    if write and (after != before or is_filter):
        save(model, STANDARD_OUTPUT if is_filter else None, canonical=True)
    if after == before:
        return ()
    return (FileChange(path, before, after),)
