"""3.0.0 -> 2.2.0."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step


def change(models: ModelSet, notes: Notes, official: bool) -> None:
    """Change the content of the files of AMALTHEA 3.0.0."""


STEP = Step("3.0.0", "2.2.0", change)
