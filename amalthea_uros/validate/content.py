"""Comparing and naming objects for repairs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from itertools import count
from typing import NamedTuple

from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context


def is_same(one: Element, other: Element) -> bool:
    """Whether two objects have equal content: the same values, references to the same objects, and parts with equal content."""
    if type(one) is not type(other) or one.is_referable:
        return one is other
    features = {*one.__dict__, *other.__dict__}
    return all(_is_same_value(_stated(one, name), _stated(other, name)) for name in features)


def _stated(element: Element, name: str) -> object:
    """The value of a feature; None if it is not set or an empty list."""
    value = element.__dict__.get(name)
    return None if value == [] else value


def _is_same_value(one: object, other: object) -> bool:
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_is_same_value, one, other))
    if isinstance(one, Element) and isinstance(other, Element):
        return one is other or is_same(one, other)
    return one == other


def new_name(stem: str, cls: type[Element], context: Context) -> str:
    """A name that no object of a class uses yet, and no reference without target, which would get another meaning."""
    names = context.once(_names)
    taken = names.taken[cls]
    name = next(name for number in names.numbers[cls, stem] if (name := f"{stem}_{number}") not in taken)
    taken.add(name)
    return name


class _UsedNames(NamedTuple):
    """The names in use by class, and the next number for a stem, so that many objects are named in one pass."""

    taken: dict[type[Element], set[str | None]]
    numbers: dict[tuple[type[Element], str], Iterator[int]]


def _names(context: Context) -> _UsedNames:
    taken: dict[type[Element], set[str | None]] = defaultdict(set)
    for element in (*context.all(Element), *context.referred):
        taken[type(element)].add(element.__dict__.get("name"))
    return _UsedNames(taken, defaultdict(lambda: count(1)))
