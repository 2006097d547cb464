"""Definitions that the step up makes of the algorithm classes anyway, so that nothing of them needs to be kept."""

from __future__ import annotations

from pathlib import Path
from typing import TypeAlias

from amalthea_uros.xmi.files import FileText
from amalthea_uros.xmi.migrate.model_set import ModelSet, Origins, Tree
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.scheduling_definitions import Definitions

#: What a definition says: tag, attributes, names of the parameters that it refers to.
_Content: TypeAlias = tuple[str, dict[str, str], dict[str, list[str]]]


def are_standard(models: ModelSet, algorithms: list[str], parameters: list[str]) -> bool:
    """Whether the definitions of the files are those that the step up makes for these algorithms and parameters, there and so."""
    tags = ("schedulerDefinitions", "schedulingParameterDefinitions")
    present = models.nodes(*tags)
    place = next((model for root in models.roots if (model := root.child("osModel")) is not None), None)
    if any(node.parent is not place or node.type or node.comments or node.children for node in present):
        return False
    root = Node("Amalthea")
    made_in = root.add("osModel")
    definitions = Definitions(ModelSet([Tree(Path(), FileText(""), "2.0.0", root)], Origins()))
    for name in algorithms:
        definitions.scheduler(name, root)
    for name in parameters:
        definitions.parameter(name, root)
    definitions.insert(Notes())
    return list(map(_content, present)) == [_content(node) for tag in tags for node in made_in.all(tag)]


def _content(node: Node) -> _Content:
    return node.tag, node.attributes, {name: [target.name for target in targets] for name, targets in node.references.items()}
