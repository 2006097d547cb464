"""Systems as INCHRON projects, and INCHRON projects as systems and AMALTHEA models."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING
from uuid import UUID

from amalthea_uros._internal.files import is_stream
from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.inchron.ids import NAMESPACE
from amalthea_uros.inchron.read import SUFFIX, is_project_name
from amalthea_uros.inchron.write import project_text
from amalthea_uros.perf.named import Brief
from amalthea_uros.services.build_targets import iterations_of
from amalthea_uros.services.files import save_texts
from amalthea_uros.services.subject import SystemInput, open_system

if TYPE_CHECKING:
    from amalthea_uros.inchron.objects import ProjectObject
    from amalthea_uros.inchron_bridge.build import ProjectBuild


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportedModel(Brief):
    """A model in the language of another tool.

    Attributes
    ----------
    paths : the files that it was made of
    target : the file that was written
    text : its content
    findings : problems of reading, what has no place in the other language, and what is written in another form
    """

    paths: tuple[Path, ...]
    target: Path
    text: str
    findings: tuple[Finding, ...]


def export(
    paths: StrPath | Iterable[StrPath],
    target: StrPath,
    ids: UUID = NAMESPACE,
    *,
    mapping: StrPath | None = None,
    with_memories: bool = True,
    like_importer: bool = False,
    write: bool = True,
) -> ExportedModel:
    """Write models, or an `app.yaml`, as an INCHRON project; and a project, if that is given, as an AMALTHEA model.

    Parameters
    ----------
    target : the file to write; its suffix says what it is, `.iprx` or `.amxmi`, and for standard output it is a project
    ids : the namespace of the ids of a project
    mapping : a file to write that says which object of an AMALTHEA model became which of the project
    with_memories : whether a project has memories, and what connects them
    like_importer : whether a project also has the errors of INCHRON's importer, to compare it with one of the importer
    write : whether the files are written

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    WriteError : a reference leads nowhere, or the file cannot be written.
    InvalidArgumentError : the suffix of the target is another one, or there is no AMALTHEA model or no file for a mapping.
    """
    target = Path(target)
    is_model = target.suffix == ".amxmi"
    if target.suffix and not is_model and not is_project_name(target):
        raise InvalidArgumentError(f"{target} is neither an INCHRON project ({SUFFIX}) nor an AMALTHEA model (.amxmi)")
    if is_model and mapping is not None:
        raise InvalidArgumentError(f"{target} is no INCHRON project, and only for a project there is a mapping")
    with paused_garbage_collection():
        opened = open_system(paths)
        findings: tuple[Finding, ...] = ()
        if is_model:
            texts = {target: _model_text(opened)}
        else:
            built = _project(opened, with_memories=with_memories, like_importer=like_importer)
            texts, findings = {target: project_text(built.model, ids)}, built.findings
            if mapping is not None:
                texts[Path(mapping)] = _mapping_text(opened, built.model, ids, target)
    if write:
        save_texts(texts)
    result = unsuppressed((*opened.findings, *findings))
    return ExportedModel(paths=opened.paths, target=target, text=texts[target], findings=result)


def _project(opened: SystemInput, *, with_memories: bool, like_importer: bool) -> ProjectBuild:
    from amalthea_uros.inchron_bridge.amalthea import details_of
    from amalthea_uros.inchron_bridge.build import build_project

    model = opened.model
    details = details_of(model) if model is not None else None
    version = model.documents[0].file_version if model is not None else ""
    return build_project(
        opened.system,
        details,
        iterations_of(opened.system),
        with_memories=with_memories,
        like_importer_of=version if like_importer else None,
    )


def _mapping_text(opened: SystemInput, project: ProjectObject, ids: UUID, target: Path) -> str:
    from amalthea_uros.inchron.mapping import mapping_text

    if opened.model is None or is_stream(target):
        raise InvalidArgumentError("a mapping is between files: it needs an AMALTHEA model, and -o with the project")
    return mapping_text(opened.model, project, ids, target)


def _model_text(opened: SystemInput) -> str:
    from amalthea_uros.bridge.build import build_model
    from amalthea_uros.xmi.emf.writer import document_text

    return document_text(build_model(opened.system).documents[0])
