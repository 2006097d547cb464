"""Which objects of two models are the same: by unique name, and those that were only renamed."""

from __future__ import annotations

from collections import defaultdict, deque
from typing import TYPE_CHECKING

from amalthea_uros.difference.fingerprint import Fingerprints
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.features import features_of

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable

    from amalthea_uros.difference.fingerprint import UnsetAttributes
    from amalthea_uros.difference.names import ElementNames, Token

Pair = tuple[Element, Element]

#: How far the neighbourhood of an object counts, in references.
_ROUNDS = 4


def pair_up(
    old: Iterable[Element],
    new: Iterable[Element],
    old_key: Callable[[Element], Hashable],
    new_key: Callable[[Element], Hashable],
) -> list[Pair]:
    """Pairs of objects with equal keys, those with the same key in their order; the key None matches none."""
    waiting: dict[Hashable, deque[Element]] = defaultdict(deque)
    for element in new:
        key = new_key(element)
        if key is not None:
            waiting[key].append(element)
    return [(element, waiting[key].popleft()) for element in old if waiting.get(key := old_key(element))]


class ElementMatching:
    """The objects with an identity of two models, in pairs.

    Attributes
    ----------
    pairs : the old and the new side of what is in both; renamed objects too
    removed, added : what is in one of them only

    Parameters
    ----------
    by_content : content is more than names: objects with the same name and different content may have exchanged their names with others
    """

    def __init__(
        self, old: ElementNames, new: ElementNames, unset_attributes: UnsetAttributes, by_content: bool = False
    ) -> None:
        self._old, self._new, self._unset_attributes = old, new, unset_attributes
        #: Objects that are the same whatever is found about renames.
        self._certain: list[Pair] = []
        self.pairs: list[Pair] = []
        self.removed: dict[Element, None] = {}
        self.added: dict[Element, None] = {}
        self._common = old.by_token.keys() & new.by_token.keys()
        for token in old.by_token | new.by_token:
            self._match_name(old.by_token.get(token, []), new.by_token.get(token, []))
        namesakes = self._part_changed() if by_content else []
        if self.removed and self.added:
            self._match_renamed()
        self._accept([(a, b) for a, b in namesakes if a in self.removed and b in self.added])

    def _match_name(self, old: list[Element], new: list[Element]) -> None:
        if len(old) == len(new) == 1:
            self.pairs.append((old[0], new[0]))
            return
        # Names that are not unique: those in the same container first.
        pairs = pair_up(old, new, self._old.owner, self._new.owner)
        self.pairs += pairs
        rest = _without(old, (a for a, _ in pairs)), _without(new, (b for _, b in pairs))
        common = min(map(len, rest))
        self.pairs += zip(rest[0][:common], rest[1][:common], strict=True)
        self.removed |= dict.fromkeys(rest[0][common:])
        self.added |= dict.fromkeys(rest[1][common:])

    def _part_changed(self) -> list[Pair]:
        """Undo the pairs of objects with the same name and different content; the result are these pairs."""
        numbers: dict[Hashable, int] = {}
        old, new = (Fingerprints(self._unset_attributes, names.token, numbers) for names in (self._old, self._new))
        changed = [(a, b) for a, b in self.pairs if old.nameless(a) != new.nameless(b)]
        undone = {a for a, _ in changed}
        self.pairs = [pair for pair in self.pairs if pair[0] not in undone]
        self.removed |= dict.fromkeys(a for a, _ in changed)
        self.added |= dict.fromkeys(b for _, b in changed)
        self._common = self._common - {self._old.own_token(a) for a, _ in changed}
        return changed

    def _match_renamed(self) -> None:
        self._match_namespaces()
        candidates = self._candidates()
        while candidates:
            self._translate(candidates)
            with_owner = self._renamed_with_owner()
            kept = self._with_equal_content(candidates)
            if len(kept) == len(candidates):
                self._accept([*candidates, *with_owner])
                return
            candidates = kept
        self._translate([])

    def _match_namespaces(self) -> None:
        """Match objects that got into a namespace or out of one: they have the same name in the same place."""

        def key(names: ElementNames) -> Callable[[Element], Hashable]:
            return lambda e: (type(e), e.__dict__.get("name"), names.owner(e)) if "namespace" in features_of(type(e)) else None

        alike = _unique_pairs(_grouped(self.removed, key(self._old)), _grouped(self.added, key(self._new)))
        pairs = [(old, new) for old, new in alike if self._old.own_token(old) != self._new.own_token(new)]
        self._certain += pairs
        self._translate([])
        self._common = self._common | {self._old.own_token(old) for old, _ in pairs}
        self._accept(pairs)

    def _candidates(self) -> list[Pair]:
        """Pairs of a removed and an added object that could be one; references to what is not matched may lead anywhere yet."""
        numbers: dict[Hashable, int] = {}
        old = self._loose_keys(self._old, self.removed, numbers)
        new = self._loose_keys(self._new, self.added, numbers)
        pairs = _unique_pairs(old, new)
        if sum(map(len, old.values())) == len(pairs):
            return pairs
        # What is alike may still be told apart by what refers to it, and by that to which it refers.
        taken = {element for pair in pairs for element in pair}
        refined = self._refined(self._old, old, numbers), self._refined(self._new, new, numbers)
        return pairs + [pair for pair in _unique_pairs(*refined) if taken.isdisjoint(pair)]

    def _refined(
        self, names: ElementNames, groups: dict[Hashable, list[Element]], numbers: dict[Hashable, int]
    ) -> dict[Hashable, list[Element]]:
        """The groups split by the neighbours of their objects, and by the neighbours of these (colour refinement)."""
        colours: dict[Element, Hashable] = {element: key for key, group in groups.items() for element in group}
        neighbours = names.neighbours(colours)
        for _ in range(_ROUNDS):
            colours = {
                element: numbers.setdefault(
                    (colours[element], *sorted(((*way, colours.get(e, names.token(e))) for way, e in found), key=repr)),
                    len(numbers),
                )
                for element, found in neighbours.items()
            }
        return _grouped(colours, colours.__getitem__)

    def _loose_keys(
        self, names: ElementNames, unmatched: dict[Element, None], numbers: dict[Hashable, int]
    ) -> dict[Hashable, list[Element]]:
        def loose(target: Element) -> Token:
            token = names.token(target)
            return token if token in self._common else (type(target).__name__,)

        fingerprints = Fingerprints(self._unset_attributes, loose, numbers, lambda part: names.token(part) in self._common)
        found: dict[Hashable, list[Element]] = defaultdict(list)
        for element in unmatched:
            owner = names.owner(element)
            # A part of something unmatched goes with it.
            if not owner or owner in self._common:
                found[owner, fingerprints.nameless(element)].append(element)
        return found

    def _translate(self, pairs: list[Pair]) -> None:
        self._new.translation = {self._new.own_token(new): self._old.own_token(old) for old, new in (*self._certain, *pairs)}

    def _renamed_with_owner(self) -> list[Pair]:
        """Pairs of which only the names in front changed: ports of a renamed component, members of a namespace."""
        with_owner: list[Pair] = []
        while True:
            translation = self._new.translation
            known = set(translation.values())
            removed = (e for e in self.removed if self._old.own_token(e) not in known)
            added = (e for e in self.added if self._new.own_token(e) not in translation)
            pairs = pair_up(removed, added, lambda e: _position_key(e, self._old), lambda e: _position_key(e, self._new))
            if not pairs:
                return with_owner
            with_owner += pairs
            translation |= {self._new.own_token(new): self._old.own_token(old) for old, new in pairs}

    def _with_equal_content(self, candidates: list[Pair]) -> list[Pair]:
        numbers: dict[Hashable, int] = {}
        matched = self._common | set(self._new.translation.values())

        def fingerprints(names: ElementNames) -> Fingerprints:
            return Fingerprints(self._unset_attributes, names.token, numbers, lambda part: names.token(part) in matched)

        old, new = fingerprints(self._old), fingerprints(self._new)
        return [(a, b) for a, b in candidates if old.nameless(a) == new.nameless(b)]

    def _accept(self, pairs: list[Pair]) -> None:
        self.pairs += pairs
        for old, new in pairs:
            del self.removed[old]
            del self.added[new]


def _grouped(elements: Iterable[Element], key: Callable[[Element], Hashable]) -> dict[Hashable, list[Element]]:
    found: dict[Hashable, list[Element]] = defaultdict(list)
    for element in elements:
        found[key(element)].append(element)
    found.pop(None, None)
    return found


def _unique_pairs(old: dict[Hashable, list[Element]], new: dict[Hashable, list[Element]]) -> list[Pair]:
    return [(old[key][0], new[key][0]) for key in old if len(old[key]) == 1 and len(new.get(key, ())) == 1]


def _position_key(element: Element, names: ElementNames) -> Hashable:
    namespace = element.__dict__.get("namespace")
    around = names.token(namespace) if namespace is not None else None
    return (type(element), element.__dict__.get("name"), names.owner(element), around)


def _without(elements: list[Element], taken: Iterable[Element]) -> list[Element]:
    excluded = set(taken)
    return [element for element in elements if element not in excluded]
