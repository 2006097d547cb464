"""AMALTHEA models of paths: read from files, or built from an `app.yaml`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.files import reading_once
from amalthea_uros._internal.one_or_several import one_or_several
from amalthea_uros._internal.paths import StrPath, is_description
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError

if TYPE_CHECKING:
    from amalthea_uros.inchron_bridge.extract import ProjectExtraction
    from amalthea_uros.metamodel.model import Model
    from amalthea_uros.perf.system import System


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelInput:
    """The AMALTHEA model of some files.

    Attributes
    ----------
    model : the one that was read, or the one that was built from a description or a project, whose objects know its lines
    findings : problems found while reading or building, also those that comments accept
    system : the one that a description or a project describes, None for AMALTHEA models
    """

    model: Model
    findings: tuple[Finding, ...]
    system: System | None = None


def as_paths(paths: StrPath | Iterable[StrPath]) -> tuple[Path, ...]:
    """One path or several, as a tuple.

    Raises
    ------
    InvalidArgumentError : there is none.
    """
    found = tuple(map(Path, one_or_several(paths)))
    if not found:
        raise InvalidArgumentError("no path given; expected at least one file or folder")
    return found


@reading_once()
def open_model(paths: Sequence[StrPath]) -> ModelInput:
    """The AMALTHEA model of files.

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    """
    if is_one_description(paths):
        from amalthea_uros.services.build import build

        built = build(paths[0])
        return ModelInput(model=built.model, findings=built.assembly.findings, system=built.assembly.system)
    if is_one_project(paths):
        from amalthea_uros.bridge.build import build_model

        project = open_project(Path(paths[0]))
        return ModelInput(model=build_model(project.system), findings=project.findings, system=project.system)
    from amalthea_uros.xmi.load import load

    model = load(*paths)
    return ModelInput(model=model, findings=model.findings)


def refuse_descriptions(paths: Iterable[StrPath]) -> None:
    """Refuse descriptions where only AMALTHEA models can be used.

    Raises
    ------
    InvalidArgumentError : says how to build the model of a description.
    """
    for path in map(Path, paths):
        if is_description(path):
            command = f"amuros build {path} -o {path.with_suffix('.amxmi')}"
            raise InvalidArgumentError(f"{path} is a description, not an AMALTHEA model; build it first: {command}")


def is_one_description(paths: Sequence[StrPath]) -> bool:
    """Whether the only path is a description; several paths are files of one AMALTHEA model, raises as `refuse_descriptions`."""
    if len(paths) == 1 and is_description(paths[0]):
        return True
    refuse_descriptions(paths)
    return False


def is_one_project(paths: Sequence[StrPath]) -> bool:
    """Whether the only path is an INCHRON project.

    Raises
    ------
    InvalidArgumentError : one of several is; a project is always a model of its own.
    """
    projects = [path for path in map(Path, paths) if path.suffix.lower() == ".iprx"]
    if projects and len(paths) > 1:
        raise InvalidArgumentError(f"{projects[0]} is an INCHRON project, which is not a part of another model; give it alone")
    return bool(projects)


def open_project(path: Path) -> ProjectExtraction:
    """The system of an INCHRON project.

    Raises
    ------
    ReadError : the file cannot be read, or is no project.
    """
    from amalthea_uros.inchron.read import read_project
    from amalthea_uros.inchron_bridge.extract import extract_project

    return extract_project(read_project(path))
