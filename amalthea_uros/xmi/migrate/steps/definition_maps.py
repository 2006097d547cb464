"""Scheduler and parameter definitions of 2.0.0 as maps, the form in which a custom property can hold them, and back."""

from __future__ import annotations

from collections.abc import Callable

from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.steps.kept import references, strings, targets_of, text_of, texts_of
from amalthea_uros.xmi.migrate.steps.properties import text_value

#: References to parameter definitions: by name, as these become maps, too.
PARAMETER_LISTS = ("algorithmParameters", "processParameters")

_CUSTOM = "customProperties"

#: Marks a part as absent, in the map that distinguishes it from the other parts.
Report = Callable[[Node], None]


def as_map(definition: Node, report: Report) -> Node:
    """The content of a definition, of which nothing is left afterwards; parts of which a map can hold nothing are reported."""
    made = Node("value", "MapObject", origin=definition.origin)
    for key, text in definition.attributes.items():
        _enter(made, key, text_value(text, definition))
    for name, targets in definition.references.items():
        named = name in PARAMETER_LISTS
        _enter(made, name, strings((t.name for t in targets), definition) if named else references(targets, definition))
    for value in definition.all("defaultValue"):
        _enter(made, "defaultValue", value)
    properties = definition.all(_CUSTOM)
    if properties:
        own = Node("value", "MapObject", origin=definition.origin)
        own.take(properties)
        for node in properties:
            node.tag = "entries"
        _enter(made, _CUSTOM, own)
    for node in definition.children:
        report(node)
    return made


def _enter(made: Node, key: str, value: Node) -> None:
    entry = made.add("entries", like=value, key=key)
    value.tag = "value"
    entry.insert(value)


def from_map(tag: str, value: Node) -> tuple[Node, dict[str, list[str]]]:
    """The definition that `as_map` made a map of, and the names of the parameters that it refers to, by reference."""
    made = Node(tag, origin=value.origin)
    names: dict[str, list[str]] = {}
    for entry in value.all("entries"):
        key, content = entry.get("key"), entry.child("value")
        if content is None:
            continue
        if key in PARAMETER_LISTS:
            names[key] = texts_of(content)
        elif key == "defaultValue":
            content.tag = key
            made.insert(content)
        elif key == _CUSTOM:
            properties = content.all("entries")
            made.take(properties)
            for node in properties:
                node.tag = _CUSTOM
        elif content.type == "StringObject":
            made.attributes[key] = text_of(content)
        else:
            made.references[key] = targets_of(content)
    return made, names
