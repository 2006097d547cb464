"""Which rules there are: the files tell, so that none has to be imported for that."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from importlib import import_module
from importlib.resources import files
from importlib.resources.abc import Traversable

from amalthea_uros.validate.rule import Profile, Rule

#: How a file says the id of its rule.
_ID = re.compile(r'^    id="([^"]+)",$', re.MULTILINE)


def ids(profiles: Iterable[Profile] = Profile) -> Iterator[str]:
    """The ids of the rules of some profiles, in order."""
    for profile in profiles:
        yield from sorted(_ID.findall(entry.read_text())[0] for entry in _entries(profile))


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
    return [entry.name.removesuffix(".py") for entry in _entries(profile)]


def _entries(profile: Profile) -> list[Traversable]:
    folder = files("amalthea_uros.validate.rules") / profile
    return [entry for entry in folder.iterdir() if entry.name.endswith(".py") and not entry.name.startswith("_")]
