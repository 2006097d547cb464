"""Custom properties in which a step back keeps what the older version has no place for; the step up restores it."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.properties import put_property, text_value


def prefix(version: str) -> str:
    """What the keys of all properties start with that keep content of that version."""
    return f"AMALTHEA {version}: "


def keep(holder: Node, key: str, value: Node) -> Node:
    """Make a value a custom property of an object, with a key that starts with `prefix`: no other property has it."""
    return put_property(holder, key, value)


def kept(holder: Node, start: str) -> dict[str, Node]:
    """The custom properties of an object whose keys start so, by the rest of the key."""
    return {
        child.get("key").removeprefix(start): child
        for child in holder.children
        if child.tag == "customProperties" and child.get("key").startswith(start)
    }


def strings(texts: Iterable[str], like: Node) -> Node:
    """Texts as one value of a custom property."""
    made = Node("value", "ListObject", origin=like.origin)
    for text in texts:
        made.insert(text_value(text, like, "values"))
    return made


def texts_of(value: Node | None) -> list[str]:
    """The texts that `strings` made a value of; of a damaged value what is readable."""
    return [] if value is None else [item.get("value") for item in value.all("values") if item.type == "StringObject"]


def text_of(value: Node | None) -> str:
    """The text of a value."""
    return "" if value is None else value.get("value")


def references(targets: Iterable[Node], like: Node) -> Node:
    """References as one value of a custom property."""
    made = Node("value", "ListObject", origin=like.origin)
    for target in targets:
        item = made.add("values", "ReferenceObject")
        item.refer("value", target)
    return made


def targets_of(value: Node | None) -> list[Node]:
    """The targets of the references that `references` made a value of."""
    found = [] if value is None else [item.target("value") for item in value.all("values")]
    return [target for target in found if target is not None]


def refuse_stale(models: ModelSet, notes: Notes, version: str) -> None:
    """Properties of an earlier migration back that were not restored would be taken for content of this model: they are an error."""
    start = prefix(version)
    for node in models.nodes("customProperties"):
        if node.get("key").startswith(start):
            notes.lost(
                node, "custom property of an earlier migration back that was never restored", repr(node.get("key")), "key"
            )
