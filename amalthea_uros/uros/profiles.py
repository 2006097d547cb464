"""The profile of the middleware that a description names: one that comes with amuros, or a file that changes one of these."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from functools import cache
from pathlib import Path

from amalthea_uros._internal.similar import similar
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.known_files import KnownFiles
from amalthea_uros.spec.merging import merged
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData
from amalthea_uros.spec.read import read_section
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.middleware.profile import Profile
from amalthea_uros.uros.middleware.xrce_dds.profile import XrceDds
from amalthea_uros.uros.middleware.zenoh_pico.profile import ZenohPico

#: Keys with figures by name, and what these are; a file can change single ones.
_TABLES = {"sizes": "size", "options": "build option"}
#: The middlewares whose rules are known, by the names of their profiles.
KNOWN: Mapping[str, type[Profile]] = {"xrce-dds": XrceDds, "zenoh-pico": ZenohPico}
_FILES = KnownFiles(
    kind="profile",
    files={name: Path(__file__).parent / "middleware" / name.replace("-", "_") / "profile.yaml" for name in KNOWN},
    advice="or give a file, e.g. ./my-middleware.yaml.",
)


def profile_of(middleware: Middleware) -> Profile:
    """The profile of a middleware; the path of a file is relative to the directory of the file that states it.

    Raises
    ------
    ReadError : the profile is not known, or its file is wrong.
    """
    name, place = middleware.profile, middleware.location("profile")
    if name in KNOWN:
        return KNOWN[name](known_data(name), middleware)
    path, mistakes = _FILES.find(name, place.path.parent if place is not None else Path(), place)
    if mistakes:
        raise ReadError(mistakes)
    own = read_section(path, ProfileData)
    if own.base is None:
        message = f"the profile {own.profile!r} does not name the one that it changes"
        advice = f"Set 'base' to one of: {', '.join(KNOWN)}."
        raise ReadError([Finding("APP003", Severity.ERROR, message, own.location(), advice)])
    if own.base not in KNOWN:
        raise ReadError([_FILES.unknown(own.base, own.location("base"))])
    base = known_data(own.base)
    _check_names(own, {"sizes": base.sizes, "options": ["MTU", *KNOWN[own.base](base, middleware).option_table]})
    tables = {key: getattr(base, key) | getattr(own, key) for key in _TABLES}
    return KNOWN[own.base](merged(own, base).model_copy(update=tables), middleware)


def stated_profile(middleware: Middleware, notes: Notes) -> Profile | None:
    """The profile of the middleware of a description; None, with a finding, if it is not known."""
    try:
        return profile_of(middleware)
    except ReadError as error:
        notes.add_all(error.findings)
        return None


@cache
def known_data(name: str) -> ProfileData:
    """The figures of a profile that comes with amuros."""
    return read_section(_FILES.files[name], ProfileData)


def _check_names(own: ProfileData, names: Mapping[str, Collection[str]]) -> None:
    """Refuse figures that the code of the base does not ask for."""
    findings = []
    for key, what in _TABLES.items():
        known = names[key]
        for name in getattr(own, key):
            if name not in known:
                near = similar(name, known)
                advice = f"Did you mean {near[0]!r}?" if near else f"Use one of: {', '.join(known)}."
                findings.append(Finding("APP001", Severity.ERROR, f"unknown {what} {name!r}", own.location(key), advice))
    if findings:
        raise ReadError(findings)
