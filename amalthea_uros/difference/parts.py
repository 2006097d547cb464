"""Which parts of two lists are the same: parts have no unique names, only keys, content and order."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from difflib import SequenceMatcher
from typing import TYPE_CHECKING, NamedTuple

from amalthea_uros.difference.matching import Pair, pair_up
from amalthea_uros.difference.names import first_reference
from amalthea_uros.metamodel.classes_base import INamed
from amalthea_uros.metamodel.element import Element

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence

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


# Alignment of two sequences: their common items, in order; nearly linear even for thousands of items

#: Products of lengths beyond which frequent items are no starting points: going through all their pairs would be quadratic.
_LARGE = 250_000

IndexPair = tuple[int, int]


def align(old: Sequence[Hashable], new: Sequence[Hashable]) -> list[IndexPair]:
    """Index pairs of equal items, increasing on both sides.

    Items that are unique on both sides are matched first; the items between them are compared separately.

    >>> align("abcd", "bxcd")
    [(1, 0), (2, 2), (3, 3)]
    """
    pairs: list[IndexPair] = []
    at_old = at_new = 0
    for i, j in [*_anchors(old, new), (len(old), len(new))]:
        pairs += ((at_old + x, at_new + y) for x, y in _align_gap(old[at_old:i], new[at_new:j]))
        if i < len(old):
            pairs.append((i, j))
        at_old, at_new = i + 1, j + 1
    return pairs


def increasing(numbers: Sequence[int]) -> list[int]:
    """Indices of a longest increasing subsequence.

    >>> increasing([3, 0, 1, 2])
    [1, 2, 3]
    """
    ends: list[int] = []
    end_indices: list[int] = []
    before: list[int] = []
    for index, number in enumerate(numbers):
        at = bisect_left(ends, number)
        before.append(end_indices[at - 1] if at else -1)
        ends[at : at + 1] = [number]
        end_indices[at : at + 1] = [index]
    found = []
    index = end_indices[-1] if end_indices else -1
    while index >= 0:
        found.append(index)
        index = before[index]
    return found[::-1]


def _anchors(old: Sequence[Hashable], new: Sequence[Hashable]) -> list[IndexPair]:
    in_old, in_new = Counter(old), Counter(new)
    places = {item: j for j, item in enumerate(new)}
    unique = [(i, places[item]) for i, item in enumerate(old) if in_old[item] == 1 and in_new[item] == 1]
    return [unique[k] for k in increasing([j for _, j in unique])]


def _align_gap(old: Sequence[Hashable], new: Sequence[Hashable]) -> Iterator[IndexPair]:
    shortest = min(len(old), len(new))
    head = next((k for k in range(shortest) if old[k] != new[k]), shortest)
    rest = shortest - head
    tail = next((k for k in range(rest) if old[-1 - k] != new[-1 - k]), rest)
    yield from ((k, k) for k in range(head))
    inner_old, inner_new = old[head : len(old) - tail], new[head : len(new) - tail]
    if inner_old and inner_new:
        is_large = len(inner_old) * len(inner_new) > _LARGE
        matcher = SequenceMatcher(None, inner_old, inner_new, autojunk=is_large)
        for i, j, size in matcher.get_matching_blocks():
            yield from ((head + i + k, head + j + k) for k in range(size))
    yield from ((len(old) - k, len(new) - k) for k in range(tail, 0, -1))
