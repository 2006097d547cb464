"""0.7.2 -> 0.8.0: memory mapping, units, signed times, and property constraints."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.steps.file_roots import wrap_roots
from amalthea_uros.xmi.migrate.steps.tools import (
    content_of,
    keep_as_properties,
    names_of,
    removed_key,
    xml_text,
)
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import StepNotes

_UNITS = {"kibit": "Kibit", "byte": "B", "kibitPerSecond": "KibitPerSecond", "bytePerSecond": "BPerSecond"}

_TIMES = {"SignedTime": "Time", "SignedTimeObject": "TimeObject"}

#: Abstract classes; concrete ones keep their names.
_RENAMED_CLASSES = {"AllocationConstraint": "CoreAllocationConstraint", "MappingConstraint": "MemoryMappingConstraint"}


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA 0.7.2."""
    wrap_roots(models, notes)
    for mapping in models.parts("mappingModel", "mapping"):
        if mapping.type in ("AbstractElementMapping", ""):
            mapping.tag, mapping.type = "memoryMapping", ""
            notes.renamed(mapping, "mapping -> memoryMapping")
    _change_values(models, notes)
    for label in models.nodes("modeLabels"):
        _drop_mode(models, label, notes)
    for os_model in models.parts("osModel"):
        _distribute_consistency(os_model, notes)
    for constraint in models.nodes("allocationConstraints", "mappingConstraints"):
        _keep_hardware_constraint(constraint, notes)
    for found in models.rename_classes(_RENAMED_CLASSES):
        notes.renamed(found, f"abstract class -> {found.type}")


def _change_values(models: ModelSet, notes: StepNotes) -> None:
    """Classes and units that occur in many places."""
    for node in models.index.all():
        if "unit" in node.attributes and (unit := node.attributes["unit"]) in _UNITS:
            node.attributes["unit"] = _UNITS[unit]
            notes.renamed(node, f"unit {unit} -> {_UNITS[unit]}", attribute="unit")
    for node in models.of_type(*_TIMES):
        notes.renamed(node, f"{node.type} -> {_TIMES[node.type]}")
        node.type = _TIMES[node.type]
    for node in models.of_type("ProbabiltitySwitch"):
        node.type = "ProbabilitySwitch"
        notes.renamed(node, "ProbabiltitySwitch -> ProbabilitySwitch")


def _drop_mode(models: ModelSet, label: Node, notes: StepNotes) -> None:
    """The mode of a mode label follows from its initial value."""
    if text := label.attributes.pop("mode", ""):
        notes.lost(label, "mode of a mode label that is no reference", text, "mode")
    mode = label.references.pop("mode", None)
    if mode is None:
        return
    initial = label.target("initialValue")
    if initial is not None and initial.parent is not None and initial.parent not in mode:
        notes.lost(label, "mode of a mode label: that of its initial value is another one", names_of(mode), "mode")
    elif initial is not None:
        notes.converted(label, "mode of a mode label -> mode of its initial value", names_of(mode), "mode")
    else:
        models.set_aside[label, "mode"] = mode


def _distribute_consistency(os_model: Node, notes: StepNotes) -> None:
    """Every operating system says on its own how it keeps data consistent."""
    systems = os_model.all("operatingSystems")
    for consistency in os_model.all("osDataConsistency"):
        consistency.remove()
        without = [system for system in systems if system.child("osDataConsistency") is None]
        for system in without:
            system.insert(consistency.copy())
        if without:
            notes.moved(consistency, "osDataConsistency -> every operating system that has none")
        elif content := content_of(consistency):
            why = "every operating system has its own" if systems else "there is no operating system"
            notes.lost(consistency, f"osDataConsistency: {why}", content)


def _keep_hardware_constraint(constraint: Node, notes: StepNotes) -> None:
    """Keep the text of conditions for the hardware, which have no successor."""
    conditions = constraint.all("hwConstraint")
    if not conditions:
        return
    key = removed_key("hwConstraint", "0.8.0")
    keep_as_properties(constraint, [(key, xml_text(condition)) for condition in conditions])
    for condition in conditions:
        notes.kept(condition, "condition for the hardware of a property constraint", condition.type)
    remove_all(conditions)


STEP = Step(
    "0.7.2",
    "0.8.0",
    change,
    frozenset(
        {
            *("hwConstraint", "mapping", "AbstractElementMapping", "ProbabiltitySwitch"),
            *("HwCoreConjunction", "HwCoreProperty", "HwMemoryConjunction", "HwMemoryProperty"),
            *_TIMES,
        }
    ),
)
