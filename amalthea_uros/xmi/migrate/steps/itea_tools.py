"""What the steps of the ITEA versions have in common."""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.xmi.tree.classes import local_name
from amalthea_uros.xmi.tree.model_set import ModelSet, Tree
from amalthea_uros.xmi.tree.node import Node

#: Sub-models by the class that is the root of a file which holds nothing else.
SUB_MODELS = {
    "CommonElements": "commonElements",
    "ComponentsModel": "componentsModel",
    "ConfigModel": "configModel",
    "ConstraintsModel": "constraintsModel",
    "EventModel": "eventModel",
    "HWModel": "hwModel",
    "MappingModel": "mappingModel",
    "OSModel": "osModel",
    "PropertyConstraintsModel": "propertyConstraintsModel",
    "StimuliModel": "stimuliModel",
    "SWModel": "swModel",
}


def sub_models(models: ModelSet, tag: str) -> list[Node]:
    """The sub-models of a tag, whether they are parts of a model or roots of files."""
    classes = [root_class for root_class, known in SUB_MODELS.items() if known == tag]
    return [node for root in models.roots for node in ([root] if root.tag in classes else root.all(tag))]


def sub_model_or_new(tree: Tree, tag: str) -> Node:
    """The sub-model of that tag in a file, made if there is none; a file of another sub-model becomes a whole model for it."""
    root = tree.root
    if SUB_MODELS.get(root.tag) == tag:
        return root
    if root.tag in SUB_MODELS:
        tree.root = Node("AMALTHEA", origin=root.origin)
        tree.root.comments, root.comments = root.comments, None
        root.tag = SUB_MODELS[root.tag]
        tree.root.insert(root)
    return tree.root.child_or_new(tag)


def is_isr(process: Node) -> bool:
    """Whether a process is an ISR, as far as that is known of one that is in no file."""
    return process.tag == "isrs" or local_name(process.type or process.get("class")) == "ISR"


def trees_of(models: ModelSet) -> dict[Node, Tree]:
    """The files that the present step is about, by their roots."""
    return {tree.root: tree for tree in models.active}


def by_root(nodes: Iterable[Node]) -> dict[Node, list[Node]]:
    """Nodes by the roots of their files, in order."""
    found: dict[Node, list[Node]] = {}
    for node in nodes:
        found.setdefault(node.root, []).append(node)
    return found
