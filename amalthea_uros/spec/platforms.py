"""Platforms and operating systems as data, which descriptions refer to by name, and what they add to a description."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from amalthea_uros._internal.resources import PLATFORMS, RTOSES, known_platforms, known_rtoses
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.description import Description
from amalthea_uros.spec.fields import entry
from amalthea_uros.spec.hardware import HardwareSection
from amalthea_uros.spec.known_files import KnownFiles
from amalthea_uros.spec.measured import with_measured
from amalthea_uros.spec.merging import merged, merged_middleware
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.os import OsSection
from amalthea_uros.spec.read import read_section
from amalthea_uros.spec.values import Name, VersionedSection

_PLATFORM_FILES = KnownFiles(
    kind="platform",
    files={name: PLATFORMS / f"{name}.yaml" for name in known_platforms()},
    advice="use 'generic' with 'frequency' and 'cores', or a file, e.g. ./mine.yaml.",
)
_RTOS_FILES = KnownFiles(
    kind="operating system",
    files={name: RTOSES / f"{name}.yaml" for name in known_rtoses()},
    advice="or a file that describes another one, e.g. ./my-rtos.yaml.",
)


class Platform(VersionedSection):
    """A controller that applications refer to by name."""

    platform: Name
    """Name by which execution times refer to it."""
    hardware: HardwareSection
    """The hardware itself."""
    os: OsSection = entry(default_factory=OsSection.model_construct)
    """The operating system that is usual on it; keys of the application override it."""
    middleware: Middleware = entry(default_factory=Middleware.model_construct)
    """The generic micro-ROS model as ported to it; keys of the application override it, key by key."""
    source: str | None = None
    """Source of the figures."""
    sources: dict[Name, str] = entry(default_factory=dict)
    """Sources of single figures, by their keys."""


class Rtos(VersionedSection):
    """An operating system that platforms and applications refer to by name."""

    rtos: Name
    """Name by which `os.rtos` refers to it."""
    title: Name
    """Its full name."""
    os: OsSection = entry(default_factory=OsSection.model_construct)
    """Its properties; keys of the platform and of the application override them."""
    middleware: Middleware = entry(default_factory=Middleware.model_construct)
    """The generic micro-ROS model as ported to it; keys of the platform and of the application override it, key by key."""
    sources: dict[Name, str] = entry(default_factory=dict)
    """Sources of the figures, by their keys."""


class CompleteDescription(NamedTuple):
    """A description, completed by its platform, its operating system and profiles of measured times.

    Attributes
    ----------
    assumptions : about measured times, in sentences
    platform : name of the platform; None if there is none
    findings : misspelled names, in whose place those that were probably meant are used
    """

    description: Description
    platform: str | None
    findings: tuple[Finding, ...] = ()
    assumptions: tuple[str, ...] = ()


def complete(description: Description, folder: Path, other: str | None = None) -> CompleteDescription:
    """A description, completed by its platform and its operating system.

    What the application states counts first, then what its platform states, then what its operating system does. An application
    that chooses another operating system than that of its platform gets the properties of the chosen one, and of the generic
    micro-ROS models that of the chosen one before that of the platform.

    Parameters
    ----------
    folder : the directory of the application; files of platforms and operating systems are relative to it
    other : replaces the platform of the application

    Raises
    ------
    ReadError : a name is not known, or a file is wrong.
    """
    findings: list[Finding] = []
    path = _platform_file(description.hardware, folder, other, findings)
    if path is None:
        rtos = _rtos(description.os, folder, findings)
        return _completed(description, None, [rtos.os], [rtos.middleware], folder, findings)
    platform = _of_same_port(_platform(path, description.hardware), description.middleware.port)
    if description.os.rtos in (None, platform.os.rtos):
        rtos = _rtos(platform.os, path.parent, findings)
        models = [platform.middleware, rtos.middleware]
        return _completed(description, platform, [platform.os, rtos.os], models, folder, findings)
    rtos = _rtos(description.os, folder, findings)
    # The port of the platform is one to its own operating system.
    model = platform.middleware.model_copy(update={"port": None})
    return _completed(description, platform, [rtos.os], [rtos.middleware, model], folder, findings)


def _completed(
    description: Description,
    platform: Platform | None,
    systems: Sequence[OsSection],
    models: Sequence[Middleware],
    folder: Path,
    findings: Iterable[Finding],
) -> CompleteDescription:
    if not description.application.nodes:
        models = [_policy(model) for model in models]
    measured = with_measured([description.middleware, *models], folder)
    update = {
        "hardware": description.hardware if platform is None else _hardware(description.hardware, platform.hardware),
        "os": merged(description.os, *systems),
        "middleware": merged_middleware(*measured.levels),
    }
    name = None if platform is None else platform.platform
    mistakes = (*findings, *measured.findings)
    return CompleteDescription(description.model_copy(update=update), name, mistakes, measured.assumptions)


#: What of the operating system a port configures.
_OF_PORT = {"tick", "time_slice"}


def _of_same_port(platform: Platform, port: str | None) -> Platform:
    """A platform without what it says of the port of micro-ROS to it, if the application has another one."""
    own = platform.middleware
    if port is None or own.port is None or own.port == port:
        return platform
    kept = {key: getattr(own, key) for key in ("policy", "task_periods") if own.states(key)}
    system = {key: getattr(platform.os, key) for key in platform.os.model_fields_set - _OF_PORT}
    return platform.model_copy(update={"middleware": Middleware(**kept), "os": OsSection.model_construct(**system)})


def _policy(model: Middleware) -> Middleware:
    """What a generic micro-ROS model says about software without micro-ROS."""
    return Middleware(policy=model.policy) if model.states("policy") else Middleware()


def _platform_file(stated: HardwareSection, folder: Path, other: str | None, findings: list[Finding]) -> Path | None:
    name = other or stated.platform
    if name is None:
        return None
    path, mistakes = _PLATFORM_FILES.find(name, folder, stated.location("platform"))
    findings += mistakes
    return path


def _platform(path: Path, stated: HardwareSection) -> Platform:
    platform = read_section(path, Platform)
    if path.parent == PLATFORMS:
        # Users cannot change the files that come with amuros; they change what names them.
        platform.os.move_to(stated, "platform")
        platform.middleware.move_to(stated, "platform")
    if platform.hardware.platform is not None:
        message = f"the platform {platform.platform!r} refers to another platform, {platform.hardware.platform!r}"
        advice = "Describe the whole hardware in the platform file."
        raise ReadError([Finding("APP003", Severity.ERROR, message, platform.hardware.location("platform"), advice)])
    return platform


def _hardware(stated: HardwareSection, usual: HardwareSection) -> HardwareSection:
    found = merged(stated, usual)
    if stated.frequency is None or stated.cores is not None or found.cores is None:
        return found
    # One clock for all cores, whatever the platform says.
    return found.model_copy(update={"cores": [core.model_copy(update={"frequency": None}) for core in found.cores]})


def _rtos(stated: OsSection, folder: Path, findings: list[Finding]) -> Rtos:
    """The operating system that is stated; one without properties if none is."""
    if stated.rtos is None:
        return Rtos(amuros=1, rtos="none", title="none")
    path, mistakes = _RTOS_FILES.find(stated.rtos, folder, stated.location("rtos"))
    findings += mistakes
    rtos = read_section(path, Rtos)
    if path.parent == RTOSES:
        rtos.move_to(stated, "rtos")
    return rtos
