"""Custom properties for what AMALTHEA 0.8.1 and 0.8.3 have no place for."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.node import Node

_TAG = "customProperties"


def add_property(holder: Node, key: str, value: Node, value_type: str) -> None:
    """Give an object a custom property after those that it has; `value` leaves its container and becomes the value."""
    made = holder.add(_TAG, at=_count(holder), like=value, key=key)
    value.tag, value.type = "value", value_type
    made.insert(value)


def add_text(holder: Node, key: str, text: str) -> None:
    """Give an object a custom property with a text, unless it has exactly that one."""
    if text_of(holder, key) != text:
        add_property(holder, key, Node("value", attributes={"value": text}, origin=holder.origin), "StringObject")


def text_of(holder: Node, key: str) -> str | None:
    """The text of a custom property, None if there is none."""
    for entry in holder.all(_TAG):
        value = entry.child("value")
        if entry.get("key") == key and value is not None:
            return value.get("value")
    return None


def _count(holder: Node) -> int:
    return sum(1 for child in holder.children if child.tag == _TAG)


def outline(node: Node) -> str:
    """What the parts of an object are, as text: `lowerBound=1ms, distribution=WeibullEstimators(pRemainPromille=0.5)`."""
    return ", ".join(f"{child.tag}={_value(child)}" for child in node.children)


def _value(node: Node) -> str:
    if "value" in node.attributes:
        return node.get("value") + node.get("unit")
    stated = [f"{name}={text}" for name, text in node.attributes.items()]
    stated += [outline(node)] if node.children else []
    return node.type + (f"({', '.join(stated)})" if stated else "")
