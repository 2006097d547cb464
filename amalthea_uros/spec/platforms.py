"""The platforms that come with amuros, and platform files of users."""

from __future__ import annotations

from pathlib import Path

from amalthea_uros._internal.resources import PLATFORMS
from amalthea_uros._internal.similar import similar
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.hardware import Hardware, Platform
from amalthea_uros.spec.read import read_section

_SUFFIXES = (".yaml", ".yml")


def known_platforms() -> list[str]:
    """The names of the platforms that come with this package."""
    return sorted(path.stem for path in PLATFORMS.glob("*.yaml"))


def whole_hardware(stated: Hardware, folder: Path, other: str | None = None) -> tuple[Hardware, str | None]:
    """The hardware of an application, completed by its platform, and the name of the platform.

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
        return stated, None
    platform = read_section(_file(stated, named, folder), Platform)
    added = {key: getattr(platform.hardware, key) for key in platform.hardware.model_fields_set - stated.model_fields_set}
    if stated.frequency is not None and "cores" in added:
        # One clock for all cores, whatever the platform says.
        added["cores"] = [core.model_copy(update={"frequency": None}) for core in added["cores"]]
    return stated.model_copy(update=added), platform.platform


def _file(stated: Hardware, name: str, folder: Path) -> Path:
    if name.endswith(_SUFFIXES):
        path = folder / name
        if path.is_file():
            return path
        message, advice = f"platform file {str(path)!r} not found", "Give a path relative to the directory of this file."
    else:
        known = known_platforms()
        if name in known:
            return PLATFORMS / f"{name}.yaml"
        near = similar(name, known)
        message = f"unknown platform {name!r}"
        advice = (
            f"Did you mean {near[0]!r}?" if near else f"Known platforms: {', '.join(known)}; or give a file, e.g. ./mine.yaml."
        )
    raise ReadError([Finding("APP001", Severity.ERROR, message, stated.location("platform"), advice)])
