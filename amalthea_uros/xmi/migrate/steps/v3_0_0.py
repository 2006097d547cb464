"""2.2.0 -> 3.0.0: one kind of switches, and data types by reference."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.data_types import convert_data_types
from amalthea_uros.xmi.migrate.steps.restored import restore_3_0_0

#: Classes of conditions and switches; most of them are written only where the class differs from that of the feature.
_RENAMED = {
    "ModeSwitch": "Switch",
    "ModeSwitchEntry": "SwitchEntry",
    "ModeSwitchDefault": "SwitchDefault",
    "ModeConditionConjunction": "ConditionConjunction",
    "ModeConditionDisjunction": "ConditionDisjunction",
}


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 2.2.0."""
    for node in models.rename_classes(_RENAMED):
        notes.renamed(node, f"class is now {node.type}")
    convert_data_types(models, notes)
    for interface in models.nodes("interfaces", "subInterfaces"):
        if interface.rename("datatype", "dataType"):
            notes.renamed(interface, "datatype of the interface is now its dataType", "", "datatype")
    # Without it the new default would hold: only the owner may release it.
    for semaphore in models.nodes("semaphores"):
        if semaphore.get("semaphoreType") == "CountingSemaphore" and "ownership" not in semaphore.attributes:
            semaphore.attributes["ownership"] = "false"
            notes.defaulted(semaphore, "counting semaphore: it has no owner, so ownership is false", "", "ownership")
    restore_3_0_0(models, notes)


STEP = Step("2.2.0", "3.0.0", change, frozenset(_RENAMED))
