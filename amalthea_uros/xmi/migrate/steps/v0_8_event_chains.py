"""Event chains in event chains, which cannot be referred to from AMALTHEA 0.8.1 on."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.names import reference_text
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.kept import strings
from amalthea_uros.xmi.migrate.steps.properties import add_property, add_value

_CONSTRAINTS = ("EventChainLatencyConstraint", "EventChainSynchronizationConstraint")


def contain_event_chains(models: ModelSet, notes: Notes) -> None:
    """SubEventChain -> EventChainContainer; references to inner chains -> custom properties with the text of the reference."""
    chains = [chain for tree in models.trees for chain in tree.root.find("constraintsModel", "eventChains")]
    outer = {chain.name: chain for chain in chains if chain.name}
    for item in models.nodes("segments", "strands"):
        if item.type == "SubEventChain":
            item.type = "EventChainContainer"
            notes.renamed(item, "class renamed", "SubEventChain -> EventChainContainer")
        elif item.type == "EventChainReference":
            for text in _take_inner(item, "eventChain", outer):
                add_property(item, "eventChain", text)
                notes.kept(item, "reference to an inner event chain", text, "eventChain")
    for constraint in models.parts("constraintsModel", "timingConstraints"):
        if constraint.type in _CONSTRAINTS:
            _keep_scope(constraint, outer, notes)


def _keep_scope(constraint: Node, outer: dict[str, Node], notes: Notes) -> None:
    texts = _take_inner(constraint, "scope", outer)
    if not texts:
        return
    add_value(constraint, "scope", strings(texts, constraint))
    notes.kept(constraint, "scope: reference to an inner event chain", ", ".join(texts), "scope")


def _take_inner(node: Node, name: str, outer: dict[str, Node]) -> list[str]:
    """Remove the targets of a reference that are inner chains; the texts that referred to them."""
    targets = node.references.pop(name, [])
    # One target elsewhere makes elements of all.
    start = "amlt:/#" if any(target.root is not node.root for target in targets) else ""
    kept: list[Node] = []
    texts: list[str] = []
    for target in targets:
        if target.tag == "eventChains" or target.is_proxy:
            kept.append(target)  # what is in no file, may be an outer one
        elif target.name in outer:
            kept.append(outer[target.name])  # from now on the name means that one
        else:
            texts.append(start + reference_text(target))
    if kept:
        node.references[name] = kept
    return texts
