"""What the steps from 0.7.0 to 0.8.1 have in common."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from amalthea_uros.xmi.escape import escape
from amalthea_uros.xmi.header import XSI_NAMESPACE
from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.names import reference_text
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.steps.properties import free_key, keys_of, text_value


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
