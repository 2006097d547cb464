"""All rules by id. Those of this package are found by the text of their files, so that only those that are used are imported."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cache
from importlib import import_module
from itertools import chain
from pathlib import Path

from amalthea_uros._internal.addresses import page_of_finding
from amalthea_uros.findings import catalogue
from amalthea_uros.findings.kind import FindingKind
from amalthea_uros.validate.rule import ModelRule, RuleProfile, SystemRule
from amalthea_uros.validate.user_rules import check_id, installed_rules

#: The families of findings that are selected like rules, although something else reports them.
_FAMILIES = {RuleProfile.SCHEMA: "XSD", RuleProfile.MICRO_ROS: "UR"}

#: The profiles whose rules are part of this package.
_BUILT_IN = tuple(profile for profile in RuleProfile if profile is not RuleProfile.USER)

#: The part of a file that defines the id of a rule.
_ID = re.compile(r'^ +id="([^"]+)",$', re.MULTILINE)

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


def rule(identifier: str) -> FindingKind:
    """A rule by its id.

    Raises
    ------
    KeyError : there is no such rule.
    """
    profile = profile_of(identifier)
    if profile is None:
        raise KeyError(identifier)
    if profile is RuleProfile.USER:
        return _user_rules()[identifier]
    if profile in _FAMILIES:
        return next(kind for kind in catalogue.kinds(_FAMILIES[profile]) if kind.id == identifier)
    return _rules_of(f"{profile}.{_modules(profile)[identifier]}")[identifier]


def rules_with_checks(identifiers: Iterable[str]) -> list[ModelRule | SystemRule]:
    """The rules of some ids, without those whose findings something else reports."""
    rules = (rule(identifier) for identifier in identifiers if _built_in_profile(identifier) not in _FAMILIES)
    return [rule for rule in rules if isinstance(rule, ModelRule | SystemRule)]


def kind(identifier: str) -> FindingKind | None:
    """What all findings of an id have in common, whether a rule reports them or not; None if there are none."""
    found = catalogue.find(identifier)
    return found if found is not None or profile_of(identifier) is None else rule(identifier)


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


def _built_in_profile(identifier: str) -> RuleProfile | None:
    return next((profile for profile in _BUILT_IN if identifier in _built_in(profile)), None)


def _built_in(profile: RuleProfile) -> Collection[str]:
    """The ids of the rules of a profile that are part of this package."""
    return catalogue.ids_of(_FAMILIES[profile]) if profile in _FAMILIES else _modules(profile)


@cache
def _modules(profile: RuleProfile) -> Mapping[str, str]:
    """The names of the modules of the rules of a profile, by id."""
    files = (Path(__file__).parent / "rules" / profile).glob("*.py")
    return {identifier: file.stem for file in files for identifier in _ID.findall(file.read_text(encoding="utf-8"))}


@cache
def _rules_of(module: str) -> Mapping[str, FindingKind]:
    """The rules of a module, which defines one, or a table of them."""
    content = import_module(f"amalthea_uros.validate.rules.{module}")
    return {rule.id: rule for rule in getattr(content, "RULES", None) or (content.RULE,)}
