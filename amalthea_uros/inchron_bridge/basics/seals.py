"""Whether an object is as amuros wrote it: what its comment says of it as a whole holds only then.

Whoever changes a time in another tool changes the object, and not what the comment says of it.
"""

from __future__ import annotations

from collections.abc import Iterable
from hashlib import blake2b
from typing import Any

from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.facts import features
from amalthea_uros.inchron.objects import ProjectObject, default_of
from amalthea_uros.inchron_bridge.basics.comments import note, noted
from amalthea_uros.metamodel.factfile import FeatureKind

#: The key of the seal in a comment, and the keys of what it seals.
_SEAL = "seal"
SEALED = ("activity", "stimulus", "chain", "limit", "hardware", "counter", "group", "condition", "synchronized")

#: Features that say nothing about the object itself: what it activates, its name in the file, and what it is said to be.
_OTHERS = {"intrinsicId", "comment", "targets", "callGraph", "users", "activators"}


def seal_all(model: ProjectObject) -> None:
    """Seal all objects of a project whose comments say what they are as a whole."""
    for item in model.walk():
        if item.values.get("comment") and any(key in noted(item) for key in SEALED):
            note(item, **{_SEAL: _digest(_sealed(item))})


def is_sealed(item: ProjectObject) -> bool:
    """Whether an object is as it was when it was written."""
    return noted(item).get(_SEAL) == _digest(_sealed(item))


def require_sealed(item: ProjectObject) -> None:
    """Refuse what a comment says of an object that was changed.

    Raises
    ------
    UnknownError : it was changed.
    """
    if not is_sealed(item):
        raise UnknownError("it was changed since amuros wrote it")


def _sealed(item: ProjectObject) -> Iterable[ProjectObject]:
    """The objects that a seal covers: the object itself; of a model, its hardware."""
    if item.kind != "Model":
        return objects_beside(item)
    return (*item["clocks"], *item["cpus"], *item["memories"], *item["interconnects"])


def objects_beside(item: ProjectObject) -> list[ProjectObject]:
    """The object, with those after it that its comment speaks for, too."""
    span = noted(item).get("span")
    if type(span) is not int or item.owner is None:
        return [item]
    entries = next((parts for parts in _lists(item.owner) if item in parts), [item])
    place = entries.index(item)
    return entries[place : place + span]


def _lists(item: ProjectObject) -> Iterable[list[ProjectObject]]:
    return (parts for parts in item.values.values() if isinstance(parts, list))


def _digest(items: Iterable[ProjectObject]) -> str:
    digest = blake2b(digest_size=9)
    for item in items:
        for word in _words(item):
            digest.update(f"{word}\n".encode("utf-8", "surrogatepass"))
    return digest.hexdigest()


def _words(item: ProjectObject) -> Iterable[Any]:
    """The content as a sequence of texts that does not depend on ids; references are what their targets are and what these are of."""
    yield f"({item.kind}"
    for name, feature in features(item.kind).items():
        if name in _OTHERS or name not in item.values:
            continue
        value = item.values[name]
        if feature.kind is FeatureKind.CONTAINMENT:
            for part in value if feature.many else (value,):
                yield name
                yield from _words(part)
        elif feature.kind is FeatureKind.REFERENCE:
            targets = value if feature.many else (value,)
            yield f"{name}>{sorted(map(_target, targets))}" if targets else ""
        elif value != default_of(feature):
            yield f"{name}={value!r}"
    yield ")"


def _target(item: ProjectObject) -> str:
    # Trace events of different objects have the same names.
    owner = f"{item.owner.kind} {item.owner.name}" if item.owner is not None else ""
    return f"{owner}/{item.kind} {item.name}"
