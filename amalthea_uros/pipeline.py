"""From files to systems and models: what several commands need, and scripts too."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from amalthea_uros.diagnostics import Finding
from amalthea_uros.garbage import paused_garbage_collection
from amalthea_uros.metamodel.model import Model
from amalthea_uros.perf.system import System
from amalthea_uros.uros.assemble import Assembly, assemble

StrPath = str | PathLike[str]


@dataclass(frozen=True, slots=True, kw_only=True)
class Built:
    """A model that was built from a description.

    Attributes
    ----------
    assembly : the system behind it, what was decided on the way, and the findings
    """

    model: Model
    assembly: Assembly


def describe(path: StrPath, platform: str | None = None) -> Assembly:
    """The system that an `app.yaml` describes.

    Parameters
    ----------
    platform : replaces the platform that the file names

    Raises
    ------
    ReadError : the file cannot be read, or something in it is wrong; carries a finding for each mistake.
    """
    from amalthea_uros.spec.platforms import whole_hardware
    from amalthea_uros.spec.read import read_description

    file = Path(path)
    description = read_description(file)
    hardware, name = whole_hardware(description.hardware, file.parent, platform)
    return assemble(description, hardware, name)


def system_of(paths: Sequence[StrPath]) -> tuple[System, tuple[Finding, ...]]:
    """The system of an `app.yaml`, or of AMALTHEA models, and what there was to say about the files.

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    """
    if len(paths) == 1 and Path(paths[0]).suffix in (".yaml", ".yml"):
        assembly = describe(paths[0])
        return assembly.system, assembly.findings
    from amalthea_uros.bridge.extract import extract
    from amalthea_uros.xmi.load import load

    model = load(*paths)
    extraction = extract(model)
    return extraction.system, (*model.findings, *extraction.findings)


def build(path: StrPath, version: str | None = None, platform: str | None = None) -> Built:
    """The AMALTHEA model of an `app.yaml`.

    Parameters
    ----------
    version : AMALTHEA version from 1.2.0 on; the newest one if none is given
    platform : replaces the platform that the file names

    Raises
    ------
    ReadError : the file cannot be read, or something in it is wrong; carries a finding for each mistake.
    """
    from amalthea_uros.bridge.build import build_model

    with paused_garbage_collection():
        assembly = describe(path, platform)
        return Built(model=build_model(assembly.system, version), assembly=assembly)
