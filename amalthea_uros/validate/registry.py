"""All rules by id. Those of this package are known by their files, so that none has to be imported for that."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from importlib import import_module
from importlib.resources import files

from amalthea_uros._internal.addresses import page_of_finding
from amalthea_uros.findings import catalogue
from amalthea_uros.findings.kind import FindingKind
from amalthea_uros.validate.rule import ModelRule, Profile, Rule
from amalthea_uros.validate.user_rules import check_id, installed_rules

#: The line of a file that defines the id of its rule.
_ID = re.compile(r'^    id="([^"]+)",$', re.MULTILINE)


#: Those whose rules are part of this package.
_BUILT_IN = tuple(profile for profile in Profile if profile is not Profile.USER)

#: Rules that were added in this process, by id.
_added: dict[str, ModelRule] = {}


def add(rules: Iterable[ModelRule]) -> None:
    """Make rules known for as long as the process runs.

    Raises
    ------
    ReadError : the id of a rule is taken, or cannot be one.
    """
    for new in rules:
        check_id(new, is_taken=kind(new.id) is not None)
        _added[new.id] = new


def ids(profiles: Iterable[Profile] = Profile) -> Iterator[str]:
    """The ids of the rules of some profiles, in order.

    Raises
    ------
    ReadError : rules of an installed package cannot be loaded.
    """
    for profile in profiles:
        if profile is Profile.USER:
            yield from sorted(_user_rules())
            continue
        folder = files("amalthea_uros.validate.rules") / _folder(profile)
        yield from sorted(_ID.findall((folder / f"{name}.py").read_text())[0] for name in _modules(profile))


def profile_of(identifier: str) -> Profile | None:
    """The profile of a rule; None if there is no such rule."""
    name = _module(identifier)
    built_in = next((profile for profile in _BUILT_IN if name in _modules(profile)), None)
    return Profile.USER if built_in is None and identifier in _user_rules() else built_in


def rule_url(identifier: str) -> str | None:
    """The page of a rule or another kind of finding; None for the rules of users, whose pages are elsewhere, and for unknown ids."""
    if profile_of(identifier) in _BUILT_IN or catalogue.find(identifier) is not None:
        return page_of_finding(identifier)
    return None


def rule(identifier: str) -> Rule:
    """A rule by its id.

    Raises
    ------
    KeyError : there is no such rule.
    """
    profile = profile_of(identifier)
    if profile is None:
        raise KeyError(identifier)
    if profile is Profile.USER:
        return _user_rules()[identifier]
    found: Rule = import_module(f"amalthea_uros.validate.rules.{_folder(profile)}.{_module(identifier)}").RULE
    return found


def _user_rules() -> Mapping[str, ModelRule]:
    return {**_installed(), **_added}


@cache
def _installed() -> Mapping[str, ModelRule]:
    """The rules of installed packages, by id."""
    found: dict[str, ModelRule] = {}
    for new in installed_rules():
        is_built_in = any(_module(new.id) in _modules(profile) for profile in _BUILT_IN)
        check_id(new, is_taken=is_built_in or new.id in found or catalogue.find(new.id) is not None)
        found[new.id] = new
    return found


def kind(identifier: str) -> FindingKind | None:
    """What all findings of an id have in common, whether a rule reports them or not; None if there are none."""
    found = catalogue.find(identifier)
    return found if found is not None or profile_of(identifier) is None else rule(identifier)


def _module(identifier: str) -> str:
    return re.sub("[-/.]", "_", identifier.lower())


def _folder(profile: Profile) -> str:
    return profile.replace("-", "_")


@cache
def _modules(profile: Profile) -> frozenset[str]:
    folder = files("amalthea_uros.validate.rules") / _folder(profile)
    return frozenset(
        entry.name.removesuffix(".py")
        for entry in folder.iterdir()
        if entry.name.endswith(".py") and not entry.name.startswith("_")
    )
