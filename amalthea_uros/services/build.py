"""From an `app.yaml` to a system and an AMALTHEA model."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros.diagnostics import Finding
from amalthea_uros.services.paths import StrPath
from amalthea_uros.uros.assemble import Assembly, assemble

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Document, Model


@dataclass(frozen=True, slots=True, kw_only=True)
class BuildResult:
    """A model that was built from a description.

    Attributes
    ----------
    description : the file
    assembly : the system of the model, with the decisions and findings of its assembly
    """

    description: Path
    model: Model
    assembly: Assembly

    @property
    def document(self) -> Document:
        """The only document of the model."""
        return self.model.documents[0]

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Warnings and notes about the description."""
        return self.assembly.findings


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


def build(path: StrPath, version: str | None = None, platform: str | None = None) -> BuildResult:
    """The AMALTHEA model of an `app.yaml`.

    Parameters
    ----------
    version : AMALTHEA version from 1.2.0 on; the newest one if none is given
    platform : replaces the platform that the file names

    Raises
    ------
    ReadError : the file cannot be read, or something in it is wrong; carries a finding for each mistake.
    WriteError : the version cannot hold the model.
    """
    from amalthea_uros.bridge.build import build_model

    with paused_garbage_collection():
        assembly = describe(path, platform)
        return BuildResult(description=Path(path), model=build_model(assembly.system, version), assembly=assembly)


def build_file(
    path: StrPath,
    target: StrPath | None = None,
    version: str | None = None,
    platform: str | None = None,
    compress: bool = False,
) -> BuildResult:
    """Build the AMALTHEA model of an `app.yaml` and write it.

    Parameters
    ----------
    target : the file to write; None: beside the description, with the suffix `.amxmi`
    version, platform : as for `build`
    compress : write a ZIP

    Raises
    ------
    ReadError : as for `build`; nothing is written.
    WriteError : the version cannot hold the model, or the file cannot be written.
    """
    from amalthea_uros.xmi.load import SUFFIX
    from amalthea_uros.xmi.save import save

    result = build(path, version, platform)
    result.document.path = Path(path).with_suffix(SUFFIX) if target is None else Path(target)
    save(result.model, compress=compress)
    return result
