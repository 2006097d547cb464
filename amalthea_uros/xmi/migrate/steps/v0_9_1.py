"""0.9.0 -> 0.9.1."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step


def change(models: ModelSet, notes: Notes, official: bool) -> None:
    """Change the content of the files of AMALTHEA 0.9.0."""


STEP = Step("0.9.0", "0.9.1", change)
