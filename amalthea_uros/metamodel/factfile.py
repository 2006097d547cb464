"""Reader of the facts files: what each AMALTHEA version declares, as text.

A facts file is a sequence of blocks separated by blank lines::

    class EnumMode : Mode @ 0.9.4..            class, its kind, supertypes, the versions for which the block holds
      literals   <> ModeLiteral * opposite containingMode       contains many
      entity     -> Label 1                                      refers to exactly one
      ordered    EBoolean = "true"                               attribute with an explicit default literal

    enum ISRCategory                           literals, the first one is the default
      _undefined_
      CATEGORY_1

    datatype PositiveInt int minExclusive 0    a restricted number

Class kinds are `abstract`, `interface` (both without instances) and `entry` (an Ecore map entry with key and value). A feature
is optional unless its multiplicity says `1`, `*` or `1..*`; `derived` features are computed and never stored, `readonly` ones
mirror the containment named by `opposite`. The order of the features is the order of their serialisation.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from enum import Enum
from functools import cache
from typing import NamedTuple

from amalthea_uros._internal.records import dataclass


class FeatureKind(Enum):
    """The kind of a feature."""

    ATTRIBUTE = ""
    CONTAINMENT = "<>"
    REFERENCE = "->"


_KINDS = {kind.value: kind for kind in FeatureKind}


class FeatureFact(NamedTuple):
    """What one version declares of one feature, under the names of the file format.

    Attributes
    ----------
    lower, upper : the minimum and maximum number of values, None: unlimited
    """

    name: str
    kind: FeatureKind
    type: str
    lower: int = 0
    upper: int | None = 1
    derived: bool = False
    readonly: bool = False
    default: str | None = None
    opposite: str | None = None

    @property
    def required(self) -> bool:
        """Whether there has to be a value."""
        return self.lower > 0

    @property
    def many(self) -> bool:
        """Whether there may be several values."""
        return self.upper != 1

    @property
    def stored(self) -> bool:
        """Whether the feature is written to files; a reference with an opposite mirrors a containment and is not."""
        mirrors = self.kind is FeatureKind.REFERENCE and self.opposite is not None
        return not self.derived and not self.readonly and not mirrors


@dataclass(frozen=True, slots=True)
class ClassFact:
    """What one version declares of one class: its own features only.

    Attributes
    ----------
    lines : the declarations of the features
    """

    name: str
    module: str
    abstract: bool
    entry: bool
    supertypes: tuple[str, ...]
    lines: tuple[str, ...]

    @property
    def features(self) -> tuple[FeatureFact, ...]:
        """The features (parsed when asked for: most models use few classes)."""
        return _features(self.lines)


@dataclass(frozen=True, slots=True)
class EnumFact:
    """An enumeration; its first literal is the default of every attribute of that type."""

    name: str
    literals: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class NumberFact:
    """A number type with a lower limit."""

    name: str
    java_type: str
    minimum: int
    exclusive: bool


Fact = ClassFact | EnumFact | NumberFact


@dataclass(frozen=True, slots=True)
class FactBlock:
    """The text of a fact and the (first, last) versions for which it is valid; no ranges means always."""

    module: str
    text: str
    ranges: tuple[tuple[str, str | None], ...]

    def fact(self) -> Fact:
        """The declaration (parsed when asked for: a version needs half of the blocks)."""
        head, *body = self.text.split("\n")
        return _fact(self.module, head.partition(" @ ")[0].split(), body)


def blocks(module: str, text: str) -> Iterable[FactBlock]:
    """Blocks of one facts file, in its order."""
    for chunk in text.strip().split("\n\n"):
        _, _, versions = chunk.partition("\n")[0].partition(" @ ")
        yield FactBlock(module, chunk, _ranges(versions))


def _ranges(text: str) -> tuple[tuple[str, str | None], ...]:
    found: list[tuple[str, str | None]] = []
    for item in text.split():
        first, dots, last = item.partition("..")
        found.append((first, (last or None) if dots else first))
    return tuple(found)


def _fact(module: str, words: list[str], body: list[str]) -> Fact:
    match words:
        case ["class", name, *rest]:
            split = rest.index(":") if ":" in rest else len(rest)
            return ClassFact(
                name=name,
                module=module,
                abstract="abstract" in rest[:split] or "interface" in rest[:split],
                entry="entry" in rest[:split],
                supertypes=tuple(rest[split + 1 :]),
                lines=tuple(body),
            )
        case ["enum", name]:
            return EnumFact(name, tuple(line.strip() for line in body))
        case ["datatype", name, java_type, facet, limit]:
            return NumberFact(name, java_type, int(limit), exclusive=facet == "minExclusive")
    raise ValueError(f"facts file {module}: not a declaration: {' '.join(words)}")


@cache
def _features(lines: tuple[str, ...]) -> tuple[FeatureFact, ...]:
    return tuple(map(_feature, lines))


def _feature(line: str) -> FeatureFact:
    declaration, _, default = line.partition(" = ")
    name, *words = declaration.split()
    kind = _KINDS.get(words[0], FeatureKind.ATTRIBUTE)
    type_name, *flags = words if kind is FeatureKind.ATTRIBUTE else words[1:]
    if not flags and not default:
        return FeatureFact(name, kind, type_name)
    bounds = next((flag for flag in flags if _BOUNDS.fullmatch(flag)), "")
    lower, upper = _bounds(bounds)
    return FeatureFact(
        name=name,
        kind=kind,
        type=type_name,
        lower=lower,
        upper=upper,
        derived="derived" in flags,
        readonly="readonly" in flags,
        default=json.loads(default) if default else None,
        opposite=flags[flags.index("opposite") + 1] if "opposite" in flags else None,
    )


#: How many values a feature takes: "1", "*", "1..*", "2..2".
_BOUNDS = re.compile(r"(?:\d+\.\.)?(?:\d+|\*)")


def _bounds(text: str) -> tuple[int, int | None]:
    """The minimum and maximum number of values; an upper bound alone does not imply a lower one, but 1 means exactly one."""
    if not text:
        return 0, 1
    lower, _, upper = text.rpartition("..")
    return int(lower or upper == "1"), None if upper == "*" else int(upper)
