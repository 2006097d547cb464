"""Systems as INCHRON projects, and INCHRON projects as systems and AMALTHEA models."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from uuid import UUID, uuid5

from amalthea_uros._internal.files import STANDARD_INPUT, FileError, read_bytes
from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros._internal.limits import MODEL_SIZE
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.inchron.ids import NAMESPACE
from amalthea_uros.inchron.read import SUFFIX, is_project_name
from amalthea_uros.inchron.write import project_text
from amalthea_uros.perf.named import Brief
from amalthea_uros.perf.system import System
from amalthea_uros.services.files import save_text
from amalthea_uros.services.subject import SystemInput, open_system
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportResult(Brief):
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


def export(paths: StrPath | Iterable[StrPath], target: StrPath, ids: UUID = NAMESPACE, *, write: bool = True) -> ExportResult:
    """Write models, or an `app.yaml`, as an INCHRON project; and a project, if that is given, as an AMALTHEA model.

    Parameters
    ----------
    target : the file to write; its suffix says what it is, `.iprx` or `.amxmi`, and for standard output it is a project
    ids : the namespace of the ids of a project
    write : whether the file is written

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    WriteError : a reference leads nowhere, or the file cannot be written.
    InvalidArgumentError : the suffix of the target is another one.
    """
    target = Path(target)
    is_model = target.suffix == ".amxmi"
    if target.suffix and not is_model and not is_project_name(target):
        raise InvalidArgumentError(f"{target} is neither an INCHRON project ({SUFFIX}) nor an AMALTHEA model (.amxmi)")
    with paused_garbage_collection():
        opened = open_system(paths)
        findings: tuple[Finding, ...] = ()
        if is_model:
            text = _model_text(opened)
        else:
            text, findings = _project_text(opened, ids)
    if write:
        save_text(target, text)
    result = unsuppressed((*opened.findings, *findings))
    return ExportResult(paths=opened.paths, target=target, text=text, findings=result)


def _project_text(opened: SystemInput, ids: UUID) -> tuple[str, tuple[Finding, ...]]:
    from amalthea_uros.inchron_bridge.amalthea import details_of
    from amalthea_uros.inchron_bridge.build import build_project

    details = details_of(opened.model) if opened.model is not None else None
    built = build_project(opened.system, details, iterations_of(opened.system))
    return project_text(built.model, ids), built.findings


def iterations_of(system: System) -> dict[str, tuple[Time, Time]]:
    """The shortest and the longest time between two iterations of executors, by the stimuli that stand for them, where it is bounded.

    These are what the analysis proves; where it proves none, nothing is in the result.
    """
    if not system.executors:
        return {}
    from amalthea_uros.analyze.system import analyze_system

    result: dict[str, tuple[Time, Time]] = {}
    for executor in analyze_system(system).executors:
        least, most = executor.loop.least, executor.loop.most
        if most is not None and least < most:
            result |= dict.fromkeys(system.processes[executor.task].stimuli, (least, most))
    return result


def _model_text(opened: SystemInput) -> str:
    from amalthea_uros.bridge.build import build_model
    from amalthea_uros.xmi.emf.writer import document_text

    return document_text(build_model(opened.system).documents[0])


def hashed(paths: Sequence[Path]) -> UUID:
    """The namespace of ids that depends on the content of files.

    Raises
    ------
    InvalidArgumentError : a file cannot be read.
    """
    result = NAMESPACE
    for path in paths:
        try:
            content = b"" if path == STANDARD_INPUT else read_bytes(path, MODEL_SIZE)
        except FileError as error:
            raise InvalidArgumentError(f"{path} cannot be read: {error.reason}") from None
        result = uuid5(result, content.hex())
    return result


def valued(text: str) -> UUID:
    """The namespace of ids that depends on a text."""
    return uuid5(NAMESPACE, text)
