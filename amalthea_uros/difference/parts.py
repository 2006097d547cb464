"""Which parts of two lists are the same: parts have no unique names, only keys, content and order."""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING, NamedTuple

from amalthea_uros.difference.alignment import align, increasing
from amalthea_uros.difference.matching import Pair, pair_up
from amalthea_uros.difference.value_text import first_reference
from amalthea_uros.metamodel.classes_base import INamed
from amalthea_uros.metamodel.element import Element

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable

    from amalthea_uros.difference.fingerprint import Fingerprints
    from amalthea_uros.difference.names import ElementNames


class Side(NamedTuple):
    """The old or the new model as seen by the comparison of parts."""

    names: ElementNames
    fingerprints: Fingerprints

    def key(self, part: Element) -> Hashable:
        """Class and key or name; None for a part without."""
        key = part.__dict__.get("key") or (part.__dict__.get("name") if isinstance(part, INamed) else None)
        if not key:
            return None
        return type(part), self.names.token(key) if isinstance(key, Element) else key

    def subject(self, part: Element) -> Hashable:
        """Class and the object that the part is about; None if it is about none."""
        target = first_reference(part)
        return None if target is None else (type(part), self.names.token(target))


class PartsMatcher:
    """Matches the parts of two lists.

    Attributes
    ----------
    pairs : what is in both lists
    old, new : what is in one of them only
    """

    def __init__(self, old: Iterable[Element], new: Iterable[Element], old_side: Side, new_side: Side) -> None:
        self.pairs: list[Pair] = []
        self.old, self.new = list(old), list(new)
        self._sides = old_side, new_side
        self._places = tuple({part: place for place, part in enumerate(parts)} for parts in (self.old, self.new))

    def match(self, is_sequence: bool) -> None:
        """Match by key, then by equal content, then by ever weaker similarity."""
        old, new = self._sides
        self._take(pair_up(self.old, self.new, old.key, new.key))
        anchors = self._take_equal() if is_sequence else []
        self._take(pair_up(self.old, self.new, old.fingerprints.of, new.fingerprints.of))
        # In a sequence, parts that differ can only be the same if they are between the same neighbours.
        old_gaps, new_gaps = ([places[pair[i]] for pair in anchors] for i, places in enumerate(self._places))
        levels: tuple[tuple[Callable[[Element], Hashable], Callable[[Element], Hashable]], ...] = (
            (old.fingerprints.shallow, new.fingerprints.shallow),
            (old.subject, new.subject),
            (type, type),
        )
        for old_key, new_key in levels:
            self._take(
                pair_up(
                    self.old,
                    self.new,
                    lambda part, key=old_key: self._in_gap(key(part), self._places[0][part], old_gaps),  # type: ignore[misc]
                    lambda part, key=new_key: self._in_gap(key(part), self._places[1][part], new_gaps),  # type: ignore[misc]
                )
            )

    def moved(self) -> list[Element]:
        """A minimal set of new parts whose order differs from that of the old ones."""
        old_places, new_places = self._places
        ordered = sorted(self.pairs, key=lambda pair: old_places[pair[0]])
        kept = set(increasing([new_places[new] for _, new in ordered]))
        return [new for index, (_, new) in enumerate(ordered) if index not in kept]

    def _take_equal(self) -> list[Pair]:
        old, new = self._sides
        equal = align([old.fingerprints.of(part) for part in self.old], [new.fingerprints.of(part) for part in self.new])
        pairs = [(self.old[i], self.new[j]) for i, j in equal]
        self._take(pairs)
        return pairs

    def _take(self, pairs: list[Pair]) -> None:
        taken = {part for pair in pairs for part in pair}
        self.pairs += pairs
        self.old = [part for part in self.old if part not in taken]
        self.new = [part for part in self.new if part not in taken]

    @staticmethod
    def _in_gap(key: Hashable, place: int, anchors: list[int]) -> Hashable:
        return None if key is None else (key, bisect_left(anchors, place))
