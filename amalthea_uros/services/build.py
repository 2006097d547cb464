"""From an `app.yaml` to a system and an AMALTHEA model."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from amalthea_uros._internal.files import STANDARD_OUTPUT, is_file, is_open_file
from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass
from amalthea_uros._internal.shown import Shown
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import AmurosError, InvalidArgumentError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.perf.named import Brief
from amalthea_uros.services.build_targets import BuildTarget, system_for
from amalthea_uros.services.files import refuse
from amalthea_uros.uros.assemble import Assembly

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Document, Model
    from amalthea_uros.perf.system import System


@dataclass(frozen=True, slots=True, kw_only=True)
class BuildResult(Brief, Shown):
    """A model that was built from a description.

    Attributes
    ----------
    description : the file
    assembly : the system of the description, with the decisions and findings of its assembly
    changes : what has another form in the model, for the tool that it is for
    """

    description: Path
    model: Model
    assembly: Assembly
    changes: tuple[Finding, ...] = ()

    @property
    def document(self) -> Document:
        """The only document of the model."""
        return self.model.documents[0]

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Warnings and notes about the description and the model, except those that comments in it accept."""
        return unsuppressed((*self.assembly.findings, *self.changes))


def describe(path: StrPath, platform: str | None = None) -> Assembly:
    """The system that an `app.yaml` describes.

    Parameters
    ----------
    platform : replaces the platform that the file names

    Raises
    ------
    ReadError : the file cannot be read, or something in it is wrong; carries a finding for each mistake.
    """
    from amalthea_uros.uros.described import describe_file

    return describe_file(Path(path), platform).assembly


def system_with_bus(assembly: Assembly, path: StrPath) -> System:
    """The system of a description with its wire.

    Parameters
    ----------
    path : of the description

    Raises
    ------
    InvalidArgumentError : no wire is described.
    """
    system = assembly.system_with_bus()
    if system is None:
        raise InvalidArgumentError(f"no CAN bus is described in {path}; set 'middleware.transport.can.bitrate'")
    return system


def build(
    path: StrPath,
    version: str | None = None,
    platform: str | None = None,
    *,
    with_bus: bool = False,
    tool: BuildTarget | None = None,
) -> BuildResult:
    """The AMALTHEA model of an `app.yaml`.

    Parameters
    ----------
    version : AMALTHEA version from 1.2.0 on; the newest one if none is given
    platform : replaces the platform that the file names
    with_bus : also with the CAN bus, if it is not a part of the system anyway
    tool : a tool for which the model is written in a form that it converts

    Raises
    ------
    ReadError : the file cannot be read, or something in it is wrong; carries a finding for each mistake.
    WriteError : the version cannot hold the model.
    InvalidArgumentError : a bus is wanted, but not described.
    """
    from amalthea_uros.bridge.build import build_model

    with paused_garbage_collection():
        assembly = describe(path, platform)
        system = system_with_bus(assembly, path) if with_bus else assembly.system
        system, changes = system_for(tool, system, version)
        return BuildResult(description=Path(path), model=build_model(system, version), assembly=assembly, changes=changes)


def build_file(
    path: StrPath,
    target: StrPath | None = None,
    version: str | None = None,
    platform: str | None = None,
    compress: bool = False,
    force: bool = False,
    *,
    with_bus: bool = False,
    tool: BuildTarget | None = None,
) -> BuildResult:
    """Build the AMALTHEA model of an `app.yaml` and write it.

    Parameters
    ----------
    target : the file to write; None: beside the description, with the suffix `.amxmi`, or standard output for standard input
    version, platform, with_bus, tool : as for `build`
    compress : write a ZIP
    force : without a target, also replace a model that this function would not write

    Raises
    ------
    ReadError : as for `build`; nothing is written.
    WriteError : the version cannot hold the model, or the file cannot be written, or would be replaced.
    """
    from amalthea_uros.xmi.save import save

    result = build(path, version, platform, with_bus=with_bus, tool=tool)
    result.document.path = _beside(Path(path), force) if target is None else Path(target)
    save(result.model, compress=compress)
    return result


def _beside(description: Path, force: bool) -> Path:
    """The file for the model of a description, unless somebody else made it.

    Raises
    ------
    WriteError : it has content that `build` would not write.
    """
    from amalthea_uros.xmi.emf.files import SUFFIX

    if is_open_file(description):
        return STANDARD_OUTPUT
    path = description.with_suffix(SUFFIX)
    if not force and is_file(path) and not _is_built(path):
        advice = "Use --force to replace it, or write another file with -o."
        refuse([path], ", and it is not a model that `amuros build` wrote", advice)
    return path


def _is_built(path: Path) -> bool:
    """Whether a file has exactly the text that is built from the system in it; a model that others made or edited has more."""
    from amalthea_uros.bridge.build import build_model
    from amalthea_uros.bridge.extract import extract
    from amalthea_uros.xmi.emf.writer import document_text
    from amalthea_uros.xmi.load import load

    try:
        (document,) = load(path).documents
        built = build_model(extract(document.model).system, document.version)
        return document.source is not None and document_text(built.documents[0]) == document.source.text
    except (AmurosError, ValueError):
        return False
