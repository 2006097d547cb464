"""Which rules there are: the files tell, so that none has to be imported for that."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cache
from importlib import import_module
from importlib.resources import files

from amalthea_uros.findings import catalogue
from amalthea_uros.findings.kind import FindingKind
from amalthea_uros.validate.rule import Profile, Rule

#: How a file says the id of its rule.
_ID = re.compile(r'^    id="([^"]+)",$', re.MULTILINE)


def ids(profiles: Iterable[Profile] = Profile) -> Iterator[str]:
    """The ids of the rules of some profiles, in order."""
    for profile in profiles:
        folder = files("amalthea_uros.validate.rules") / _folder(profile)
        yield from sorted(_ID.findall((folder / f"{name}.py").read_text())[0] for name in _modules(profile))


def profile_of(identifier: str) -> Profile | None:
    """The profile of a rule, None if there is no such rule."""
    name = _module(identifier)
    return next((profile for profile in Profile if name in _modules(profile)), None)


def rule(identifier: str) -> Rule:
    """A rule by its id.

    Raises
    ------
    KeyError : there is none.
    """
    profile = profile_of(identifier)
    if profile is None:
        raise KeyError(identifier)
    found: Rule = import_module(f"amalthea_uros.validate.rules.{_folder(profile)}.{_module(identifier)}").RULE
    return found


def kind(identifier: str) -> FindingKind | None:
    """What all findings of an id have in common, whether a rule reports them or not; None if there are none."""
    return catalogue.find(identifier) if profile_of(identifier) is None else rule(identifier)


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
