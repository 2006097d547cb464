"""Custom properties: `<customProperties key="k"><value xsi:type="am:StringObject" value="v"/></customProperties>`."""

from __future__ import annotations

from collections.abc import Collection
from itertools import chain, count

from amalthea_uros.xmi.migrate.node import Node

#: Classes of values that have one text.
_SIMPLE = ("StringObject", "IntegerObject", "LongObject", "BigIntegerObject")


def property_of(node: Node, key: str) -> Node | None:
    """The custom property of that key, None if there is none."""
    return next((each for each in node.all("customProperties") if each.get("key") == key), None)


def property_text(found: Node | None) -> str | None:
    """The text or number that is the value of a custom property, None if it has none or another value."""
    value = found.child("value") if found is not None else None
    return value.get("value") if value is not None and value.type in _SIMPLE else None


def add_property(node: Node, key: str, text: str) -> None:
    """Add a text as the last custom property; a key that is there already gets a number, because keys are unique."""
    present = node.all("customProperties")
    unique = free_key(key, {each.get("key") for each in present})
    node.add("customProperties", at=len(present), key=unique).add("value", "StringObject", value=text)


def move_properties(source: Node, target: Node) -> list[Node]:
    """Give the custom properties of a node to another one, after those that it has; all that were moved.

    A key that the other one has already gets a number, because keys are unique.
    """
    present = target.all("customProperties")
    keys = {each.get("key") for each in present}
    moved = source.all("customProperties")
    for at, each in enumerate(moved, len(present)):
        each.attributes["key"] = free_key(each.get("key"), keys)
        keys.add(each.get("key"))
        target.insert(each, at)
    return moved


def free_key(key: str, used: Collection[str]) -> str:
    """The key, or with the first number from 2 on that makes it differ from those that are used."""
    numbered = (f"{key} {number}" for number in count(2))
    return next(each for each in chain([key], numbered) if each not in used)
