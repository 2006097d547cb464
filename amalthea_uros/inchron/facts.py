"""The declarations of the INCHRON metamodel, in the form of the facts of AMALTHEA versions (`facts.txt`)."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from amalthea_uros.metamodel.factfile import ClassFact, EnumFact, FeatureFact, blocks
from amalthea_uros.metamodel.versions import VersionFacts

VERSION = "3.5.0"

#: The namespace of the package `root`; those of the others begin with it.
NAMESPACE = f"http://inchron.com/realtime/root/{VERSION}"

#: Where none is needed although the metamodel demands one: the importer of INCHRON lowers these bounds, too, before it writes
#: (am2inc, Application.cpp).
OPTIONAL = {
    ("Cpu", "cores"),
    ("CpuCore", "initiator"),
    ("Condition", "conjunctions"),
    ("memory.Memory", "responder"),
    ("memory.CacheMemory", "responder"),
    ("memory.CacheMemory", "initiator"),
    ("memory.Interconnect", "initiators"),
    ("memory.Interconnect", "responders"),
}


@cache
def metamodel() -> VersionFacts:
    """The classes, enumerations and features."""
    text = Path(__file__).with_name("facts.txt").read_text(encoding="utf-8")
    declared = [block.fact() for block in blocks("inchron", text)]
    return VersionFacts(
        version=VERSION,
        classes={fact.name: fact for fact in declared if isinstance(fact, ClassFact)},
        enums={fact.name: fact for fact in declared if isinstance(fact, EnumFact)},
        numbers={},
    )


@cache
def features(kind: str) -> dict[str, FeatureFact]:
    """The features of a class that files hold, in the order of files."""
    return {feature.name: feature for feature in metamodel().features(kind) if not feature.derived}


@cache
def is_a(kind: str, wanted: str) -> bool:
    """Whether a class is another one or inherits from it."""
    return kind in metamodel().classes and wanted in metamodel().supertypes(kind)


@cache
def only_class(kind: str) -> str | None:
    """The only class whose objects a feature of a type can hold; None if there are several."""
    result = metamodel().concrete_subtypes(kind)
    return result[0] if len(result) == 1 else None


def package_of(kind: str) -> str:
    """The package of a class: "" for the main one, `memory` for `memory.Memory`, `fmi.unit` for `fmi.unit.Unit`."""
    return kind.rpartition(".")[0]


def namespace_of(package: str) -> str:
    """The XML namespace of a package."""
    if package == "root":
        return NAMESPACE
    return "/".join([NAMESPACE, "model", *filter(None, package.split("."))])


def prefix_of(package: str) -> str:
    """The prefix that stands for a package in files."""
    return package.rpartition(".")[2] or "model"
