"""The features of a class in an AMALTHEA version, by their Python names."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.factfile import FeatureFact
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.versions import facts

T = TypeVar("T")


def per_class(find: Callable[[type[Element], str], T]) -> Callable[[type[Element], str], T]:
    """Cache the result of a function by class and version; it is called for each object."""
    known: dict[tuple[type[Element], str], T] = {}

    def found(cls: type[Element], version: str) -> T:
        if (cls, version) not in known:
            known[cls, version] = find(cls, version)
        return known[cls, version]

    return found


def stored_features(cls: type[Element], version: str) -> dict[str, FeatureFact]:
    """The features of a class that files of a version contain, in the order in which EMF writes them."""
    declared = facts(version)
    names = {feature.xml_name: name for name, feature in features_of(cls).items()}
    stored = declared.features(cls.__name__) if cls.__name__ in declared.classes else ()
    return {names[fact.name]: fact for fact in stored if fact.stored}
