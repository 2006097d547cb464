"""The platforms that come with amuros, and platform files of users."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from amalthea_uros._internal.resources import PLATFORMS, known_platforms
from amalthea_uros._internal.similar import similar
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.hardware import Hardware, Platform
from amalthea_uros.spec.read import read_section
from amalthea_uros.spec.repair import CERTAIN

_SUFFIXES = (".yaml", ".yml")


class WholeHardware(NamedTuple):
    """The hardware of an application, completed by its platform.

    Attributes
    ----------
    platform : name of the platform; None if there is none
    findings : a misspelled platform, in whose place the one that was probably meant is used
    """

    hardware: Hardware
    platform: str | None
    findings: tuple[Finding, ...] = ()


def whole_hardware(stated: Hardware, folder: Path, other: str | None = None) -> WholeHardware:
    """The hardware of an application, completed by its platform.

    Parameters
    ----------
    folder : the directory of the application; platform files are relative to it
    other : replaces the platform of the application

    Raises
    ------
    ReadError : the platform is not known, or its file is wrong.
    """
    named = other or stated.platform
    if named is None:
        return WholeHardware(stated, None)
    path, findings = _file(stated, named, folder)
    platform = read_section(path, Platform)
    _refuse_base(platform)
    added = {key: getattr(platform.hardware, key) for key in platform.hardware.model_fields_set - stated.model_fields_set}
    if stated.frequency is not None and "cores" in added:
        # One clock for all cores, whatever the platform says.
        added["cores"] = [core.model_copy(update={"frequency": None}) for core in added["cores"]]
    return WholeHardware(stated.model_copy(update=added), platform.platform, findings)


def _refuse_base(platform: Platform) -> None:
    if platform.hardware.platform is not None:
        message = f"the platform {platform.platform!r} refers to another platform, {platform.hardware.platform!r}"
        advice = "Describe the whole hardware in the platform file."
        raise ReadError([Finding("APP003", Severity.ERROR, message, platform.hardware.location("platform"), advice)])


def _file(stated: Hardware, name: str, folder: Path) -> tuple[Path, tuple[Finding, ...]]:
    """The file of a platform, and what is wrong with its name if it is clear which one is meant."""
    if name.endswith(_SUFFIXES):
        path = folder / name
        if path.is_file():
            return path, ()
        message, advice = f"platform file {str(path)!r} not found", "Give a path relative to the directory of this file."
        raise ReadError([_undefined(stated, message, advice)])
    known = known_platforms()
    if name in known:
        return _known_file(name), ()
    near = similar(name, known)
    others = f"Known platforms: {', '.join(known)}; use 'generic' with 'frequency' and 'cores', or a file, e.g. ./mine.yaml."
    advice = f"Did you mean {near[0]!r}?" if near else others
    finding = _undefined(stated, f"unknown platform {name!r}", advice)
    if not similar(name, known, cutoff=CERTAIN):
        raise ReadError([finding])
    return _known_file(near[0]), (finding,)


def _known_file(name: str) -> Path:
    return PLATFORMS / f"{name}.yaml"


def _undefined(stated: Hardware, message: str, advice: str) -> Finding:
    return Finding("APP001", Severity.ERROR, message, stated.location("platform"), advice)
