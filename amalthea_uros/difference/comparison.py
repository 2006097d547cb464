"""Two models compared by meaning.

Objects are the same if their unique names are, regardless of their position; parts without a unique name are matched within their
containers. What has no meaning is not compared: files, ids, spelling, the order of unordered parts, attributes with their default
value.
"""

from __future__ import annotations

from collections import Counter
from enum import StrEnum
from typing import TYPE_CHECKING, Any

from amalthea_uros._internal.garbage import paused_garbage_collection
from amalthea_uros._internal.records import dataclass
from amalthea_uros.difference.fingerprint import Fingerprints, UnsetAttributes, is_sequence, unknown_content
from amalthea_uros.difference.matching import ElementMatching
from amalthea_uros.difference.names import (
    UNSET,
    ElementNames,
    has_identity,
    is_inline,
    label,
    readable_name,
    shortened,
    value_text,
)
from amalthea_uros.difference.parts import PartsMatcher, Side, increasing
from amalthea_uros.metamodel.classes_base import Amalthea
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.features import ElementFeature, features_of
from amalthea_uros.metamodel.naming import name_of

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterable, Iterator, Sequence

    from amalthea_uros.metamodel.model import Model

#: The feature of the change that is another AMALTHEA version.
VERSION_FEATURE = "AMALTHEA version"

#: Further names of a list are only counted.
_MAX_NAMES = 5

#: Two objects that exchange their names are two changes.
_SHORTEST_EXCHANGE = 2

Elements = tuple[Element, ...]


class ChangeKind(StrEnum):
    """What happened to an object."""

    ADDED = "added"
    REMOVED = "removed"
    CHANGED = "changed"
    MOVED = "moved"


@dataclass(frozen=True, slots=True)
class ModelChange:
    """One difference.

    Attributes
    ----------
    class_name, qualified_name : the object; for a removed one as in the old model, else as in the new one
    feature : the name in files of the feature that changed, or that contains a moved object; "" for added and removed objects
    old, new : the values as text; of a list what was removed, and what was added or reordered; of an object without unique
        name its label
    old_element, new_element : the object in the two models, None where it is absent
    """

    kind: ChangeKind
    class_name: str
    qualified_name: str
    feature: str
    old: str
    new: str
    old_element: Element | None
    new_element: Element | None


def difference(old: Model, new: Model) -> list[ModelChange]:
    """The differences in meaning, in the order of the new model; a removed object has the position of its container."""
    with paused_garbage_collection():
        changes = _ModelComparison(old, new).changes()
        if len(changes) <= _SHORTEST_EXCHANGE:
            return changes
        # Where names were exchanged, as in a swap, the same content under other names is the shorter description.
        return min(changes, _ModelComparison(old, new, by_content=True).changes(), key=len)


