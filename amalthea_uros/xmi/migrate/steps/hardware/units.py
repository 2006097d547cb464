"""Units that old hardware models did not state, but meant."""

from __future__ import annotations

from collections.abc import Callable

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes

_UNSTATED = ("", "_undefined_")


def state_units(models: ModelSet, notes: Notes) -> None:
    """State that the frequencies of what was a quartz are in Hz, and the sizes of what was a memory type in bytes.

    APP4MC made both from plain numbers, without unit, and corrected its examples by hand in this sense. Its converters leave the unit
    open; so this is done after the last version for which their results are known.
    """
    labels = models.origins.labels

    def was(tag: str) -> Callable[[Node], bool]:
        return lambda node: node.origin >= 0 and labels[node.origin][0] == tag

    for tag, old, part, unit in (("domains", "quartzes", "defaultValue", "Hz"), ("definitions", "memoryTypes", "size", "B")):
        for holder in filter(was(old), models.parts("hwModel", tag)):
            quantity = holder.child(part)
            if quantity is not None and quantity.get("value") and quantity.get("unit") in _UNSTATED:
                quantity.attributes["unit"] = unit
                notes.defaulted(quantity, f"{part!r} without unit: in {unit}", quantity.get("value"), "unit")
