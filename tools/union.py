"""The union of the AMALTHEA versions that the typed classes cover, computed from the facts."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from amalthea_uros.metamodel.factfile import FeatureKind
from amalthea_uros.metamodel.versions import facts, supported_versions

#: The enumeration lost its name to a class in 2.0.0.
RENAMED_ENUMS = {"Condition": "CombinatorialCondition"}

PYTHON_TYPES = {"EString": "str", "EBoolean": "bool"}
INTEGERS = {"EInt", "ELong", "EBigInteger", "EIntegerObject", "ELongObject", "Address"}


def snake_case(name: str) -> str:
    """`activityGraph` -> `activity_graph`, `executingPU` -> `executing_pu`."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", name).lower()


def constant_case(literal: str) -> str:
    """`immediateSuccessorEndSequence` -> `IMMEDIATE_SUCCESSOR_END_SEQUENCE`, but `MHz` -> `MHZ`."""
    bare = literal.strip("_")
    words = re.sub(r"(?<=[a-z])(?=[A-Z][a-z])", "_", bare).upper() if re.search("[a-z]{3}", bare) else bare.upper()
    return re.sub(r"(BIT|KBIT|MBIT|GBIT|TBIT|KIBIT|MIBIT|GIBIT|TIBIT|B)(?=PER_SECOND)", r"\1_", words)


@dataclass
class UnionFeature:
    """A feature with everything that any version declares of it."""

    name: str
    kinds: set[FeatureKind] = field(default_factory=set)
    types: dict[str, None] = field(default_factory=dict)
    many: bool = False
    versions: set[str] = field(default_factory=set)

    @property
    def python_name(self) -> str:
        return snake_case(self.name)

    @property
    def specifier(self) -> str:
        """The function of `features.py` that declares the feature."""
        if len(self.kinds) > 1:
            return "containment_or_reference"
        kind = next(iter(self.kinds))
        if kind is FeatureKind.ATTRIBUTE:
            return "attribute"
        return ("containment" if kind is FeatureKind.CONTAINMENT else "reference") + ("s" if self.many else "")


@dataclass
class UnionClass:
    """A class with everything that any version declares of it."""

    name: str
    module: str
    abstract: bool
    bases: list[str]
    features: dict[str, UnionFeature] = field(default_factory=dict)
    versions: set[str] = field(default_factory=set)


@dataclass
class Union:
    """All classes and enumerations of the versions held."""

    versions: tuple[str, ...]
    classes: dict[str, UnionClass]
    enums: dict[str, dict[str, None]]
    numbers: set[str]

    def ancestors(self, name: str) -> list[str]:
        """Everything a class inherits from, nearest first."""
        found: dict[str, None] = {}
        for base in self.classes[name].bases:
            found |= {base: None} | dict.fromkeys(self.ancestors(base))
        return list(found)

    def python_type(self, type_name: str) -> str:
        """The static type of a value of an Ecore type."""
        if type_name in self.classes or type_name in self.enums:
            return type_name
        if type_name in INTEGERS or (type_name in self.numbers and not type_name.endswith("Double")):
            return "int"
        return PYTHON_TYPES.get(type_name, "float")

    def annotation(self, feature: UnionFeature) -> str:
        """The static type of a feature."""
        types = " | ".join(dict.fromkeys(map(self.python_type, feature.types)))
        return f"list[{types}]" if feature.many else f"{types} | None"

    def version_note(self, present: set[str], among: set[str]) -> str:
        """The versions in which something exists, "" if in all in which its class exists."""
        if present >= among:
            return ""
        ordered = [v for v in self.versions if v in present]
        first, last = ordered[0], ordered[-1]
        if first == self.versions[0]:
            return f"until {last}"
        return f"since {first}" if last == self.versions[-1] else f"{first} to {last}"


def union() -> Union:
    """Merge the facts of all held versions, the newest first, so that its order and names lead."""
    versions = supported_versions()
    merged = Union(versions, {}, {}, set())
    for version in reversed(versions):
        declared = facts(version)
        merged.numbers |= set(declared.numbers)
        for name, enum in declared.enums.items():
            merged.enums.setdefault(RENAMED_ENUMS.get(name, name), {}).update(dict.fromkeys(enum.literals))
        for name, cls in declared.classes.items():
            found = merged.classes.setdefault(name, UnionClass(name, cls.module, cls.abstract, []))
            found.versions.add(version)
            found.bases += [base for base in cls.supertypes if base not in found.bases]
            for fact in cls.features:
                if not fact.stored:
                    continue
                feature = found.features.setdefault(fact.name, UnionFeature(fact.name))
                feature.kinds.add(fact.kind)
                is_enum = fact.type in declared.enums
                feature.types[RENAMED_ENUMS.get(fact.type, fact.type) if is_enum else fact.type] = None
                feature.many |= fact.many
                feature.versions.add(version)
    _drop_implied_bases(merged)
    _lift_inherited_features(merged)
    return merged


def _drop_implied_bases(merged: Union) -> None:
    for cls in merged.classes.values():
        cls.bases = [
            base for base in cls.bases if not any(base in merged.ancestors(other) for other in cls.bases if other != base)
        ]


def _lift_inherited_features(merged: Union) -> None:
    """A feature that moved to a supertype between versions is declared there only."""
    for cls in merged.classes.values():
        for name in list(cls.features):
            holder = next((a for a in merged.ancestors(cls.name) if name in merged.classes[a].features), None)
            if holder is None:
                continue
            moved, kept = cls.features.pop(name), merged.classes[holder].features[name]
            kept.kinds |= moved.kinds
            kept.types |= moved.types
            kept.many |= moved.many
            kept.versions |= moved.versions
