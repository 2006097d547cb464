"""Objects of an INCHRON project: a class of the metamodel, and values of its features, checked against the facts."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Any

from amalthea_uros.inchron.facts import OPTIONAL, features, is_a, metamodel, only_class
from amalthea_uros.metamodel.factfile import FeatureFact, FeatureKind

#: Python types of attributes, by the types of the metamodel; literals of enumerations and everything else are texts.
NUMBERS: dict[str, type] = {
    "EInt": int,
    "ELong": int,
    "root.UInteger": int,
    "root.UnsignedLong": int,
    "EDouble": float,
    "EFloat": float,
    "EBoolean": bool,
}


class ProjectObject:
    """An object of a class of the INCHRON metamodel.

    Attributes
    ----------
    kind : the class, with its package unless that is the main one
    values : by feature; lists where there may be several
    owner : the object that contains it
    offset : where it begins in the text that it was read from, in bytes
    """

    __slots__ = ("kind", "offset", "owner", "values")

    def __init__(self, kind: str, /, **values: Any) -> None:
        """Make an object; values that are None are left out, and parts that every object of the class has are made empty."""
        self.kind = kind
        self.owner: ProjectObject | None = None
        self.offset = 0
        self.values: dict[str, Any] = {}
        for name, value in values.items():
            if value is not None:
                self[name] = value
        self._complete()

    def _complete(self) -> None:
        """Make the parts that the metamodel demands and that can be of one class only, as the importer of INCHRON does."""
        for name, feature in features(self.kind).items():
            if name not in self.values and feature.kind is FeatureKind.CONTAINMENT and feature.required and not feature.many:
                part = only_class(feature.type)
                if part and (self.kind, name) not in OPTIONAL:
                    self[name] = ProjectObject(part)

    def __repr__(self) -> str:
        return f"<{self.kind} {self.values.get('name', '')}>"

    def feature(self, name: str) -> FeatureFact:
        """The declaration of a feature.

        Raises
        ------
        KeyError : the class has no such feature.
        """
        return features(self.kind)[name]

    def __getitem__(self, name: str) -> Any:
        """The value of a feature, its default if there is none, a list if there may be several."""
        feature = self.feature(name)
        if feature.many:
            return self.values.get(name, [])
        return self.values[name] if name in self.values else default_of(feature)

    def __setitem__(self, name: str, value: Any) -> None:
        """Set a feature; parts get this object as their owner."""
        feature = self.feature(name)
        value = list(value) if feature.many else value
        if feature.kind is FeatureKind.CONTAINMENT:
            for part in value if feature.many else (value,):
                part.owner = self
        self.values[name] = value

    def add(self, name: str, part: ProjectObject) -> ProjectObject:
        """Append a part or a target to a feature."""
        if self.feature(name).kind is FeatureKind.CONTAINMENT:
            part.owner = self
        self.values.setdefault(name, []).append(part)
        return part

    @property
    def name(self) -> str:
        """The name, "" without."""
        return self.values.get("name") or ""

    def parts(self) -> Iterator[tuple[FeatureFact, ProjectObject]]:
        """The objects that this one contains, with their features, in the order of files."""
        for name, feature in features(self.kind).items():
            if feature.kind is FeatureKind.CONTAINMENT and name in self.values:
                value = self.values[name]
                for part in value if feature.many else (value,):
                    yield feature, part

    def walk(self) -> Iterator[ProjectObject]:
        """The object itself and all within it."""
        waiting = [self]
        while waiting:
            result = waiting.pop()
            yield result
            waiting += reversed([part for _, part in result.parts()])


def default_of(feature: FeatureFact) -> Any:
    """The value of a feature that is not stated; None if there is none."""
    text = metamodel().default(feature)
    return None if text is None else parsed(feature.type, text)


def parsed(type_name: str, text: str) -> Any:
    """The value of an attribute.

    Raises
    ------
    ValueError : the text is not one of the type.
    """
    if type_name in metamodel().enums:
        if text not in metamodel().enums[type_name].literals:
            raise ValueError(f"{text!r} is not one of {', '.join(metamodel().enums[type_name].literals)}")
        return text
    convert = NUMBERS.get(type_name, str)
    if convert is bool:
        if text not in ("true", "false"):
            raise ValueError(f"{text!r} is neither true nor false")
        return text == "true"
    if convert is int and (len(text) > 20 or not -(2**63) <= int(text) < 2**63):
        raise ValueError(f"{text[:40]!r} does not fit into 64 bits")
    if convert is float and not isfinite(float(text)):
        raise ValueError(f"{text[:40]!r} is not a finite number")
    return convert(text)


def problems(root: ProjectObject) -> Iterator[tuple[ProjectObject, str]]:
    """Violations of the metamodel in a project: objects, each with the reason."""
    for item in root.walk():
        for name, feature in features(item.kind).items():
            values = item[name] if feature.many else [] if item[name] is None else [item[name]]
            if len(values) < feature.lower and (item.kind, name) not in OPTIONAL:
                yield item, f"{name} is missing"
            if feature.kind is not FeatureKind.ATTRIBUTE:
                yield from ((item, f"{name} cannot be a {each.kind}") for each in values if not is_a(each.kind, feature.type))
            else:
                yield from ((item, f"{name} cannot be {each!r}") for each in values if not _is_valid(feature.type, each))


def _is_valid(type_name: str, value: Any) -> bool:
    if type_name in metamodel().enums:
        return value in metamodel().enums[type_name].literals
    if NUMBERS.get(type_name) is int:
        bits = 31 if type_name == "EInt" else 63
        return type(value) is int and -(2**bits) <= value < 2**bits
    return isinstance(value, NUMBERS.get(type_name, str))
