"""2.0.0 -> 1.2.0: scheduling algorithms are classes, conditions are conditions on modes."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.back_scheduling import change_scheduling
from amalthea_uros.xmi.migrate.steps.kept import keep, references, refuse_stale
from amalthea_uros.xmi.migrate.steps.restored import TAGS

#: 2.0.0 has both kinds, 1.2.0 only those on modes; what else a condition can be about is lost.
_RENAMED = {
    "ConditionConjunction": "ModeConditionConjunction",
    "ConditionDisjunction": "ModeConditionDisjunction",
    "Switch": "ModeSwitch",
    "SwitchDefault": "ModeSwitchDefault",
    "SwitchEntry": "ModeSwitchEntry",
}


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 2.0.0."""
    refuse_stale(models, notes, "2.0.0")
    _change_conditions(models, notes)
    _keep_tags(models, notes)
    change_scheduling(models, notes)


def _change_conditions(models: ModelSet, notes: Notes) -> None:
    lost = [node for node in models.walk() if node.type == "ChannelFillCondition"]
    for node in lost:
        notes.lost(node, "condition on the fill level of a channel: only AMALTHEA 2.0.0 and later have it")
    remove_all(lost)
    old = {node: node.type for node in models.walk() if node.type in _RENAMED}
    for node in models.rename_classes(_RENAMED):
        notes.renamed(node, f"{old[node]} -> {node.type}")


def _keep_tags(models: ModelSet, notes: Notes) -> None:
    for node in models.nodes("osOverheads"):
        tags = node.references.pop("tags", None)
        if tags:
            keep(node, TAGS, references(tags, node))
            notes.kept(node, "tags of an OS overhead", ", ".join(tag.name for tag in tags), "tags")


STEP = Step("2.0.0", "1.2.0", change)
