"""Steps back: 3.0.0 -> 2.2.0, 2.1.0 -> 2.0.0, 2.0.0 -> 1.2.0."""

from __future__ import annotations

from amalthea_uros.metamodel.kept_properties import OWNERSHIP
from amalthea_uros.xmi.migrate.steps.back_scheduling import change_scheduling
from amalthea_uros.xmi.migrate.steps.kept import TAGS, keep, references, refuse_stale
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import StepNotes

# 3.0.0 -> 2.2.0: data types of labels and channels are parts again, semaphores have no owner

#: Tag of the holder -> feature that refers to a type now, and was a part before.
_TYPED = {"labels": "dataType", "channels": "elementType"}


def change_3_0_0(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 3.0.0."""
    refuse_stale(models, notes, "3.0.0")
    for node in models.of_type("TypeRef"):
        # The step up drops it, because the reference is mandatory since 3.0.0.
        if not (node.references.get("typeDef") or node.get("typeDef")):
            notes.lost(node, "data type that refers to nothing")
    for tag, feature in _TYPED.items():
        for node in models.nodes(tag):
            _contain_type(node, feature, notes)
    for node in models.nodes("interfaces", "subInterfaces"):
        if node.rename("dataType", "datatype"):
            notes.renamed(node, "dataType -> datatype", attribute="dataType")
    for node in models.nodes("semaphores"):
        _change_semaphore(node, notes)


def _contain_type(node: Node, feature: str, notes: StepNotes) -> None:
    targets = node.references.pop(feature, None)
    if targets:
        node.add(feature, "TypeRef").refer("typeDef", *targets)
        notes.converted(node, f"{feature}: the reference became a TypeRef", targets[0].name, feature)


def _change_semaphore(node: Node, notes: StepNotes) -> None:
    if node.get("semaphoreType") == "Mutex":
        notes.lost(node, "semaphore type Mutex: only AMALTHEA 3.0.0 and later have it", attribute="semaphoreType")
    stated = node.attributes.pop("ownership", "true")
    # In 2.2.0 the type says it: nobody owns a counting semaphore.
    implied = "false" if node.get("semaphoreType") == "CountingSemaphore" else "true"
    if stated != implied:
        keep(node, OWNERSHIP, Node("value", "BooleanObject", {"value": stated}, node.origin))
        notes.kept(node, "ownership of a semaphore", stated, "ownership")


STEP_2_2_0 = Step("3.0.0", "2.2.0", change_3_0_0)


# 2.1.0 -> 2.0.0: no local mode labels, no arithmetic on modes, fewer relations

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


def change_2_1_0(models: ModelSet, notes: StepNotes) -> None:
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


def _change_relation(node: Node, notes: StepNotes) -> None:
    relation = node.get("relation")
    if node.type == "ChannelFillCondition":
        # What 2.0.0 compares the fill level by is stated nowhere.
        notes.lost(node, "relation of a condition on a fill level: only AMALTHEA 2.1.0 and later have it", relation, "relation")
        del node.attributes["relation"]
    elif relation in _NEW_RELATIONS:
        notes.lost(node, "relation of a condition: only AMALTHEA 2.1.0 and later have it", relation, "relation")


def _write_limit(node: Node, notes: StepNotes) -> None:
    """Write the limit of a semaphore where it is absent: that means 1 until now, and 0 in 2.0.0."""
    if "maxValue" not in node.attributes:
        node.attributes["maxValue"] = "1"
        notes.defaulted(node, "maxValue of a semaphore, of which the default is another one in 2.0.0", "1", "maxValue")


STEP_2_0_0 = Step("2.1.0", "2.0.0", change_2_1_0)


# 2.0.0 -> 1.2.0: scheduling algorithms are classes, conditions are conditions on modes

#: 2.0.0 has both kinds, 1.2.0 only those on modes; what else a condition can be about is lost.
_RENAMED = {
    "ConditionConjunction": "ModeConditionConjunction",
    "ConditionDisjunction": "ModeConditionDisjunction",
    "Switch": "ModeSwitch",
    "SwitchDefault": "ModeSwitchDefault",
    "SwitchEntry": "ModeSwitchEntry",
}


def change_2_0_0(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 2.0.0."""
    refuse_stale(models, notes, "2.0.0")
    _change_conditions(models, notes)
    _keep_tags(models, notes)
    change_scheduling(models, notes)


def _change_conditions(models: ModelSet, notes: StepNotes) -> None:
    lost = [node for node in models.walk() if node.type == "ChannelFillCondition"]
    for node in lost:
        notes.lost(node, "condition on the fill level of a channel: only AMALTHEA 2.0.0 and later have it")
    remove_all(lost)
    old = {node: node.type for node in models.walk() if node.type in _RENAMED}
    for node in models.rename_classes(_RENAMED):
        notes.renamed(node, f"{old[node]} -> {node.type}")


def _keep_tags(models: ModelSet, notes: StepNotes) -> None:
    for node in models.nodes("osOverheads"):
        tags = node.references.pop("tags", None)
        if tags:
            keep(node, TAGS, references(tags, node))
            notes.kept(node, "tags of an OS overhead", ", ".join(tag.name for tag in tags), "tags")


STEP_1_2_0 = Step("2.0.0", "1.2.0", change_2_0_0)
