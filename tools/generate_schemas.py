"""Generate `schemas/amalthea-<version>.xsd` from the facts, one schema for every version held.

A class that may stand where a containment feature declares another class has to derive from that class in the schema, and a
schema type derives from one type only. So the containment types above a class are put in one line: where AMALTHEA's multiple
inheritance leaves two of them side by side, one is put below the other, such that as few classes as possible become
acceptable in a place where they do not belong.

Usage: python tools/generate_schemas.py [TARGET]
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import NamedTuple

from templating import ROOT, templates

from amalthea_uros.metamodel.factfile import FeatureFact, FeatureKind, NumberFact
from amalthea_uros.metamodel.versions import VersionFacts, facts, supported_versions

TARGET = ROOT / "schemas"

#: What every type derives from; a reference by href is declared as such.
OBJECT = "Object"

#: The schema type of an Ecore data type where it does not have the same name as in the facts.
DATA_TYPES = {
    "EString": "xs:string",
    "EInt": "xs:int",
    "EIntegerObject": "xs:int",
    "ELong": "xs:long",
    "ELongObject": "xs:long",
    "EBigInteger": "xs:integer",
    "EDouble": "am:Double",
    "EDoubleObject": "am:Double",
    "EFloat": "am:Double",
}


class Declaration(NamedTuple):
    """An element or attribute of a schema type."""

    name: str
    type: str


@dataclass
class SchemaClass:
    """A class as a schema type: its base, what it adds to that and the elements it has from it."""

    name: str
    base: str
    abstract: bool
    elements: list[Declaration]
    attributes: list[Declaration]
    inherited: list[Declaration]


class Double(NamedTuple):
    """A number with a fraction, with or without lower limit."""

    name: str
    minimum: int | None = None
    exclusive: bool = False


def concrete(declared: VersionFacts) -> list[str]:
    """The names of the classes with instances."""
    return [name for name, cls in declared.classes.items() if not cls.abstract]


def base_lines(declared: VersionFacts) -> dict[str, set[str]]:
    """The types that each schema type derives from, such that those of a concrete class form one line."""
    features = (f for name in concrete(declared) for f in declared.features(name))
    containers = {f.type for f in features if f.kind is FeatureKind.CONTAINMENT} | set(concrete(declared))
    above = {name: set(declared.supertypes(name)) & containers - {name} for name in declared.classes if name in containers}
    while pair := side_by_side(above, concrete(declared)):
        below = {name: {n for n in concrete(declared) if name == n or name in above[n]} for name in pair}
        abstract = [name for name in pair if declared.classes[name].abstract]
        upper = min(abstract, key=lambda name: (len(set.union(*below.values()) - below[name]), name))
        lower = next(name for name in pair if name != upper)
        for name, bases in above.items():
            if name == lower or lower in bases:
                bases |= {upper} | above[upper]
    return above


def side_by_side(above: dict[str, set[str]], names: list[str]) -> tuple[str, str] | None:
    """Two types above one of the classes of which neither derives from the other."""
    for name in names:
        for one, other in combinations(sorted(above[name]), 2):
            if one not in above[other] and other not in above[one]:
                return one, other
    return None


def schema_classes(declared: VersionFacts) -> list[SchemaClass]:
    """The schema types of a version, in the order of the facts."""
    above = base_lines(declared)
    return [
        schema_class(declared, name, max(bases, key=lambda n: len(above[n]), default=OBJECT)) for name, bases in above.items()
    ]


def schema_class(declared: VersionFacts, name: str, base: str) -> SchemaClass:
    """One class as a schema type; abstract types are empty, so that they can be put in line."""
    abstract = declared.classes[name].abstract
    inherits = base != OBJECT and not declared.classes[base].abstract
    known = [f for f in declared.features(base) if f.stored] if inherits else []
    own = [] if abstract else [f for f in declared.features(name) if f.stored and f not in known]
    return SchemaClass(
        name=name,
        base=base,
        abstract=abstract,
        elements=elements(own),
        attributes=[Declaration(f.name, data_type(f)) for f in own if f.kind is not FeatureKind.CONTAINMENT],
        inherited=elements(known),
    )


def elements(features: list[FeatureFact]) -> list[Declaration]:
    """The features that may be written as child elements."""
    return [
        Declaration(f.name, f"am:{f.type if f.kind is FeatureKind.CONTAINMENT else OBJECT}")
        for f in features
        if f.kind is not FeatureKind.ATTRIBUTE
    ]


def data_type(feature: FeatureFact) -> str:
    """The schema type of a feature written as XML attribute: of references a list of ids."""
    if feature.kind is FeatureKind.REFERENCE:
        return "xs:string"
    return DATA_TYPES.get(feature.type, f"am:{feature.type}")


def limit(number: NumberFact | Double) -> str:
    """The facet of the lower limit."""
    return "minExclusive" if number.exclusive else "minInclusive"


def render(version: str) -> str:
    """The text of the schema of a version."""
    environment = templates()
    environment.filters["limit"] = limit
    declared = facts(version)
    numbers = [number for number in declared.numbers.values() if number.name != "Address"]
    doubles = [Double(n.name, n.minimum, n.exclusive) for n in numbers if n.java_type == "double"]
    return environment.get_template("metamodel/schema.xsd.jinja").render(
        version=version,
        namespace=declared.namespace,
        classes=schema_classes(declared),
        enums=declared.enums.values(),
        integers=[number for number in numbers if number.java_type != "double"],
        doubles=[Double("Double"), *doubles],
    )


def main(target: Path) -> None:
    target.mkdir(parents=True, exist_ok=True)
    for version in supported_versions():
        (target / f"amalthea-{version}.xsd").write_text(render(version), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else TARGET)
