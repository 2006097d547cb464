"""What the facts of a version say of the features of a class, under their Python names."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.factfile import FeatureFact
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.versions import facts

T = TypeVar("T")


def per_class(find: Callable[[type[Element], str], T]) -> Callable[[type[Element], str], T]:
    """Remember what a function finds for a class and a version: it is asked for each object."""
    known: dict[tuple[type[Element], str], T] = {}

    def found(cls: type[Element], version: str) -> T:
        if (cls, version) not in known:
            known[cls, version] = find(cls, version)
        return known[cls, version]

    return found


def stored_features(cls: type[Element], version: str) -> dict[str, FeatureFact]:
    """The features of a class that stand in files of a version."""
    declared = facts(version)
    found = {name: declared.feature(cls.__name__, feature.xml_name) for name, feature in features_of(cls).items()}
    return {name: fact for name, fact in found.items() if fact is not None and fact.stored}
