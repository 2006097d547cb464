"""All rules by id. Those of this package are found by the files of their texts, so that only those that are used are imported."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cache
from importlib import import_module
from itertools import chain
from pathlib import Path

from amalthea_uros._internal.addresses import page_of_finding
from amalthea_uros.findings import catalogue
from amalthea_uros.findings.kind import FindingKind, ids_in, kind_in
from amalthea_uros.validate.rule import CHECKS, ModelCheck, ModelRule, RuleProfile, SystemCheck
from amalthea_uros.validate.user_rules import check_id, installed_rules

#: The families of findings that are selected like rules, although something else reports them.
_FAMILIES = {RuleProfile.SCHEMA: "XSD", RuleProfile.MICRO_ROS: "UR"}

#: The profiles whose rules are part of this package.
_BUILT_IN = tuple(profile for profile in RuleProfile if profile is not RuleProfile.USER)

#: Rules that were added in this process, by id.
_added: dict[str, ModelRule] = {}


def add(rules: Iterable[ModelRule]) -> None:
    """Make rules known for as long as the process runs.

    Raises
    ------
    ReadError : the id of a rule is taken, or cannot be one.
    """
    for new in rules:
        check_id(new, _taken(_user_rules()))
        _added[new.id] = new


def ids(profiles: Iterable[RuleProfile] = RuleProfile) -> Iterator[str]:
    """The ids of the rules of some profiles, in order.

    Raises
    ------
    ReadError : rules of an installed package cannot be loaded.
    """
    for profile in profiles:
        yield from sorted(_user_rules() if profile is RuleProfile.USER else _built_in(profile))


def profile_of(identifier: str) -> RuleProfile | None:
    """The profile of a rule; None if there is no such rule."""
    built_in = _built_in_profile(identifier)
    return RuleProfile.USER if built_in is None and identifier in _user_rules() else built_in


def rule_url(identifier: str) -> str | None:
    """The page of a rule or another kind of finding; None for the rules of users, whose pages are elsewhere, and for unknown ids."""
    is_known = _built_in_profile(identifier) is not None or catalogue.find(identifier) is not None
    return page_of_finding(identifier) if is_known else None


def kind(identifier: str) -> FindingKind | None:
    """What all findings of an id have in common, whether a rule reports them or not; None if there are none."""
    profile = _built_in_profile(identifier)
    if profile is None:
        return catalogue.find(identifier) or _user_rules().get(identifier)
    return catalogue.find(identifier) if profile in _FAMILIES else kind_in(_files(profile)[identifier], identifier)


def check(identifier: str) -> ModelCheck | SystemCheck | None:
    """What a rule demands; None if there is no such rule, and if something else reports its findings."""
    profile = _built_in_profile(identifier)
    if profile is None:
        return _user_rules().get(identifier)
    if profile in _FAMILIES:
        return None
    import_module(f"amalthea_uros.validate.rules.{profile}.{_files(profile)[identifier].stem}")
    return CHECKS[identifier]


def _user_rules() -> Mapping[str, ModelRule]:
    return {**_installed(), **_added}


@cache
def _installed() -> Mapping[str, ModelRule]:
    """The rules of installed packages, by id."""
    found: dict[str, ModelRule] = {}
    for new in installed_rules():
        check_id(new, _taken(found))
        found[new.id] = new
    return found


def _taken(by_users: Iterable[str]) -> Iterator[str]:
    """The ids that a new rule cannot have."""
    return chain(by_users, catalogue.ids(), *map(_built_in, _BUILT_IN))


@cache
def _built_in_profile(identifier: str) -> RuleProfile | None:
    return next((profile for profile in _BUILT_IN if identifier in _built_in(profile)), None)


def _built_in(profile: RuleProfile) -> Collection[str]:
    """The ids of the rules of a profile that are part of this package."""
    return catalogue.ids_of(_FAMILIES[profile]) if profile in _FAMILIES else _files(profile)


@cache
def _files(profile: RuleProfile) -> Mapping[str, Path]:
    """The file with the texts of each rule of a profile, by id; the module of the same name has its check."""
    files = (Path(__file__).parent / "rules" / profile).glob("*.yaml")
    return {identifier: file for file in files for identifier in ids_in(file)}
