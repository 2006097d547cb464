"""Comparison and naming of objects for repairs."""

from __future__ import annotations

from itertools import count

from amalthea_uros.metamodel.element import Element
from amalthea_uros.validate.context import Context


def is_same(one: Element, other: Element) -> bool:
    """Whether two objects say the same: the same values, references to the same objects, parts that say the same."""
    if type(one) is not type(other) or one.is_referable:
        return one is other
    features = {*one.__dict__, *other.__dict__}
    return all(_is_same_value(one.__dict__.get(name), other.__dict__.get(name)) for name in features)


def _is_same_value(one: object, other: object) -> bool:
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_is_same_value, one, other))
    if isinstance(one, Element) and isinstance(other, Element):
        return one is other or is_same(one, other)
    return one == other or (not one and not other and one != 0 and other != 0)


def new_name(stem: str, cls: type[Element], context: Context) -> str:
    """A name that no object of a class has."""
    taken = {getattr(element, "name", None) for element in context.all(cls)}
    return next(name for number in count(1) if (name := f"{stem}_{number}") not in taken)
