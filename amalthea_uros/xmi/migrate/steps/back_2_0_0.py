"""2.1.0 -> 2.0.0: no local mode labels, no arithmetic on modes, fewer relations."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step

#: What 2.0.0 has no place for, by the class of the object.
_LOST_CLASSES = {
    "LocalModeCondition": "condition on a local mode label",
    "LocalModeLabelAssignment": "assignment to a local mode label",
    "ModeLabelAssignment": "assignment between a mode label and a local one",
    "ModeLabelEvent": "event of a mode label",
}

#: The same by tag, where the elements carry no `xsi:type`.
_LOST_TAGS = {
    "localLabels": "local mode label",
    "context": "context of a runnable call",
}

_NEW_RELATIONS = {"LESS_THAN_OR_EQUAL", "GREATER_THAN_OR_EQUAL"}


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 2.1.0."""
    lost = []
    for node in models.walk():
        what = _LOST_CLASSES.get(node.type) or _LOST_TAGS.get(node.tag)
        if what:
            notes.lost(node, f"{what}: only AMALTHEA 2.1.0 and later have it", node.name)
            lost.append(node)
        elif "relation" in node.attributes:
            _change_relation(node, notes)
    remove_all(lost)
    for node in models.nodes("semaphores"):
        _write_limit(node, notes)


def _change_relation(node: Node, notes: Notes) -> None:
    relation = node.get("relation")
    if node.type == "ChannelFillCondition":
        # What 2.0.0 compares the fill level by is stated nowhere.
        notes.lost(node, "relation of a condition on a fill level: only AMALTHEA 2.1.0 and later have it", relation, "relation")
        del node.attributes["relation"]
    elif relation in _NEW_RELATIONS:
        notes.lost(node, "relation of a condition: only AMALTHEA 2.1.0 and later have it", relation, "relation")


def _write_limit(node: Node, notes: Notes) -> None:
    """Write the limit of a semaphore where it is absent: that means 1 until now, and 0 in 2.0.0."""
    if "maxValue" not in node.attributes:
        node.attributes["maxValue"] = "1"
        notes.defaulted(node, "maxValue of a semaphore, of which the default is another one in 2.0.0", "1", "maxValue")


STEP = Step("2.1.0", "2.0.0", change)
