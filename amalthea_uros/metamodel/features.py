"""The features of the AMALTHEA classes: their declaration, and their values while they are unset."""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum
from functools import cache
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from amalthea_uros.metamodel.containment import ContainmentList, ReferenceList

if TYPE_CHECKING:
    from amalthea_uros.metamodel.element import Element

Unit = TypeVar("Unit", bound=StrEnum)
Number = TypeVar("Number", bound=float | None)

#: `either` is a containment in some versions and a reference in others (the data type of labels and channels).
FeatureKind = Literal["attribute", "reference", "containment", "either"]

_set = object.__setattr__


class ElementFeature:
    """One feature of a class; as a descriptor it gives the unset value."""

    __slots__ = ("kind", "many", "name", "xml_name")

    def __init__(self, xml_name: str, kind: FeatureKind, many: bool = False) -> None:
        self.name = ""
        self.xml_name = xml_name
        self.kind: FeatureKind = kind
        self.many = many

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name

    def __get__(self, instance: Element | None, owner: type) -> Any:
        if instance is None:
            return self
        if not self.many:
            return None
        empty: list[Any] = self.new_list(instance, ())
        _set(instance, self.name, empty)
        return empty

    def new_list(self, owner: Element, values: Iterable[Any]) -> list[Any]:
        """A list for the values of this feature."""
        return (ContainmentList if self.kind == "containment" else ReferenceList)(owner, values)

    def copied(self, owner: Element, values: Iterable[Any]) -> list[Any]:
        """A list for values whose container is the owner already."""
        found: list[Any] = self.new_list(owner, ())
        list.extend(found, values)
        return found

    def contains(self, value: object) -> bool:
        """Whether an object held by this feature is part of its holder."""
        if self.kind == "either":
            return not getattr(value, "is_referable", True)
        return self.kind == "containment"

    def __repr__(self) -> str:
        return f"<{self.kind} {self.xml_name}{' *' if self.many else ''}>"


# The generated classes call these five; their static type is the annotation of the feature.


def attribute(xml_name: str) -> Any:
    """A number, text, truth value or literal."""
    return ElementFeature(xml_name, "attribute")


def reference(xml_name: str) -> Any:
    """A reference to an object that is contained elsewhere."""
    return ElementFeature(xml_name, "reference")


def references(xml_name: str) -> Any:
    """Ordered references to objects that are contained elsewhere."""
    return ElementFeature(xml_name, "reference", many=True)


def containment(xml_name: str) -> Any:
    """A part of the object."""
    return ElementFeature(xml_name, "containment")


def containments(xml_name: str) -> Any:
    """Ordered parts of the object."""
    return ElementFeature(xml_name, "containment", many=True)


def containment_or_reference(xml_name: str) -> Any:
    """A part of the object in older versions, a reference in newer ones."""
    return ElementFeature(xml_name, "either")


_FEATURES: dict[type, dict[str, ElementFeature]] = {}
_CONTAINMENTS: dict[type, tuple[ElementFeature, ...]] = {}


def features_of(cls: type[Element]) -> dict[str, ElementFeature]:
    """All features of a class by their Python names, those of the supertypes first."""
    found = _FEATURES.get(cls)
    if found is None:
        found = {}
        for base in reversed(cls.__mro__):
            found.update(_own_features(base))
        _FEATURES[cls] = found
    return found


@cache
def _own_features(cls: type) -> dict[str, ElementFeature]:
    return {name: value for name, value in vars(cls).items() if isinstance(value, ElementFeature)}


def containments_of(cls: type[Element]) -> tuple[ElementFeature, ...]:
    """The features of a class that may contain parts."""
    found = _CONTAINMENTS.get(cls)
    if found is None:
        found = tuple(f for f in features_of(cls).values() if f.kind in ("containment", "either"))
        _CONTAINMENTS[cls] = found
    return found


# Units of the quantities are given by name: `Time(10, "ms")`


def number_of(given: Number) -> Number:
    """The number of a quantity.

    Raises
    ------
    TypeError : a text was given, such as "2 ms".
    """
    if isinstance(given, str):
        raise TypeError(f"expected a number and a unit, e.g. Time(2, 'ms'), not the text {given!r}; parse_time() reads texts")
    return given


def unit_of(units: type[Unit], given: Unit | str | None) -> Unit | None:
    """The unit of that name.

    Raises
    ------
    ValueError : no such unit; the text lists those that exist.
    """
    try:
        return None if given is None else units(given)
    except ValueError:
        known = ", ".join(unit.value for unit in units if unit.name != "UNDEFINED")
        raise ValueError(f"unknown unit {given!r}, expected one of {known}") from None
