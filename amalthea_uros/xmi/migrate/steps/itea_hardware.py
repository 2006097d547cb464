"""Attributes and features of hardware nodes -> custom properties (ITEA 1.3.0 -> 0.7.0)."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.classes import local_name
from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.properties import add_value

#: Classes of values -> those of custom properties.
_VALUES = {
    "BoolValue": "BooleanObject",
    "CharValue": "StringObject",
    "DoubleValue": "DoubleObject",
    "FeatureTypes": "StringObject",
    "IntValue": "IntegerObject",
    "LongValue": "LongObject",
    "StrValue": "StringObject",
}

#: Tags -> what the keys of their custom properties begin with.
_PREFIXES = {"attribute": "attribute#", "features": "feature#"}


def convert_values(models: ModelSet, notes: Notes) -> None:
    """Make the attributes and features of all hardware nodes custom properties."""
    converted = []
    for tag, prefix in _PREFIXES.items():
        for value in models.nodes(tag):
            holder = value.parent
            if holder is None or not _is_value(value):
                continue
            key, text = _key(value, prefix), value.attributes.get("value")
            if local_name(value.type) == "CharValue" and text is not None:
                text = _character(text, value, notes)
            value_class = _VALUES.get(local_name(value.type), "StringObject")
            content = Node("value", value_class, {} if text is None else {"value": text}, value.origin)
            made = add_value(holder, key, content)
            made.comments = value.comments
            notes.kept(value, f"{tag} of a hardware node: custom property", f"{made.get('key')}={text}")
            converted.append(value)
    remove_all(converted)


def _is_value(value: Node) -> bool:
    """Whether an element is an attribute or feature of hardware: others have the same tags."""
    return local_name(value.type) in _VALUES or (value.tag == "attribute" and not value.children)


def _key(value: Node, prefix: str) -> str:
    if local_name(value.type) == "FeatureTypes":
        prefix += "FeatureTypes#"
    name = value.attributes.get("name")
    if name is None:
        return prefix.removesuffix("#")
    return prefix + name


def _character(text: str, value: Node, notes: Notes) -> str:
    """The character that a code point stands for; the number itself if XML cannot hold it."""
    try:
        character = chr(int(text))
    except (ValueError, OverflowError):
        notes.kept(value, "character that is no code point: its text is kept", text, "value")
        return text
    return character if character.isprintable() or character in "\t\n\r" else text
