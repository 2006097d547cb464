"""AMALTHEA versions and what each of them declares.

`facts(version)` answers for one version: classes, features in the order of their serialisation, defaults, literals.
"""

from __future__ import annotations

from functools import cache, cached_property
from pathlib import Path

from amalthea_uros._internal.records import dataclass
from amalthea_uros.metamodel.factfile import ClassFact, EnumFact, FactBlock, FeatureFact, FeatureKind, NumberFact, blocks

_FACTS = Path(__file__).with_name("facts")

NAMESPACE_PREFIX = "http://app4mc.eclipse.org/amalthea/"

#: The oldest version whose models are represented without conversion; older ones have another structure.
OLDEST_SUPPORTED = "0.9.7"

#: Value of an unset attribute without a default literal, by Ecore type: that of the Java primitive, or none.
_JAVA_DEFAULTS = {
    "EInt": "0",
    "ELong": "0",
    "EDouble": "0.0",
    "EFloat": "0.0",
    "EBoolean": "false",
    "Address": "0",
}


def spelled(version: str) -> str:
    """A version in a sentence: "AMALTHEA 0.7.2"; those of the ITEA project, which came before APP4MC, are "ITEA 1.3.0"."""
    return version if version.startswith("ITEA ") else f"AMALTHEA {version}"


@cache
def version_key(version: str) -> tuple[int, ...]:
    """Sort key of a version such as "0.9.7"."""
    return tuple(map(int, version.split(".")))


@cache
def _blocks() -> tuple[FactBlock, ...]:
    paths = sorted(path for path in _FACTS.iterdir() if path.name != "versions.txt")
    return tuple(block for path in paths for block in blocks(path.stem, path.read_text(encoding="utf-8")))


@cache
def known_versions() -> tuple[str, ...]:
    """Every version with facts, oldest first."""
    return tuple((_FACTS / "versions.txt").read_text(encoding="utf-8").split())


def supported_versions() -> tuple[str, ...]:
    """The versions that the typed classes cover, oldest first."""
    return tuple(v for v in known_versions() if version_key(v) >= version_key(OLDEST_SUPPORTED))


def newest_version() -> str:
    """The newest version with facts."""
    return known_versions()[-1]


def nearest_version(version: str) -> str:
    """The version whose facts serve for `version`: itself, else the next older known one, else the oldest."""
    older = [v for v in known_versions() if version_key(v) <= version_key(version)]
    return older[-1] if older else known_versions()[0]


def _holds(block: FactBlock, version: str) -> bool:
    key = version_key(version)
    return not block.ranges or any(
        version_key(first) <= key and (last is None or key <= version_key(last)) for first, last in block.ranges
    )


@dataclass(frozen=True)
class VersionFacts:
    """What one AMALTHEA version declares.

    Attributes
    ----------
    version : "0.9.3" ... "3.3.0"
    classes, enums, numbers : declarations by name, in declaration order within a sub-model
    """

    version: str
    classes: dict[str, ClassFact]
    enums: dict[str, EnumFact]
    numbers: dict[str, NumberFact]

    @property
    def namespace(self) -> str:
        """The XML namespace of the version."""
        return NAMESPACE_PREFIX + self.version

    @cached_property
    def _features(self) -> dict[str, tuple[FeatureFact, ...]]:
        return {}

    def features(self, class_name: str) -> tuple[FeatureFact, ...]:
        """All features of a class in EMF's order: those of the supertypes first, depth first, each once; then its own."""
        known = self._features.get(class_name)
        if known is None:
            fact = self.classes[class_name]
            merged = {f.name: f for supertype in fact.supertypes for f in self.features(supertype)}
            known = tuple((merged | {f.name: f for f in fact.features}).values())
            self._features[class_name] = known
        return known

    def feature(self, class_name: str, feature_name: str) -> FeatureFact | None:
        """A feature by the names of the file format, None if the version has no such class or feature."""
        if class_name not in self.classes:
            return None
        return next((f for f in self.features(class_name) if f.name == feature_name), None)

    @cached_property
    def _supertypes(self) -> dict[str, frozenset[str]]:
        return {}

    def supertypes(self, class_name: str) -> frozenset[str]:
        """The class itself and everything it inherits from."""
        known = self._supertypes.get(class_name)
        if known is None:
            inherited = map(self.supertypes, self.classes[class_name].supertypes)
            known = self._supertypes[class_name] = frozenset({class_name}.union(*inherited))
        return known

    def concrete_subtypes(self, class_name: str) -> tuple[str, ...]:
        """Every class whose objects are allowed where `class_name` is declared."""
        return tuple(n for n, c in self.classes.items() if not c.abstract and class_name in self.supertypes(n))

    def default(self, feature: FeatureFact) -> str | None:
        """The default value of an attribute as text, None if it has none."""
        if feature.kind is not FeatureKind.ATTRIBUTE:
            return None
        if feature.default is not None:
            return feature.default
        if feature.type in self.enums:
            return self.enums[feature.type].literals[0]
        return _JAVA_DEFAULTS.get(feature.type)


@cache
def facts(version: str) -> VersionFacts:
    """What `version` declares.

    Raises
    ------
    KeyError : if there are no facts of that version; see `nearest_version`.
    """
    if version not in known_versions():
        raise KeyError(version)
    declared = [block.fact() for block in _blocks() if _holds(block, version)]
    return VersionFacts(
        version=version,
        classes={fact.name: fact for fact in declared if isinstance(fact, ClassFact)},
        enums={fact.name: fact for fact in declared if isinstance(fact, EnumFact)},
        numbers={fact.name: fact for fact in declared if isinstance(fact, NumberFact)},
    )
