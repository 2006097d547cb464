"""Measured times of agents and transports as data, which descriptions refer to by name, and what they add to a description."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Annotated, Literal, NamedTuple, TypeAlias

from amalthea_uros._internal.plural import enumerated
from amalthea_uros._internal.resources import MEASURED, known_measured
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.spec.fields import entry
from amalthea_uros.spec.known_files import KnownFiles
from amalthea_uros.spec.merging import has_parts
from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.read import read_section
from amalthea_uros.spec.section import DescriptionSection
from amalthea_uros.spec.transports import WIRES, Agent, TransportSection
from amalthea_uros.spec.values import Name, VersionedSection, described

_FILES = KnownFiles(
    kind="profile of measured times",
    files={name: MEASURED / f"{name}.yaml" for name in known_measured()},
    advice="or a file with times of your own, e.g. ./my-agent.yaml.",
)
_BASES = described(
    fitted="The times were chosen so that a model contains what was measured.",
    derived="The times are what is left of the measured ones after what the model explains.",
    measured="The times themselves were measured.",
)
_PHRASES = {"fitted": "chosen to fit", "derived": "derived from", "measured": "measured in"}
#: The same for a transport that was not fitted: times in the agent that were measured or derived on another one are others.
_WITH = "with which its times follow from"
#: The parts of a generic micro-ROS model that can name a profile, as sentences call them.
_PARTS = {"agent": "the agent", "transport": "the transport"}

_Part: TypeAlias = Agent | TransportSection


class MeasuredProfile(VersionedSection):
    """Times of an agent and a transport that somebody measured."""

    profile: Name
    """Name by which `agent.profile` and `transport.profile` refer to it."""
    title: Name
    """Controller, transport and host of the measurement."""
    source: Name
    """Where the measurement was published."""
    measured: Name
    """What was measured, as the end of a sentence: '30,000 round trips of ...'."""
    basis: Annotated[Literal["fitted", "derived", "measured"], _BASES]
    """How the times follow from that."""
    agent: Agent = entry(default_factory=Agent.model_construct)
    """The times in the agent."""
    transport: TransportSection = entry(default_factory=TransportSection.model_construct)
    """The transport, with its driver."""
    sources: dict[Name, str] = entry(default_factory=dict)
    """How single figures follow, by their keys."""


class WithMeasured(NamedTuple):
    """Generic micro-ROS models with the profiles of measured times that they name.

    Attributes
    ----------
    levels : the nearest one first
    assumptions : a sentence for each profile that is used
    """

    levels: tuple[Middleware, ...]
    assumptions: tuple[str, ...]
    findings: tuple[Finding, ...]


def with_measured(levels: Sequence[Middleware], folder: Path) -> WithMeasured:
    """Generic micro-ROS models, the nearest one first, with what the profiles that they name add to them.

    Of each part, the profile that is named nearest counts, after the level that names it: what is stated beside the name overrides it.

    Parameters
    ----------
    folder : what the path of a file is relative to, if it is unknown which file names it

    Raises
    ------
    ReadError : a profile is not known, its file is wrong, or it lacks what is asked of it.
    """
    models, assumptions, findings = list(levels), list[str](), list[Finding]()
    for part in _PARTS:
        index = next((number for number, level in enumerate(models) if getattr(level, part).states("profile")), None)
        if index is None:
            continue
        own: _Part = getattr(models[index], part)
        profile, mistakes = _profile(own, folder)
        times = _stated(profile, part, own)
        keys = [*_added(times, [getattr(level, part) for level in models[: index + 1]])]
        if keys:
            assumptions.append(_sentence(profile, part, keys))
        findings += mistakes
        models.insert(index + 1, Middleware.model_validate({part: times}))
    return WithMeasured(tuple(models), tuple(assumptions), tuple(findings))


def _profile(own: _Part, folder: Path) -> tuple[MeasuredProfile, tuple[Finding, ...]]:
    assert own.profile is not None
    place = own.location("profile")
    path, mistakes = _FILES.find(own.profile, folder if place is None else place.path.parent, place)
    profile = read_section(path, MeasuredProfile)
    for part in _PARTS:
        section: _Part = getattr(profile, part)
        if section.profile is not None:
            message = f"the profile {profile.profile!r} refers to another profile, {section.profile!r}"
            advice = "State the times in the file of the profile."
            raise ReadError([Finding("APP003", Severity.ERROR, message, section.location("profile"), advice)])
        if path.parent == MEASURED:
            # Users cannot change the files that come with amuros; they change what names them.
            section.move_to(own, "profile")
    return profile, mistakes


def _stated(profile: MeasuredProfile, part: str, own: _Part) -> _Part:
    """Return the times of a part in a profile; refuse a profile without them, or one of another wire."""
    section: _Part = getattr(profile, part)
    message = ""
    if not section.model_fields_set:
        message = f"the profile {profile.profile!r} has no times of {_PARTS[part]}"
    wires, asked = section.model_fields_set & WIRES, own.model_fields_set & WIRES
    if asked and wires and asked != wires:
        message = f"the profile {profile.profile!r} describes {min(wires)!r}, not {min(asked)!r}"
    if message:
        advice = f"Remove 'profile', and state the values of {_PARTS[part]}."
        raise ReadError([Finding("APP003", Severity.ERROR, message, own.location("profile"), advice)])
    return section


def _added(section: DescriptionSection, nearer: Sequence[DescriptionSection]) -> Iterator[str]:
    """The keys that a section states and that none of the nearer ones overrides."""
    others = {key for each in nearer for key in each.model_fields_set & WIRES}
    for key in type(section).model_fields:
        value, stated = getattr(section, key), [getattr(each, key) for each in nearer if each.states(key)]
        if not section.states(key) or (key in WIRES and others - {key}):
            continue
        if not has_parts(value):
            yield from () if stated else (key,)
        elif all(map(has_parts, stated)):
            yield from (f"{key}.{inner}" for inner in _added(value, stated))


def _sentence(profile: MeasuredProfile, part: str, keys: Sequence[str]) -> str:
    what = enumerated([*map(repr, keys)])
    are = "is that" if len(keys) == 1 else "are those"
    how = _WITH if part == "transport" and profile.basis != "fitted" else _PHRASES[profile.basis]
    return f"{what} of {_PARTS[part]} {are} of profile {profile.profile!r}, {how} {profile.measured}"
