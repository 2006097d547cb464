"""Which rules there are: the files tell, so that none has to be imported for that."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module
from importlib.resources import files

from amalthea_uros.validate.rule import Profile, Rule


def ids(profiles: Iterable[Profile] = Profile) -> Iterator[str]:
    """The ids of the rules of some profiles, in order."""
    for profile in profiles:
        yield from sorted(_id(name) for name in _modules(profile))


def rule(identifier: str) -> Rule:
    """A rule by its id.

    Raises
    ------
    KeyError : there is none.
    """
    for profile in Profile:
        name = identifier.lower().replace("-", "_")
        if name in _modules(profile):
            found: Rule = import_module(f"amalthea_uros.validate.rules.{profile}.{name}").RULE
            return found
    raise KeyError(identifier)


def _modules(profile: Profile) -> list[str]:
    folder = files("amalthea_uros.validate.rules") / profile
    names = (entry.name.removesuffix(".py") for entry in folder.iterdir() if entry.name.endswith(".py"))
    return [name for name in names if not name.startswith("_")]


def _id(name: str) -> str:
    return name.upper().replace("_", "-")
