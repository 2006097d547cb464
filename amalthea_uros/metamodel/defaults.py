"""The values of unset attributes; they depend on the AMALTHEA version."""

from __future__ import annotations

from enum import StrEnum
from typing import Any

from amalthea_uros.metamodel import classes
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.versions import VersionFacts, facts, nearest_version, newest_version

#: The enumeration lost its name to a class in 2.0.0.
_RENAMED_ENUMS = {"Condition": "CombinatorialCondition"}

_FLOATS = {"EDouble", "EDoubleObject", "EFloat", "PositiveDouble", "NonNegativeDouble"}


def enum_class(name: str) -> type[StrEnum]:
    """The enumeration of that name in the facts."""
    found: type[StrEnum] = getattr(classes, _RENAMED_ENUMS.get(name, name))
    return found


def defaults_of(version: str, cls: type[Element]) -> dict[str, Any]:
    """The default values of the attributes of a class in a version with facts, by Python name; attributes without one are left out."""
    found = _DEFAULTS.get((version, cls))
    if found is None:
        declared = facts(version)
        found = _DEFAULTS[version, cls] = {}
        for name, feature in features_of(cls).items():
            value = default_value(declared, cls.__name__, feature.xml_name)
            if value is not None:
                found[name] = value
    return found


_DEFAULTS: dict[tuple[str, type[Element]], dict[str, Any]] = {}


def default_value(declared: VersionFacts, class_name: str, feature_name: str) -> Any:
    """The default of an attribute (names as in files) in one version; None if there is none."""
    feature = declared.feature(class_name, feature_name)
    text = declared.default(feature) if feature else None
    if feature is None or text is None:
        return None
    if feature.type in declared.enums:
        return enum_class(feature.type)(text)
    if feature.type == "EString":
        return text
    if feature.type == "EBoolean":
        return text == "true"
    return float(text) if feature.type in _FLOATS else int(text)


def effective(element: Element, feature_name: str) -> Any:
    """See `Element.effective`."""
    value = getattr(element, feature_name)
    if value is not None:
        return value
    document = element.document
    version = nearest_version(document.version) if document else newest_version()
    return defaults_of(version, type(element)).get(feature_name)
