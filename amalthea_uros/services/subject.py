"""What callers give: files, a text, the content of a description, a model, or a system; and its system, with changes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from amalthea_uros._internal.files import reading_once
from amalthea_uros._internal.paths import TEXT, StrPath
from amalthea_uros._internal.records import dataclass
from amalthea_uros.diagnostics import Finding
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.perf.system import System
from amalthea_uros.services.inputs import as_paths, is_one_description, is_one_project, open_project
from amalthea_uros.timing.activation.releases import sources
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.metamodel.model import Model
    from amalthea_uros.uros.assemble import Assembly

Subject: TypeAlias = "StrPath | Iterable[StrPath] | Mapping[str, Any] | Model | System"

_ACCEPTED = (
    "the path of an app.yaml or of an .amxmi or .iprx file, a list of paths, the text of an app.yaml, its content as a dict, a Model, "
    "or a System such as taskset() makes"
)
_NO_BUS = "only an app.yaml describes the messages on a CAN bus"


@dataclass(frozen=True, slots=True, kw_only=True)
class SystemInput:
    """The system of a subject.

    Attributes
    ----------
    subject : what it was opened from, and can be opened from again
    paths : the files; none for what is in memory
    model : the AMALTHEA model that the system was extracted from, None for descriptions and systems
    findings : problems found while reading, and what could not be extracted, also those that comments accept
    assembly : the decisions that a description left open; None for AMALTHEA models and systems
    """

    subject: Subject
    paths: tuple[Path, ...] = ()
    system: System
    model: Model | None = None
    findings: tuple[Finding, ...] = ()
    assembly: Assembly | None = None

    @property
    def task_periods(self) -> tuple[Time, ...]:
        """Those that a description offers to tasks; empty if it offers any, and for AMALTHEA models."""
        return () if self.assembly is None else self.assembly.task_periods


@reading_once()
def open_system(subject: Subject, *, with_bus: bool = False) -> SystemInput:
    """The system of files, of a description as text or dict, of an AMALTHEA model, or the given one, with the findings about it.

    A text with a line break is the content of an `app.yaml`; any other text is a path.

    Parameters
    ----------
    with_bus : with the CAN bus of the description as a further core, whose tasks are the messages

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : a bus is wanted, but not described.
    TypeError : the subject is something else; the text lists what is accepted.
    """
    if isinstance(subject, System):
        if with_bus:
            raise InvalidArgumentError(_NO_BUS)
        return SystemInput(subject=subject, system=subject)
    if isinstance(subject, Mapping) or (isinstance(subject, str) and "\n" in subject):
        from amalthea_uros.uros.described import describe_content, describe_text

        describe_text.cache_clear()  # files that the text names, such as that of a platform, can have changed
        described_subject = describe_text(subject, TEXT) if isinstance(subject, str) else describe_content(subject)
        return _described(subject, (), described_subject.assembly, with_bus)
    model = as_model(subject)
    paths = as_paths(_paths(subject)) if model is None else ()
    if model is None and is_one_description(paths):
        from amalthea_uros.services.build import describe

        return _described(paths, paths, describe(paths[0]), with_bus)
    if with_bus:
        raise InvalidArgumentError(f"{_NO_BUS}; models do not")
    if model is None and is_one_project(paths):
        project = open_project(paths[0])
        return SystemInput(subject=paths, paths=paths, system=project.system, findings=project.findings)
    from amalthea_uros.bridge.extract import extract

    if model is None:
        from amalthea_uros.xmi.load import load

        model = load(*paths)
    found = extract(model)
    findings = (*model.findings, *found.findings)
    return SystemInput(subject=paths or subject, paths=paths, system=found.system, model=model, findings=findings)


def as_model(subject: object) -> Model | None:
    """The subject if it is an AMALTHEA model; of paths that is known without the AMALTHEA classes."""
    if isinstance(subject, str | PathLike | System | Mapping | list | tuple):
        return None
    from amalthea_uros.metamodel.model import Model

    return subject if isinstance(subject, Model) else None


def require_settings(settings: Settings, system: System) -> None:
    """Refuse settings for what a system does not have; raises as `require`, and TypeError for what is no `Settings`."""
    if not isinstance(settings, Settings):
        raise TypeError(f"expected Settings, not {type(settings).__name__}; changes of values are given as changes=...")
    require("core", settings.frequencies, system.cores)
    if settings.frequencies:
        from amalthea_uros.design.changes.kinds import refuse_wire

        for core in settings.frequencies:
            refuse_wire(core, system)
    require("process", settings.factors, system.processes)
    if settings.phases:
        require("callback with a phase", settings.phases, sources(system))
    require("mode label", settings.modes, [label.name for label in system.software.mode_labels])


def _described(subject: Subject, paths: tuple[Path, ...], assembly: Assembly, with_bus: bool) -> SystemInput:
    from amalthea_uros.services.build import system_with_bus

    system = system_with_bus(assembly, paths[0] if paths else TEXT) if with_bus else assembly.system
    return SystemInput(subject=subject, paths=paths, system=system, findings=assembly.findings, assembly=assembly)


def _paths(subject: object) -> Sequence[StrPath]:
    given = type(subject).__name__
    if isinstance(subject, str | PathLike):
        return [subject]
    if isinstance(subject, Iterable) and not isinstance(subject, bytes | bytearray):
        items = list(subject)
        paths = [item for item in items if isinstance(item, str | PathLike)]
        if len(paths) == len(items):
            return paths
        given = f"a {given} with other objects than paths; taskset() makes a System of tasks"
    raise TypeError(f"expected {_ACCEPTED}; not {given}")
