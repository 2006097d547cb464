"""Graphs whose depth nothing limits, walked without recursion."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable
from typing import TypeVar

T = TypeVar("T", bound=Hashable)


def bottom_up(starts: Iterable[T], parts: Callable[[T], Iterable[T]]) -> list[T]:
    """Everything that is reached, parts before wholes.

    In a circle this cannot be: there at least one whole comes before a part of it.
    """
    found: list[T] = []
    seen: set[T] = set()
    pending = [(start, False) for start in starts]
    pending.reverse()
    while pending:
        item, is_left = pending.pop()
        if is_left:
            found.append(item)
        elif item not in seen:
            seen.add(item)
            pending.append((item, True))
            pending.extend((part, False) for part in reversed(list(parts(item))))
    return found


def reached(starts: Iterable[T], following: Callable[[T], Iterable[T]]) -> list[T]:
    """Everything that is reached, the starts included, each once; what is nearest first."""
    seen = dict.fromkeys(starts)
    found = list(seen)
    for item in found:
        new = dict.fromkeys(each for each in following(item) if each not in seen)
        seen |= new
        found += new
    return found


def circles(items: Iterable[T], parts: Callable[[T], Iterable[T]]) -> list[set[T]]:
    """The items that are parts of themselves, together with those that they are parts of themselves through.

    These are the strongly connected components (S. R. Kosaraju; M. Sharir, "A strong-connectivity algorithm and its applications in
    data flow analysis", Computers and Mathematics with Applications 7, 1981).
    """
    order = bottom_up(items, parts)
    wholes: dict[T, list[T]] = {}
    for item in order:
        for part in parts(item):
            wholes.setdefault(part, []).append(item)
    done: set[T] = set()
    found = []
    for item in reversed(order):
        if item not in done:
            together = set(bottom_up([item], lambda one: [whole for whole in wholes.get(one, ()) if whole not in done]))
            done.update(together)
            if len(together) > 1 or item in parts(item):
                found.append(together)
    return found
