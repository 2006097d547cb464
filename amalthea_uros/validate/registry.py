"""The available rules, found by their files so that listing them imports none of them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cache
from importlib import import_module
from importlib.resources import files

from amalthea_uros.validate.rule import Profile, Rule

#: The line of a file that defines the id of its rule.
_ID = re.compile(r'^    id="([^"]+)",$', re.MULTILINE)


def ids(profiles: Iterable[Profile] = Profile) -> Iterator[str]:
    """The ids of the rules in profiles, sorted within each profile."""
    for profile in profiles:
        folder = files("amalthea_uros.validate.rules") / _folder(profile)
        yield from sorted(_ID.findall((folder / f"{name}.py").read_text())[0] for name in _modules(profile))


def profile_of(identifier: str) -> Profile | None:
    """The profile of a rule; None if there is no such rule."""
    name = _module(identifier)
    return next((profile for profile in Profile if name in _modules(profile)), None)


def rule(identifier: str) -> Rule:
    """A rule by its id.

    Raises
    ------
    KeyError : there is no such rule.
    """
    profile = profile_of(identifier)
    if profile is None:
        raise KeyError(identifier)
    found: Rule = import_module(f"amalthea_uros.validate.rules.{_folder(profile)}.{_module(identifier)}").RULE
    return found


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
