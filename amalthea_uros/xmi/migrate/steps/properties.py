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


def put_property(holder: Node, key: str, value: Node) -> Node:
    """A new custom property of exactly that key, after those that the object has; the value leaves its container for it."""
    last = max((at for at, child in enumerate(holder.children) if child.tag == "customProperties"), default=-1)
    made = holder.add("customProperties", at=last + 1, like=value, key=key)
    value.tag = "value"
    made.insert(value)
    return made


def add_value(holder: Node, key: str, value: Node) -> Node:
    """A new custom property with a value; a key that is there already gets a number, because keys are unique."""
    return put_property(holder, free_key(key, keys_of(holder)), value)


def add_property(holder: Node, key: str, text: str) -> None:
    """Add a text as the last custom property; a key that is there already gets a number."""
    add_value(holder, key, text_value(text, holder))


def text_value(text: str, like: Node, tag: str = "value") -> Node:
    """A text as value of a custom property, or as one of a list of values; it has the origin of `like`."""
    return Node(tag, "StringObject", {"value": text}, like.origin)


def keys_of(holder: Node) -> set[str]:
    """The keys of all custom properties of an object."""
    return {each.get("key") for each in holder.all("customProperties")}


def move_properties(source: Node, target: Node) -> list[Node]:
    """Give the custom properties of a node to another one, after those that it has; all that were moved.

    A key that the other one has already gets a number, because keys are unique.
    """
    present = target.all("customProperties")
    keys = keys_of(target)
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
