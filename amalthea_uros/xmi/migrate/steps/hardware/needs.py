"""Instructions of runnables -> execution needs with the key `Instructions`."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.hardware.definitions import INSTRUCTIONS

_NEEDS = {"InstructionsConstant": "NeedConstant", "InstructionsDeviation": "NeedDeviation"}


def convert_instructions(models: ModelSet, notes: Notes) -> list[Node]:
    """Convert the instructions of runnables and schedulers, and return them."""
    found = models.of_type("RunnableInstructions")
    for item in found:
        item.type = "ExecutionNeed"
        for default in item.all("default"):
            _make_entry(default, notes)
        for extended in item.all("extended"):
            for value in extended.all("value"):
                _make_entry(value, notes)
        notes.converted(item, "instructions -> execution need with key 'Instructions'")
    return found


def _make_entry(instructions: Node, notes: Notes) -> None:
    """Put instructions as a need into an entry of the same tag."""
    if instructions.type not in _NEEDS and instructions.type:
        return
    entry = instructions.wrap(instructions.tag, key=INSTRUCTIONS)
    entry.comments, instructions.comments = instructions.comments, None
    instructions.tag = "value"
    kind = "InstructionsConstant" if instructions.child("deviation") is None else "InstructionsDeviation"
    instructions.type = _NEEDS[instructions.type or kind]
    for fetch in instructions.all("fetchStatistic"):
        if fetch.attributes or fetch.children:
            notes.lost(
                fetch, "'fetchStatistic' of instructions", ", ".join(f"{key}={text}" for key, text in fetch.attributes.items())
            )
        fetch.remove()
