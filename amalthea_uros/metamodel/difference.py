"""The difference of two models by meaning.

Objects that can be referred to are matched by unique name, wherever they stand; the parts of matched objects by key or name where
they have one, else by what they say, in order. Layout, spelling, defaults written or not, and the division into files mean nothing.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from enum import StrEnum
from typing import Any

from amalthea_uros.metamodel.classes import Quantity
from amalthea_uros.metamodel.classes.base import Amalthea
from amalthea_uros.metamodel.containment import path_of
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.features import Feature, features_of
from amalthea_uros.metamodel.fingerprint import Fingerprints
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.naming import unique_name

#: Features by which parts without a unique name are told apart, if they have one of them.
_KEYS = ("key", "name", "task", "isr", "entity", "abstract_element")

Group = Sequence[Element]
Pair = tuple[Element, Element]


class ChangeKind(StrEnum):
    """What happened to an object."""

    ADDED = "added"
    REMOVED = "removed"
    CHANGED = "changed"
    MOVED = "moved"


@dataclass(frozen=True)
class Change:
    """One difference.

    Attributes
    ----------
    object_class, object_name : class and qualified name of the object (of the new one, if there is one)
    feature : the feature that changed, by its XML name; "" for an object that came or went
    old, new : what it said, as text; "" for nothing
    old_element, new_element : the object in each model, None where it is not
    """

    kind: ChangeKind
    object_class: str
    object_name: str
    feature: str
    old: str
    new: str
    old_element: Element | None
    new_element: Element | None


def difference(old: Model, new: Model) -> list[Change]:
    """Everything in which two models differ, in the order of the new one, then of the old one."""
    comparison = _Comparison(old, new)
    return [*comparison.versions(), *comparison.matched(), *comparison.gone_and_come()]


class _Comparison:
    def __init__(self, old: Model, new: Model) -> None:
        self.old, self.new = old, new
        self.old_names, self.new_names = _by_name(old), _by_name(new)
        #: The other one of every matched object that can be referred to, by the old one and by the new one.
        self.new_of: dict[Element, Element] = {}
        #: Objects told to have come or gone; their parts are told with them.
        self.told: set[Element] = set()
        self.old_of: dict[Element, Element] = {}
        for name, elements in self.old_names.items():
            for one, other in zip(elements, self.new_names.get(name, ()), strict=False):
                self.pair(one, other)
        versions = (old.documents[0].facts_version, new.documents[0].facts_version)
        self.renamed = self.find_renamed(*(Fingerprints(version, {}) for version in versions))
        respelled = {unique_name(one): unique_name(other) for one, other in self.renamed}
        self.old_prints, self.new_prints = Fingerprints(versions[0], respelled), Fingerprints(versions[1], {})

    def pair(self, one: Element, other: Element) -> None:
        self.new_of[one], self.old_of[other] = other, one

    def find_renamed(self, old_prints: Fingerprints, new_prints: Fingerprints) -> list[Pair]:
        """Objects that went and came under another name with the same content; only where there is no doubt."""
        gone = [element for element in _elements(self.old_names) if element not in self.new_of]
        come = [element for element in _elements(self.new_names) if element not in self.old_of]
        old_by, new_by = _by(old_prints.without_name, gone), _by(new_prints.without_name, come)
        found = []
        for content, ones in old_by.items():
            others = new_by.get(content, [])
            if len(ones) == len(others) == 1 and type(ones[0]) is type(others[0]):
                self.pair(ones[0], others[0])
                found.append((ones[0], others[0]))
        return found + [pair for one, other in found for pair in self.pair_parts(one, other)]

    def pair_parts(self, one: Element, other: Element) -> Iterator[Pair]:
        """The referable parts of a renamed object, whose unique names changed with it."""
        parts = {(type(p), getattr(p, "name", None)): p for p in other.walk() if p.is_referable and p not in self.old_of}
        for part in one.walk():
            match = parts.get((type(part), getattr(part, "name", None))) if part not in self.new_of else None
            if match is not None:
                self.pair(part, match)
                yield part, match

    # What is told

    def versions(self) -> Iterator[Change]:
        old, new = (", ".join(dict.fromkeys(d.version for d in model.documents)) for model in (self.old, self.new))
        if old != new:
            one, other = self.old.documents[0].root, self.new.documents[0].root
            yield Change(ChangeKind.CHANGED, "Amalthea", "Amalthea", "version", old, new, one, other)

    def matched(self) -> Iterator[Change]:
        yield from self.compare(_roots(self.old), _roots(self.new))
        for other in self.new.walk():
            one = self.old_of.get(other)
            if one is not None:
                if self.is_moved(one, other):
                    yield _change(ChangeKind.MOVED, "", _home(one), _home(other), one, other)
                yield from self.compare([one], [other])

    def gone_and_come(self) -> Iterator[Change]:
        for element in _elements(self.old_names):
            if element not in self.new_of and self.told.isdisjoint(path_of(element)):
                yield self.removed(element)
        for element in _elements(self.new_names):
            if element not in self.old_of and self.told.isdisjoint(path_of(element)):
                yield self.added(element)

    def removed(self, element: Element) -> Change:
        self.told.add(element)
        return _change(ChangeKind.REMOVED, "", _parts(element), "", element, None)

    def added(self, element: Element) -> Change:
        self.told.add(element)
        return _change(ChangeKind.ADDED, "", "", _parts(element), None, element)

    def is_moved(self, one: Element, other: Element) -> bool:
        """Whether the object is part of another object than before; sub-models of several files are the same one."""
        old_home, new_home = one.container, other.container
        if old_home is None or new_home is None:
            return False
        if old_home.is_referable and new_home.is_referable:
            return self.new_of.get(old_home) is not new_home
        return type(old_home) is not type(new_home)

    # Objects that were matched

    def compare(self, ones: Group, others: Group) -> Iterator[Change]:
        """The differences of two objects; of several where the parts of one object are spread over files."""
        one, other = ones[0], others[0]
        for feature in features_of(type(other)).values():
            if feature.kind == "attribute":
                yield from self.compare_attribute(feature, one, other)
                continue
            old, new = _values(feature, ones), _values(feature, others)
            if old or new:
                yield from self.compare_values(feature, one, other, old, new)
        old_text, new_text = _extras(one), _extras(other)
        if old_text != new_text:
            yield _change(ChangeKind.CHANGED, "unknown content", old_text, new_text, one, other)

    def compare_attribute(self, feature: Feature, one: Element, other: Element) -> Iterator[Change]:
        if feature.name == "name" and one.is_referable and unique_name(one) != unique_name(other) and one.name == other.name:  # type: ignore[attr-defined]
            return
        old = self.old_prints.attributes(one).get(feature.name)
        new = self.new_prints.attributes(other).get(feature.name)
        if old != new:
            yield _change(ChangeKind.CHANGED, feature.xml_name, _text(old), _text(new), one, other)

    def compare_values(self, feature: Feature, one: Element, other: Element, old: Group, new: Group) -> Iterator[Change]:
        old_parts, new_parts = ([v for v in values if feature.contains(v)] for values in (old, new))
        old_targets = [self.old_prints.target(v) for v in old if not feature.contains(v)]
        new_targets = [self.new_prints.target(v) for v in new if not feature.contains(v)]
        if old_targets != new_targets:
            texts = _list_texts(old_targets, new_targets)
            yield _change(ChangeKind.CHANGED, feature.xml_name, *texts, one, other)
        if isinstance(other, Amalthea) and not feature.many:
            # An empty sub-model says as little as none at all.
            yield from self.compare(old_parts or [type(new_parts[0])()], new_parts or [type(old_parts[0])()])
            return
        old_parts, new_parts = ([p for p in parts if not p.is_referable] for parts in (old_parts, new_parts))
        if any(isinstance(part, Quantity) for part in (*old_parts, *new_parts)) and not feature.many:
            old_text, new_text = ", ".join(map(_text, old_parts)), ", ".join(map(_text, new_parts))
            if old_text != new_text:
                yield _change(ChangeKind.CHANGED, feature.xml_name, old_text, new_text, one, other)
            return
        yield from self.compare_parts(feature, one, other, old_parts, new_parts)

    def compare_parts(self, feature: Feature, one: Element, other: Element, old: Group, new: Group) -> Iterator[Change]:
        """The parts that have no unique name."""
        pairs, gone, come = self.align(old, new)
        moved = Counter(map(self.old_prints.of, gone)) & Counter(map(self.new_prints.of, come))
        if moved:
            text = f"{sum(moved.values())} of {len(new)} in another order"
            yield _change(ChangeKind.CHANGED, feature.xml_name, "", text, one, other)
        for part in _without(gone, moved, self.old_prints):
            yield self.removed(part)
        for part in _without(come, moved, self.new_prints):
            yield self.added(part)
        for old_part, new_part in pairs:
            yield from self.compare([old_part], [new_part])

    def align(self, old: Group, new: Group) -> tuple[list[Pair], list[Element], list[Element]]:
        """Which parts correspond but differ, which went and which came."""
        old_keys, new_keys = _keys(old), _keys(new)
        if old_keys and new_keys and len(set(old_keys)) == len(old) and len(set(new_keys)) == len(new):
            others = dict(zip(new_keys, new, strict=True))
            pairs = [(part, others.pop(key)) for key, part in zip(old_keys, old, strict=True) if key in others]
            matched = {one for one, _ in pairs}
            return pairs, [part for part in old if part not in matched], list(others.values())
        old_prints, new_prints = [self.old_prints.of(p) for p in old], [self.new_prints.of(p) for p in new]
        if old_prints == new_prints:
            return [], [], []
        pairs, gone, come = [], [], []
        for tag, i, j, k, m in SequenceMatcher(None, old_prints, new_prints, autojunk=False).get_opcodes():
            if tag == "equal":
                continue
            rest = list(new[k:m])
            for part in old[i:j]:
                match = next((p for p in rest if type(p) is type(part)), None)
                if match is None:
                    gone.append(part)
                else:
                    rest.remove(match)
                    pairs.append((part, match))
            come += rest
        return pairs, gone, come


def _by_name(model: Model) -> dict[str, list[Element]]:
    return _by(unique_name, (element for element in model.walk() if element.is_referable))


def _by(key: Any, elements: Iterable[Element]) -> dict[Any, list[Element]]:
    found: dict[Any, list[Element]] = {}
    for element in elements:
        found.setdefault(key(element), []).append(element)
    return found


def _elements(names: dict[str, list[Element]]) -> Iterator[Element]:
    for elements in names.values():
        yield from elements


def _roots(model: Model) -> list[Element]:
    return [document.root for document in model.documents]


def _values(feature: Feature, group: Group) -> list[Element]:
    found: list[Element] = []
    for element in group:
        value = element.__dict__.get(feature.name)
        if isinstance(value, list):
            found += value
        elif value is not None:
            found.append(value)
    return found


def _keys(parts: Group) -> list[Any]:
    """What sets apart named parts, entries of maps, and allocations of different objects; [] if there is nothing of the kind."""
    found = []
    for part in parts:
        key = next((value for name in _KEYS if (value := part.__dict__.get(name))), None)
        if not key:
            return []
        found.append((type(part), unique_name(key) if isinstance(key, Element) else key))
    return found


def _without(parts: list[Element], moved: Counter[int], prints: Fingerprints) -> Iterator[Element]:
    left = Counter(moved)
    for part in parts:
        if left[prints.of(part)] > 0:
            left[prints.of(part)] -= 1
        else:
            yield part


# Words


def _change(kind: ChangeKind, feature: str, old: str, new: str, one: Element | None, other: Element | None) -> Change:
    element = other if other is not None else one
    assert element is not None
    return Change(kind, type(element).__name__, element.qualified_name, feature, old, new, one, other)


def _text(value: Any) -> str:
    """A value for people: `10 ms`, `preemptive`, `true`."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Quantity):
        from amalthea_uros.metamodel.summary import quantity

        return quantity(value)
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _parts(element: Element) -> str:
    number = sum(1 for _ in element.walk()) - 1
    return f"with {number} part{'s' if number != 1 else ''}" if number else ""


def _home(element: Element) -> str:
    return element.container.qualified_name if element.container is not None else ""


def _extras(element: Element) -> str:
    extras = element.__dict__.get("_extras")
    if extras is None:
        return ""
    attributes = [f'{name}="{value}"' for name, value in sorted(extras.attributes.items())]
    return " ".join([*attributes, *(raw for _, raw in extras.content)])


def _list_texts(old: list[str], new: list[str]) -> tuple[str, str]:
    """Two lists of unique names, shortened to what differs if they are long."""
    if max(len(old), len(new)) <= 3:
        return ", ".join(map(_readable, old)), ", ".join(map(_readable, new))
    gone, come = Counter(old) - Counter(new), Counter(new) - Counter(old)
    if not gone and not come:
        return f"{len(old)} references", "the same in another order"
    return ", ".join(f"-{_readable(name)}" for name in gone), ", ".join(f"+{_readable(name)}" for name in come)


def _readable(name: str) -> str:
    from amalthea_uros.metamodel.naming import decode

    return decode(name.partition("?type=")[0])
