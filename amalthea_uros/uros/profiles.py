"""The profile of the middleware that a description names: one that comes with amuros, or a file that changes one of these."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from functools import cache
from pathlib import Path

from amalthea_uros._internal.similar import similar
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.merging import merged
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.spec.read import read_section
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.middleware.xrce_dds.profile import XrceDds
from amalthea_uros.uros.middleware.zenoh_pico.profile import ZenohPico

_SUFFIXES = (".yaml", ".yml")
#: Keys with figures by name, and what these are; a file can change single ones.
_TABLES = {"sizes": "size", "options": "build option"}
#: The middlewares whose rules are known, by the names of their profiles.
KNOWN: Mapping[str, type[Profile]] = {"xrce-dds": XrceDds, "zenoh-pico": ZenohPico}


def profile_of(middleware: Middleware, folder: Path | None = None) -> Profile:
    """The profile of a middleware.

    Parameters
    ----------
    folder : what the path of a file is relative to; default: the directory of the file that states it

    Raises
    ------
    ReadError : the profile is not known, or its file is wrong.
    """
    name, place = middleware.profile, middleware.location("profile")
    if not name.endswith(_SUFFIXES):
        return KNOWN[_known(name, place)](known_data(name), middleware)
    own = read_section(_file(name, folder, place), ProfileData)
    if own.base is None:
        message = f"the profile {own.profile!r} does not name the one that it changes"
        raise _mistake("APP003", message, own.location(), f"Set 'base' to one of: {', '.join(KNOWN)}.")
    base = known_data(_known(own.base, own.location("base")))
    _check_names(own, {"sizes": base.sizes, "options": ["MTU", *KNOWN[own.base](base, middleware).option_table]})
    tables = {key: getattr(base, key) | getattr(own, key) for key in _TABLES}
    return KNOWN[own.base](merged(own, base).model_copy(update=tables), middleware)


def stated_profile(middleware: Middleware, notes: Notes) -> Profile | None:
    """The profile of the middleware of a description; None, with a finding, if it is not known."""
    try:
        return profile_of(middleware)
    except ReadError as error:
        notes.findings.extend(error.findings)
        return None


@cache
def known_data(name: str) -> ProfileData:
    """The figures of a profile that comes with amuros."""
    return read_section(Path(__file__).parent / "middleware" / name.replace("-", "_") / "profile.yaml", ProfileData)


def _known(name: str, place: Location | None) -> str:
    if name not in KNOWN:
        others = f"Known profiles: {', '.join(KNOWN)}; or give a file, e.g. ./my-middleware.yaml."
        raise _mistake("APP001", f"unknown profile {name!r}", place, _suggestion(name, KNOWN, others))
    return name


def _file(name: str, folder: Path | None, place: Location | None) -> Path:
    if folder is None:
        folder = place.path.parent if place is not None else Path()
    path = folder / name
    if not path.is_file():
        advice = "Give a path relative to the directory of this file."
        raise _mistake("APP001", f"profile file {str(path)!r} not found", place, advice)
    return path


def _check_names(own: ProfileData, names: Mapping[str, Collection[str]]) -> None:
    """Refuse figures that the code of the base does not ask for."""
    findings = []
    for key, what in _TABLES.items():
        known = names[key]
        for name in getattr(own, key):
            if name not in known:
                advice = _suggestion(name, known, f"Use one of: {', '.join(known)}.")
                findings.append(Finding("APP001", Severity.ERROR, f"unknown {what} {name!r}", own.location(key), advice))
    if findings:
        raise ReadError(findings)


def _suggestion(name: str, known: Iterable[str], others: str) -> str:
    near = similar(name, known)
    return f"Did you mean {near[0]!r}?" if near else others


def _mistake(rule: str, message: str, place: Location | None, advice: str) -> ReadError:
    return ReadError([Finding(rule, Severity.ERROR, message, place, advice)])