class _ModelComparison:
    def __init__(self, old: Model, new: Model, by_content: bool = False) -> None:
        self.models = old, new
        unset_attributes = UnsetAttributes([*old.documents, *new.documents])
        self.unset_attributes = unset_attributes
        self.old_names, self.new_names = ElementNames(old), ElementNames(new)
        self.matching = ElementMatching(self.old_names, self.new_names, unset_attributes, by_content)
        numbers: dict[Hashable, int] = {}
        self.old = Side(self.old_names, Fingerprints(unset_attributes, self.old_names.token, numbers))
        self.new = Side(self.new_names, Fingerprints(unset_attributes, self.new_names.token, numbers))
        #: Old objects -> where they are now.
        self.counterparts: dict[Element, Element] = dict(self.matching.pairs)
        #: Objects without counterpart; their parts were added or removed with them.
        self.unmatched: set[Element] = {*self.matching.removed, *self.matching.added}
        self.found: list[ModelChange] = []

    def changes(self) -> list[ModelChange]:
        self.versions()
        self.features(*(tuple(document.root for document in model.documents) for model in self.models))
        for old, new in self.matching.pairs:
            self.pair(old, new)
        for old, new in self.matching.pairs:
            self.owner(old, new)
        for removed in self.matching.removed:
            if not self.has_unmatched_container(removed):
                self.remove(removed)
        for added in self.matching.added:
            if not self.has_unmatched_container(added):
                self.add(added)
        return sorted(self.found, key=self.place)

    # Results

    def change(self, old: Element | None, new: Element | None, feature: str, old_text: str, new_text: str) -> None:
        self.record(ChangeKind.CHANGED, old, new, feature, old_text, new_text)

    def remove(self, old: Element) -> None:
        self.unmatched.add(old)
        self.record(ChangeKind.REMOVED, old, None, "", "" if has_identity(old) else label(old), "")

    def add(self, new: Element) -> None:
        self.unmatched.add(new)
        self.record(ChangeKind.ADDED, None, new, "", "", "" if has_identity(new) else label(new))

    def record(
        self, kind: ChangeKind, old: Element | None, new: Element | None, feature: str, old_text: str, new_text: str
    ) -> None:
        shown = new if new is not None else old
        assert shown is not None
        self.found.append(ModelChange(kind, type(shown).__name__, shown.qualified_name, feature, old_text, new_text, old, new))

    def place(self, change: ModelChange) -> int:
        if change.new_element is not None:
            return self.new_names.order[change.new_element]
        holder = change.old_element
        while holder is not None and holder not in self.counterparts:
            holder = holder.container
        return self.new_names.order[self.counterparts[holder]] if holder is not None else 0

    def has_unmatched_container(self, element: Element) -> bool:
        holder = element.container
        while holder is not None and holder not in self.unmatched:
            holder = holder.container
        return holder is not None

    # Comparison

    def versions(self) -> None:
        old, new = (", ".join(sorted({document.file_version for document in model.documents})) for model in self.models)
        if old != new:
            old_root, new_root = (model.documents[0].root for model in self.models)
            self.change(old_root, new_root, VERSION_FEATURE, old, new)

    def owner(self, old: Element, new: Element) -> None:
        if not self.is_same_owner(_owner(old), _owner(new)):
            self.record(ChangeKind.MOVED, old, new, _holding_feature(new).xml_name, _owner_text(old), _owner_text(new))

    def is_same_owner(self, old: Element | None, new: Element | None) -> bool:
        if old is None or new is None:
            return old is new
        if has_identity(old) or has_identity(new):
            return self.old_names.token(old) == self.new_names.token(new)
        if old in self.counterparts:
            return self.counterparts[old] is new
        # Parts of what is equal altogether were not looked at.
        is_alike = type(old) is type(new) and label(old) == label(new)
        return is_alike and self.is_same_owner(_owner(old), _owner(new))

    def pair(self, old: Element, new: Element) -> None:
        self.counterparts[old] = new
        if self.old.fingerprints.of(old) != self.new.fingerprints.of(new):
            self.features((old,), (new,))

    def features(self, old: Elements, new: Elements) -> None:
        """Compare objects; several on a side are the roots of several files, or their sub-models, and count as one."""
        self.counterparts |= {element: new[0] for element in old if new}
        for feature in features_of(type((old or new)[0])).values():
            if feature.kind == "attribute":
                self.attribute(feature, old, new)
            else:
                self.references(feature, old, new)
                self.parts(feature, old, new)
        self.unknown(old, new)

    def attribute(self, feature: ElementFeature, old: Elements, new: Elements) -> None:
        old_value, new_value = self.meaning(feature, old, new), self.meaning(feature, new, old)
        if old_value != new_value and not (old_value != old_value and new_value != new_value):
            self.change(*_first_of_each(old, new), feature.xml_name, value_text(old_value), value_text(new_value))

    def meaning(self, feature: ElementFeature, elements: Elements, others: Elements) -> Any:
        """The first value that differs from the default."""
        unset_attributes = [self.unset_attributes.of(element)[feature.name] for element in elements or others]
        values = [a.meaning(e.__dict__.get(feature.name)) for a, e in zip(unset_attributes, elements, strict=False)]
        return next(
            (v for v, a in zip(values, unset_attributes, strict=False) if v != a.stands_for), unset_attributes[0].stands_for
        )

    def references(self, feature: ElementFeature, old: Elements, new: Elements) -> None:
        old_targets, new_targets = (
            [value for value in _values(feature, elements) if not feature.contains(value)] for elements in (old, new)
        )
        old_tokens, new_tokens = map(self.old_names.token, old_targets), map(self.new_names.token, new_targets)
        texts = _Tokens(old_tokens, old_targets), _Tokens(new_tokens, new_targets)
        if texts[0].tokens == texts[1].tokens:
            return
        if feature.many:
            self.change(*_first_of_each(old, new), feature.xml_name, *_list_text(*texts))
        else:
            old_text, new_text = (readable_name(targets[0]) if targets else UNSET for targets in (old_targets, new_targets))
            self.change(*_first_of_each(old, new), feature.xml_name, old_text, new_text)

    def parts(self, feature: ElementFeature, old: Elements, new: Elements) -> None:
        old_parts, new_parts = (
            [part for part in _values(feature, elements) if feature.contains(part) and not has_identity(part)]
            for elements in (old, new)
        )
        if feature.many:
            self.part_lists(feature, (old, new), old_parts, new_parts)
        elif isinstance((old or new)[0], Amalthea) and (old_parts or new_parts):
            self.features(tuple(old_parts), tuple(new_parts))
        elif old_parts or new_parts:
            self.single_part(feature, (old, new), *_first_of_each(old_parts, new_parts))

    def part_lists(
        self, feature: ElementFeature, holders: tuple[Elements, Elements], old: list[Element], new: list[Element]
    ) -> None:
        if not old and not new:
            return
        matcher = PartsMatcher(old, new, self.old, self.new)
        is_ordered = is_sequence(type((holders[0] or holders[1])[0]), feature.name)
        matcher.match(is_ordered)
        for removed in matcher.old:
            self.remove(removed)
        for added in matcher.new:
            self.add(added)
        for pair in matcher.pairs:
            self.pair(*pair)
        moved = matcher.moved() if is_ordered else []
        if moved:
            self.change(*_first_of_each(*holders), feature.xml_name, "", f"reordered {_names(map(_described, moved))}")

    def single_part(
        self, feature: ElementFeature, holders: tuple[Elements, Elements], old: Element | None, new: Element | None
    ) -> None:
        if all(part is None or is_inline(part) for part in (old, new)):
            texts = value_text(old), value_text(new)
            if type(old) is not type(new) and old is not None and new is not None and texts[0] == texts[1]:
                texts = _described(old), _described(new)
            if texts[0] != texts[1]:
                self.change(*_first_of_each(*holders), feature.xml_name, *texts)
                return
        if old is not None and new is not None and type(old) is type(new):
            self.pair(old, new)
            return
        if old is not None:
            self.remove(old)
        if new is not None:
            self.add(new)

    def unknown(self, old: Elements, new: Elements) -> None:
        old_content, new_content = (
            Counter((name, text) for element in elements for name, texts in _unknown(element) for text in texts)
            for elements in (old, new)
        )
        lost, gained = old_content - new_content, new_content - old_content
        for name in dict.fromkeys(name for name, _ in [*lost, *gained]):
            texts = (shortened(" ".join(t for n, t in side.elements() if n == name)) or UNSET for side in (lost, gained))
            self.change(*_first_of_each(old, new), name, *texts)


