"""What steps have in common: custom properties, numbers, comments, texts for people."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping
from itertools import chain, count

from amalthea_uros.xmi.emf.escape import escape
from amalthea_uros.xmi.emf.header import XSI_NAMESPACE
from amalthea_uros.xmi.tree.classes import reference_text
from amalthea_uros.xmi.tree.model_set import ModelSet
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import StepNotes

# Custom properties: `<customProperties key="k"><value xsi:type="am:StringObject" value="v"/></customProperties>`

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


# Numbers in attributes, of which any text may be damaged

# More digits than any number of a model has, and fewer than Python converts.
_INTEGER = re.compile(r"[+-]?[0-9]{1,1000}").fullmatch


def whole_number(text: str) -> int | None:
    """The number that a text is, None if it is none."""
    return int(text) if _INTEGER(text) else None


def make_positive(node: Node, attribute: str, notes: StepNotes) -> None:
    """Replace a written 0 by the smallest number that is allowed now, which is also the new default; negative numbers never meant
    anything.
    """
    if attribute not in node.attributes:
        notes.to_check(node, f"{attribute} is not set: the default was 0 and is now 1", "", attribute)
        return
    number = whole_number(node.get(attribute))
    if number == 0:
        node.attributes[attribute] = "1"
        notes.converted(node, f"{attribute} 0 is no longer allowed; set to 1", "", attribute)
    elif number is not None and number < 0:
        notes.to_check(node, f"{attribute} must be positive", str(number), attribute)


# Nodes


def keep_comments(dissolved: Node, owner: Node) -> None:
    """Move the comments in front of an element that goes away to the one that takes its content."""
    if dissolved.comments and dissolved is not owner:
        owner.comments = [*(owner.comments or ()), *dissolved.comments]
        dissolved.comments = None


def insert_after(following: dict[Node, Node]) -> None:
    """Put nodes after others, in time linear in the number of siblings."""
    for holder in {node.parent: None for node in following if node.parent is not None}:
        children: list[Node] = []
        for child in holder.children:
            children.append(child)
            added = following.get(child)
            if added is not None:
                children.append(added)
        holder.set_children(children)


def by_class(models: ModelSet, names: Iterable[str]) -> dict[str, list[Node]]:
    """The objects whose `xsi:type` states one of some classes."""
    return {name: models.of_type(name) for name in names}


def quantity_text(node: Node) -> str:
    """Value and unit without a blank: `10ms`."""
    return node.get("value", "0") + node.get("unit")


# Texts


def keep_as_properties(holder: Node, properties: Iterable[tuple[str, str]]) -> None:
    """Add custom properties with text values, after those that the object has; a key that it has already gets a number."""
    added = []
    used = keys_of(holder)
    for key, text in properties:
        unique = free_key(key, used)
        used.add(unique)
        made = Node("customProperties", "", {"key": unique}, holder.origin)
        made.insert(text_value(text, holder))
        added.append(made)
    others = [child for child in holder.children if child.tag != "customProperties"]
    holder.set_children([*holder.all("customProperties"), *added, *others])


def remove_and_keep(nodes: Iterable[Node], version: str) -> None:
    """Remove objects, and keep the text of each as a custom property of its container."""
    removed = list(nodes)
    kept: dict[Node, list[tuple[str, str]]] = {}
    for node in removed:
        if node.parent is not None:
            kept.setdefault(node.parent, []).append((removed_key(node.type, version), xml_text(node)))
    remove_all(removed)
    for holder, properties in kept.items():
        keep_as_properties(holder, properties)


def removed_key(what: str, version: str) -> str:
    """The key of the custom property that keeps an element, as APP4MC writes it in 0.8.0."""
    return f"{what} (element removed during Migration of Model to {version} version)"


def xml_text(node: Node) -> str:
    """An element with everything in it as APP4MC writes it into custom properties: as it is in the file."""
    depth = 0
    holder = node.parent
    while holder is not None:
        depth, holder = depth + 1, holder.parent
    return _xml_text(node, node.root, depth, f' xmlns:xsi="{XSI_NAMESPACE}"')


def _xml_text(node: Node, root: Node, depth: int, declaration: str) -> str:
    texts = {"xsi:type": f"am:{node.type}"} if node.type else {}
    texts |= node.attributes
    parts = []
    for name, targets in node.references.items():
        if all(target.is_proxy or target.root is root for target in targets):
            texts[name] = " ".join(map(reference_text, targets))
        else:
            parts += [f'<{name} href="amlt:/#{escape(reference_text(target))}" />' for target in targets]
    parts += [_xml_text(child, root, depth + 1, "") for child in node.children]
    start = f"<{node.tag}{declaration}" + "".join(f' {name}="{escape(text)}"' for name, text in texts.items())
    if not parts:
        return start + " />"
    return start + ">" + "".join(_line(depth + 1) + part for part in parts) + f"{_line(depth)}</{node.tag}>"


def _line(depth: int) -> str:
    """A new line, with the line ends of APP4MC."""
    return "\r\n" + "  " * depth


def names_of(nodes: Iterable[Node]) -> str:
    """The names of some objects, as a list for people."""
    return ", ".join(node.attributes.get("path", "") if node.is_proxy else node.name or node.type or node.tag for node in nodes)


def attributes_text(node: Node, separator: str = ", ") -> str:
    """The attributes of an object, as a list for people."""
    return separator.join(f"{name}={text}" for name, text in node.attributes.items())


def content_of(node: Node) -> str:
    """What an object that is removed states about itself, as a list for people."""
    stated = [f"{name}={text}" for name, text in node.attributes.items()]
    stated += [f"{name}={names_of(targets)}" for name, targets in node.references.items()]
    stated += [f"{child.tag} ({content})" if (content := content_of(child)) else child.tag for child in node.children]
    return ", ".join(stated)


def relink(models: ModelSet, replaced: Mapping[Node, Node]) -> None:
    """Let references to some objects mean others."""
    if not replaced:
        return
    for tree in models.trees:
        for node in tree.root.walk():
            for targets in node.references.values():
                if any(target in replaced for target in targets):
                    # A list without duplicates, in the old order.
                    targets[:] = dict.fromkeys(replaced.get(target, target) for target in targets)
