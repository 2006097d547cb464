"""From an `app.yaml` to files for the build of the firmware, and a check of files that others wrote."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from amalthea_uros._internal.files import FileError, is_file, read_text
from amalthea_uros._internal.limits import SETTINGS_SIZE
from amalthea_uros._internal.paths import StrPath
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros._internal.shown import Shown
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.perf.named import Brief
from amalthea_uros.services.files import refuse, save_new
from amalthea_uros.services.generated_controller import SOLVED, generated_controller
from amalthea_uros.uros.assemble import Assembly
from amalthea_uros.uros.colcon_meta import parse_meta
from amalthea_uros.uros.generated_files import MARK, CodeWishes, code_findings, generated_memory, generated_storage, texts_of
from amalthea_uros.uros.generated_options import check_meta, with_waiting_messages
from amalthea_uros.uros.memory import MemoryDemand
from amalthea_uros.uros.memory_findings import exceeded_memory

#: Asked again for the sizes in the files.
_MEMORY = "UR129"


@dataclass(frozen=True, slots=True, kw_only=True)
class GenerateResult(Brief, Shown):
    """Files that were generated.

    Attributes
    ----------
    description : the file
    folder : where the files are; None if they were not written
    texts : their contents, by name
    memory : with the options in them
    omissions : about what the description states and the code does not have; none if no code is written
    """

    description: Path
    folder: Path | None
    assembly: Assembly
    texts: Mapping[str, str]
    memory: MemoryDemand
    omissions: tuple[Finding, ...] = ()

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Warnings and notes about the description, except about sizes that the files set, and those that comments in it accept."""
        kept = [finding for finding in self.assembly.findings if finding.rule not in (*SOLVED, _MEMORY)]
        kept += self.omissions
        exceeded = exceeded_memory(self.memory, generated_storage(self.assembly), self.assembly.description.hardware)
        return unsuppressed(kept if exceeded is None else [*kept, exceeded])


@dataclass(frozen=True, slots=True, kw_only=True)
class MetaCheck(Brief, Shown):
    """A `colcon.meta` compared with an application."""

    description: Path
    path: Path
    findings: tuple[Finding, ...]

    @property
    def is_fine(self) -> bool:
        """Whether nothing needs to be changed; values that are larger than necessary do not count."""
        return all(finding.severity is Severity.INFO for finding in self.findings)


def generate(
    path: StrPath,
    folder: StrPath | None = None,
    platform: str | None = None,
    force: bool = False,
    *,
    controller: str | None = None,
    code: bool = False,
    reconnect: bool = False,
    stamps: bool = False,
) -> GenerateResult:
    """The files for the build of an `app.yaml`: `colcon.meta` with the smallest pools that hold, and `amuros_limits.h`.

    Parameters
    ----------
    folder : where they are written; it is created if it does not exist; None: nowhere
    platform : replaces the platform that the file names
    force : replace files that somebody else wrote
    controller : whose files, of a robot with several ones
    code : write the C of entities, executors, loops and threads, too, with definitions of types that are not stated
    reconnect : with `code`, a loop that creates everything anew when the agent comes back
    stamps : with `code`, a CAN frame where each callback starts and ends, and the markers with which `measure` reads them

    Raises
    ------
    ReadError : the description cannot be read, something in it is wrong, or it has no micro-ROS application.
    WriteError : a file cannot be written, or would be replaced.
    """
    assembly, waiting = generated_controller(Path(path), platform, controller)
    if not assembly.description.application.nodes:
        message, advice = "no micro-ROS application: nothing to generate", "Add nodes under 'application'."
        raise ReadError([Finding("GEN009", Severity.ERROR, message, Location(Path(path)), advice)])
    assembly = replace(assembly, options=with_waiting_messages(assembly.options, waiting))
    target = None if folder is None else Path(folder)
    wishes = CodeWishes(reconnects=reconnect, stamps=stamps) if code or reconnect or stamps else None
    texts = texts_of(assembly, wishes)
    result = GenerateResult(
        description=Path(path),
        folder=target,
        assembly=assembly,
        texts=texts,
        memory=generated_memory(assembly),
        omissions=code_findings(assembly, wishes),
    )
    if target is not None:
        files = {target / name: text for name, text in texts.items()}
        if not force:
            foreign = filter(_is_foreign, files)
            refuse(foreign, ", and it is not one that amuros generate wrote", "Use --force to replace it.")
        save_new(files, force=True)
    return result


def check_colcon_meta(path: StrPath, meta: StrPath, platform: str | None = None, *, controller: str | None = None) -> MetaCheck:
    """What is wrong with a `colcon.meta` for an application.

    Parameters
    ----------
    path : the `app.yaml`
    meta : the file to check; comments and trailing commas are allowed
    platform : replaces the platform that the description names
    controller : whose options they are, of a robot with several controllers

    Raises
    ------
    ReadError : one of the files cannot be read.
    """
    assembly, waiting = generated_controller(Path(path), platform, controller)
    file = Path(meta)
    try:
        text = read_text(file, SETTINGS_SIZE)
    except FileError as error:
        raise ReadError([Finding("GEN006", Severity.ERROR, error.reason, Location(file), error.advice)]) from None
    description, file_options = assembly.description, parse_meta(file, text)
    findings = check_meta(description.application, assembly.profile, file_options, assembly.memory, waiting)
    return MetaCheck(description=Path(path), path=file, findings=findings)


def _is_foreign(path: Path) -> bool:
    """Whether somebody else wrote a file."""
    if not is_file(path):
        return path.exists()
    try:
        return MARK not in read_text(path, SETTINGS_SIZE)
    except FileError:
        return True
