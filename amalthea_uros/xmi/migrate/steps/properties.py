"""Custom properties: `<customProperties key="k"><value xsi:type="am:StringObject" value="v"/></customProperties>`."""

from __future__ import annotations

from itertools import count

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
    """Add a text as the last custom property."""
    added = node.add("customProperties", at=len(node.all("customProperties")), key=key)
    added.add("value", "StringObject", value=text)


def move_properties(source: Node, target: Node) -> list[Node]:
    """Give the custom properties of a node to another one, after those that it has; all that were moved.

    A key that the other one has already gets a number, because keys are unique.
    """
    present = target.all("customProperties")
    keys = {each.get("key") for each in present}
    moved = source.all("customProperties")
    for at, each in enumerate(moved, len(present)):
        base = key = each.get("key")
        for number in count(2):
            if key not in keys:
                break
            key = f"{base} {number}"
        keys.add(key)
        each.attributes["key"] = key
        target.insert(each, at)
    return moved
