"""What is read from paths: an `app.yaml`, or AMALTHEA models."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.paths import StrPath, is_description
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Model
    from amalthea_uros.perf.system import System
    from amalthea_uros.uros.assemble import Assembly


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelInput:
    """The AMALTHEA model of some files.

    Attributes
    ----------
    model : the one that was read, or the one that was built from a description, whose objects know its lines
    findings : problems found while reading or building, also those that comments accept
    system : the one that a description describes, None for AMALTHEA models
    """

    model: Model
    findings: tuple[Finding, ...]
    system: System | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SystemInput:
    """The system of some files.

    Attributes
    ----------
    model : the AMALTHEA model that it was extracted from, None for a description
    findings : problems found while reading, and what could not be extracted, also those that comments accept
    task_periods : those that a description offers to tasks; empty if it offers any, and for AMALTHEA models
    assembly : the decisions that a description left open; None for AMALTHEA models
    """

    system: System
    model: Model | None
    findings: tuple[Finding, ...]
    task_periods: tuple[Time, ...] = ()
    assembly: Assembly | None = None


def as_paths(paths: StrPath | Iterable[StrPath]) -> tuple[Path, ...]:
    """One path or several, as a tuple.

    Raises
    ------
    InvalidArgumentError : there is none.
    """
    found = (Path(paths),) if isinstance(paths, str | PathLike) else tuple(map(Path, paths))
    if not found:
        raise InvalidArgumentError("no path given; expected at least one file or folder")
    return found


def described_input(assembly: Assembly, system: System | None = None) -> SystemInput:
    """The system of a description, or another one that was made of it."""
    return SystemInput(
        system=assembly.system if system is None else system,
        model=None,
        findings=assembly.findings,
        task_periods=assembly.task_periods,
        assembly=assembly,
    )


def open_model(paths: Sequence[StrPath]) -> ModelInput:
    """The AMALTHEA model of files.

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    """
    if _is_one_description(paths):
        from amalthea_uros.services.build import build

        built = build(paths[0])
        return ModelInput(model=built.model, findings=built.assembly.findings, system=built.assembly.system)
    from amalthea_uros.xmi.load import load

    model = load(*paths)
    return ModelInput(model=model, findings=model.findings)


def open_system(paths: Sequence[StrPath], *, with_bus: bool = False) -> SystemInput:
    """The system of an `app.yaml` or of AMALTHEA models.

    Parameters
    ----------
    with_bus : with the CAN bus of the description as a further core, whose tasks are the messages

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : a bus is wanted, but not described.
    """
    if _is_one_description(paths):
        from amalthea_uros.services.build import describe, system_with_bus

        assembly = describe(paths[0])
        system = system_with_bus(assembly, paths[0]) if with_bus else assembly.system
        return described_input(assembly, system)
    if with_bus:
        raise InvalidArgumentError("only an app.yaml describes the messages on a CAN bus; AMALTHEA models do not")
    from amalthea_uros.bridge.extract import extract
    from amalthea_uros.xmi.load import load

    model = load(*paths)
    extraction = extract(model)
    return SystemInput(system=extraction.system, model=model, findings=(*model.findings, *extraction.findings))


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


def _is_one_description(paths: Sequence[StrPath]) -> bool:
    """Whether the only path is a description; several paths are files of one AMALTHEA model."""
    if len(paths) == 1 and is_description(paths[0]):
        return True
    refuse_descriptions(paths)
    return False
