"""The platforms that an application can name, and the users' own ones."""

from __future__ import annotations

from difflib import get_close_matches
from pathlib import Path

from amalthea_uros._internal.resources import PLATFORMS
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.hardware import Hardware, Platform
from amalthea_uros.spec.read import read_section

_SUFFIXES = (".yaml", ".yml")


def known_platforms() -> list[str]:
    """The names of the platforms that come with this package."""
    return sorted(path.stem for path in PLATFORMS.glob("*.yaml"))


def whole_hardware(stated: Hardware, folder: Path, other: str | None = None) -> tuple[Hardware, str | None]:
    """What an application states about its hardware, completed by its platform; and the name of the platform.

    Parameters
    ----------
    folder : where the file of the application lies; platform files are found from there
    other : the platform to take instead of the one that is stated

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
        # One clock for everything, whatever the cores of the platform state.
        added["cores"] = [core.model_copy(update={"frequency": None}) for core in added["cores"]]
    return stated.model_copy(update=added), platform.platform


def _file(stated: Hardware, name: str, folder: Path) -> Path:
    if name.endswith(_SUFFIXES):
        path = folder / name
        if path.is_file():
            return path
        message, advice = f"there is no platform file {str(path)!r}", "The path is relative to the folder of this file."
    else:
        known = known_platforms()
        if name in known:
            return PLATFORMS / f"{name}.yaml"
        near = get_close_matches(name, known, n=1)
        message = f"{name!r} is not a known platform"
        advice = f"Did you mean {near[0]!r}?" if near else f"Platforms are {', '.join(known)}, and files such as './mine.yaml'."
    raise ReadError([Finding("APP001", Severity.ERROR, message, stated.location("platform"), advice)])
