"""2.0.0 -> 2.1.0, tightened limits, and 2.2.0 -> 3.0.0: one kind of switches, and data types by reference."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from typing import TypeAlias

from amalthea_uros.xmi.migrate.steps.kept import restore_3_0_0
from amalthea_uros.xmi.migrate.steps.tools import keep_comments, make_positive, move_properties, whole_number
from amalthea_uros.xmi.migrate.steps.v0_9_7 import CONDITIONS, conditions_below
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import StepNotes


def change_2_0_0(models: ModelSet, notes: StepNotes) -> None:
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
                notes.to_check(condition, "fill level of a channel: the relation must now be specified", "", "relation")


STEP_2_1_0 = Step("2.0.0", "2.1.0", change_2_0_0)


# Data types that labels and channels contained until 2.2.0, and to which they refer since 3.0.0

#: Everything that a type states.
_Content: TypeAlias = tuple[object, ...]

#: Where types are contained until 2.2.0, and are references since 3.0.0.
_FEATURES = {"labels": "dataType", "channels": "elementType"}


def convert_data_types(models: ModelSet, notes: StepNotes) -> None:
    """Let labels and channels refer to definitions; what they contained becomes a definition of its own."""
    _drop_empty(models, notes)
    definitions = _Definitions(models)
    for tag, feature in _FEATURES.items():
        for owner in models.nodes(tag):
            for part in owner.all(feature):
                _convert(owner, feature, part, definitions, notes)


def _drop_empty(models: ModelSet, notes: StepNotes) -> None:
    """Remove references without a target, which are mandatory now."""
    for node in models.nodes("dataType", "elementType"):
        if node.type == "TypeRef" and not (node.references.get("typeDef") or node.get("typeDef")) and node.parent is not None:
            move_properties(node, node.parent)
            keep_comments(node, node.parent)
            notes.lost(node.parent, "data type that refers to nothing")
            node.remove()


def _convert(owner: Node, feature: str, part: Node, definitions: _Definitions, notes: StepNotes) -> None:
    part.remove()
    if feature in owner.references or feature in owner.attributes:
        move_properties(part, owner)
        keep_comments(part, owner)
        notes.lost(owner, "second data type", part.type)
    elif part.type == "TypeRef":
        move_properties(part, owner)
        keep_comments(part, owner)
        targets = part.references.get("typeDef")
        if targets:
            owner.refer(feature, targets[0])
        else:
            owner.attributes[feature] = part.get("typeDef")
        notes.converted(owner, "data type is now a reference to the type definition", "", feature)
    else:
        definition = definitions.of(owner, part)
        owner.refer(feature, definition)
        notes.converted(owner, "data type is now a separate type definition", definition.name, feature)


class _Definitions:
    """The definitions made of contained types; equal types of one file share one."""

    def __init__(self, models: ModelSet) -> None:
        self.made: dict[_Content, Node] = {}
        self.numbers: dict[str, Iterator[int]] = {}
        self.names = {definition.name for tree in models.trees for definition in tree.root.find("swModel", "typeDefinitions")}

    def of(self, owner: Node, part: Node) -> Node:
        """The definition of a type that has left its owner."""
        root = owner.root
        key = (root, *_content(part))
        found = self.made.get(key)
        if found is None:
            model = root.child_or_new("swModel", like=owner)
            found = model.add(
                "typeDefinitions", "DataTypeDefinition", like=part, name=self.new_name(f"{owner.name or owner.tag}_type")
            )
            part.tag = "dataType"
            found.insert(part)
            self.made[key] = found
        else:
            keep_comments(part, owner)
        return found

    def new_name(self, base: str) -> str:
        """A name that no definition has."""
        name = base
        for number in self.numbers.setdefault(base, count(2)) if base in self.names else ():
            name = f"{base}_{number}"
            if name not in self.names:
                break
        self.names.add(name)
        return name


def _content(node: Node) -> _Content:
    references = sorted((name, tuple(targets)) for name, targets in node.references.items())
    inner = tuple((child.tag, *_content(child)) for child in node.children)
    return (node.type, tuple(sorted(node.attributes.items())), tuple(references), inner)


#: Classes of conditions and switches; most of them are written only where the class differs from that of the feature.
_RENAMED = {
    "ModeSwitch": "Switch",
    "ModeSwitchEntry": "SwitchEntry",
    "ModeSwitchDefault": "SwitchDefault",
    "ModeConditionConjunction": "ConditionConjunction",
    "ModeConditionDisjunction": "ConditionDisjunction",
}


def change_2_2_0(models: ModelSet, notes: StepNotes) -> None:
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


STEP_3_0_0 = Step("2.2.0", "3.0.0", change_2_2_0, frozenset(_RENAMED))
