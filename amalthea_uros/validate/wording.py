"""Phrases that messages share: lists of names, and numbers with their noun."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros._internal.plural import enumerated
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.naming import name_of


def listed(elements: Iterable[Element], most: int = 5) -> str:
    """The quoted names of objects; the rest of a long list is only counted."""
    return joined([repr(name_of(element)) for element in elements], most)


def joined(texts: Iterable[str], most: int = 5) -> str:
    """An enumeration of texts; the rest of a long list is only counted.

    >>> joined("ab"), joined("abcd", most=2)
    ('a and b', 'a, b and 2 more')
    """
    every = list(texts)
    if len(every) > most:
        every[most:] = [f"{len(every) - most} more"]
    return enumerated(every)
