"""2.0.0 -> 2.1.0: tightened limits."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.numbers import make_positive, whole_number
from amalthea_uros.xmi.migrate.steps.v0_9_6 import CONDITIONS, conditions_below


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 2.0.0."""
    for semaphore in models.nodes("semaphores"):
        make_positive(semaphore, "maxValue", notes)
        initial = whole_number(semaphore.get("initialValue", "0"))
        if initial is not None and initial < 0:
            notes.to_check(semaphore, "initialValue must not be negative", str(initial), "initialValue")
    for mapping in models.nodes("memoryMapping"):
        if not (mapping.references.get("memory") or mapping.get("memory")):
            notes.to_check(mapping, "memory mapping without a memory, which is mandatory now")
    for holder in models.nodes(*CONDITIONS):
        for condition in conditions_below(holder):
            if condition.type == "ChannelFillCondition" and not condition.get("relation"):
                notes.to_check(condition, "fill level of a channel: how it is compared has to be stated now", "", "relation")


STEP = Step("2.0.0", "2.1.0", change)
