"""Alignment of two sequences: their common items, in order; nearly linear even for thousands of items."""

from __future__ import annotations

from bisect import bisect_left
from collections import Counter
from difflib import SequenceMatcher
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator, Sequence

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
