"""What the steps 0.9.2 ... 0.9.5 share: elements that become part of others, and nodes by class."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node


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
