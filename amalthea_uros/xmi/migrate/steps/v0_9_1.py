"""0.9.0 -> 0.9.1: times in custom properties."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 0.9.0."""
    for node in models.of_type("TimeObject"):
        node.type = "Time"
        notes.renamed(node, "TimeObject -> Time")


STEP = Step("0.9.0", "0.9.1", change, frozenset({"TimeObject"}))
