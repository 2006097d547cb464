"""3.0.0 -> 2.2.0: data types of labels and channels are parts again, semaphores have no owner."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.kept import keep, refuse_stale
from amalthea_uros.xmi.migrate.steps.restored import OWNERSHIP

#: Tag of the holder -> feature that refers to a type now, and was a part before.
_TYPED = {"labels": "dataType", "channels": "elementType"}


def change(models: ModelSet, notes: Notes) -> None:
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


def _contain_type(node: Node, feature: str, notes: Notes) -> None:
    targets = node.references.pop(feature, None)
    if targets:
        node.add(feature, "TypeRef").refer("typeDef", *targets)
        notes.converted(node, f"{feature}: the reference became a TypeRef", targets[0].name, feature)


def _change_semaphore(node: Node, notes: Notes) -> None:
    if node.get("semaphoreType") == "Mutex":
        notes.lost(node, "semaphore type Mutex: only AMALTHEA 3.0.0 and later have it", attribute="semaphoreType")
    stated = node.attributes.pop("ownership", "true")
    # In 2.2.0 the type says it: nobody owns a counting semaphore.
    implied = "false" if node.get("semaphoreType") == "CountingSemaphore" else "true"
    if stated != implied:
        keep(node, OWNERSHIP, Node("value", "BooleanObject", {"value": stated}, node.origin))
        notes.kept(node, "ownership of a semaphore", stated, "ownership")


STEP = Step("3.0.0", "2.2.0", change)
