"""0.9.0 -> 0.9.1: times in custom properties."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step


def change(models: ModelSet, notes: Notes, official: bool) -> None:
    """Change the content of the files of AMALTHEA 0.9.0."""
    for node in models.of_type("TimeObject"):
        if not official or _is_value_of_property(node):
            node.type = "Time"
            notes.renamed(node, "TimeObject -> Time")


def _is_value_of_property(node: Node) -> bool:
    return node.tag in ("value", "values") and node.enclosing("customProperties") is not None


STEP = Step("0.9.0", "0.9.1", change, frozenset({"TimeObject"}))