class _Tokens:
    """The targets of a list of references."""

    def __init__(self, tokens: Iterable[Hashable], targets: Sequence[Element]) -> None:
        self.tokens = list(tokens)
        self.targets = targets

    def names_missing_in(self, other: _Tokens) -> list[str]:
        """The names of the targets that the other list does not have, or not so often."""
        spare = Counter(other.tokens)
        names = []
        for token, target in zip(self.tokens, self.targets, strict=True):
            spare[token] -= 1
            if spare[token] < 0:
                names.append(readable_name(target))
        return names

    def names_moved(self, other: _Tokens) -> list[str]:
        """The names of the targets that are in both lists, but in another order."""
        places = {token: place for place, token in enumerate(other.tokens)}
        common = [(t, e) for t, e in dict(zip(self.tokens, self.targets, strict=True)).items() if t in places]
        kept = set(increasing([places[token] for token, _ in common]))
        return [readable_name(target) for index, (_, target) in enumerate(common) if index not in kept]


def _list_text(old: _Tokens, new: _Tokens) -> tuple[str, str]:
    removed, added, moved = old.names_missing_in(new), new.names_missing_in(old), new.names_moved(old)
    parts = [f"{word} {_names(names)}" for word, names in (("added", added), ("reordered", moved)) if names]
    return f"removed {_names(removed)}" if removed else "", ", ".join(parts)


def _names(names: Iterable[str]) -> str:
    known = list(names)
    more = len(known) - _MAX_NAMES
    return ", ".join(known[:_MAX_NAMES]) + (f" and {more} more" if more > 0 else "")


def _described(part: Element) -> str:
    return f"{type(part).__name__} {label(part)}".rstrip()


def _values(feature: ElementFeature, elements: Elements) -> list[Any]:
    found: list[Any] = []
    for element in elements:
        value = element.__dict__.get(feature.name)
        if value is not None:
            found += value if feature.many else [value]
    return found


def _first_of_each(old: Sequence[Element], new: Sequence[Element]) -> tuple[Element | None, Element | None]:
    return (old[0] if old else None), (new[0] if new else None)


def _unknown(element: Element) -> Iterator[tuple[str, tuple[str, ...]]]:
    yield from unknown_content(element.__dict__.get("_extras")).items()


def _owner(element: Element) -> Element | None:
    """The nearest container with a name; files and sub-models are no owners."""
    holder = element.container
    while holder is not None and not has_identity(holder) and not name_of(holder):
        holder = holder.container
    return holder


def _owner_text(element: Element) -> str:
    owner = _owner(element)
    return label(owner) if owner is not None else type(element.container).__name__


def _holding_feature(element: Element) -> ElementFeature:
    holder = element.container
    assert holder is not None
    for feature in features_of(type(holder)).values():
        if feature.kind != "attribute" and any(value is element for value in _values(feature, (holder,))):
            return feature
    raise ValueError(f"{element!r} is not a part of {holder!r}")
