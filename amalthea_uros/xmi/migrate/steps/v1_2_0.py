"""1.1.0 -> 1.2.0: numbers of occurrences are positive."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.numbers import make_positive


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 1.1.0."""
    for stimulus in models.of_type("PeriodicBurstStimulus"):
        make_positive(stimulus, "occurrenceCount", notes)
    for curve in models.of_type("ArrivalCurveStimulus"):
        for entry in curve.all("entries"):
            make_positive(entry, "numberOfOccurrences", notes)


STEP = Step("1.1.0", "1.2.0", change)
