"""0.8.0 -> 0.8.1: names of stimuli, priorities, scheduling units, inner event chains, quartzes."""

from __future__ import annotations

from amalthea_uros.metamodel.naming import TYPE_MARK
from amalthea_uros.xmi.migrate.classes import class_of
from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.names import reference_text
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.properties import add_value
from amalthea_uros.xmi.migrate.steps.v0_8_event_chains import contain_event_chains
from amalthea_uros.xmi.migrate.steps.v0_8_priorities import move_priorities
from amalthea_uros.xmi.migrate.steps.v0_8_schedulers import change_schedulers

_TRIGGER = "InterProcessTrigger"
_STIMULUS = "InterProcessStimulus"

_CLASSES = {
    "ArrivalCurve": "ArrivalCurveStimulus",
    "InterProcess": _STIMULUS,
    "InterProcessActivation": _TRIGGER,
    "Periodic": "PeriodicStimulus",
    "PeriodicEvent": "VariableRateStimulus",
    "ProcessRunnableGroup": "RunnableEntityGroup",
    "Single": "SingleStimulus",
    "Sporadic": "SporadicStimulus",
    "Synthetic": "SyntheticStimulus",
}

_STIMULI = frozenset(_CLASSES) - {"InterProcessActivation", "ProcessRunnableGroup"}

_OLD_NAMES = {new: old for old, new in _CLASSES.items()}

#: Sub-model and tag of objects, their class ("" for any) -> attribute or reference, and its new name.
_RENAMED = (
    ("swModel", "runnables", "", "activation", "activations"),
    ("swModel", "activations", "EventActivation", "trigger", "triggeringEvents"),
    ("stimuliModel", "stimuli", "EventStimulus", "trigger", "triggeringEvents"),
    ("mappingModel", "coreAllocation", "", "core", "responsibility"),
)

_MODE_VALUE_LISTS = ("setModeValueList", "enablingModeValueList", "disablingModeValueList")

#: What a quartz could contain as long as it was a node of the hardware like others.
_PARTS_OF_QUARTZ = ("components", "memories", "networks", "ports", "prescaler")


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA 0.8.0."""
    for node in models.rename_classes(_CLASSES):
        notes.renamed(node, "class renamed", f"{_OLD_NAMES[node.type]} -> {node.type}")
    _rename_in_texts(models, notes)
    _change_triggers(models, notes)
    _rename_features(models, notes)
    _type_mode_values(models, notes)
    _type_label_groups(models, notes)
    _keep_deadlines(models, notes)
    move_priorities(models, notes)
    change_schedulers(models, notes)
    contain_event_chains(models, notes)
    _change_hardware(models, notes)


def _rename_in_texts(models: ModelSet, notes: Notes) -> None:
    """Rename the classes of stimuli in references that are texts of custom properties."""
    for node in models.nodes("value", "values"):
        before, mark, name = node.get("value").partition(TYPE_MARK)
        if name not in _STIMULI or not node.type or node.enclosing("customProperties") is None:
            continue
        node.attributes["value"] = f"{before}{mark}{_CLASSES[name]}"
        notes.renamed(node, "class renamed in the text of a custom property", f"{name} -> {_CLASSES[name]}", "value")


def _change_triggers(models: ModelSet, notes: Notes) -> None:
    """From 0.8.1 on, a process can trigger others by inter-process stimuli only."""
    for trigger in models.nodes("calls"):
        stimulus = trigger.target("stimulus")
        if trigger.type != _TRIGGER or stimulus is None:
            continue
        if class_of(stimulus) not in (_STIMULUS, ""):
            _take_other_stimulus(trigger, stimulus, notes)


def _take_other_stimulus(trigger: Node, stimulus: Node, notes: Notes) -> None:
    del trigger.references["stimulus"]
    value = Node("value", "ReferenceObject", origin=trigger.origin)
    value.refer("value", stimulus)
    add_value(trigger, "stimulus", value)
    notes.kept(trigger, "triggered stimulus that is not an inter-process stimulus", reference_text(stimulus), "stimulus")


def _rename_features(models: ModelSet, notes: Notes) -> None:
    for model, tag, class_name, old, new in _RENAMED:
        for node in models.parts(model, tag):
            if class_name in (node.type, "") and node.rename(old, new):
                notes.renamed(node, f"{old} -> {new}", attribute=old)
    for allocation in models.parts("mappingModel", "coreAllocation"):
        allocation.tag = "schedulerAllocation"
        notes.renamed(allocation, "coreAllocation -> schedulerAllocation")


def _type_mode_values(models: ModelSet, notes: Notes) -> None:
    for name in _MODE_VALUE_LISTS:
        for entry in models.parts("stimuliModel", "stimuli", name, "entries"):
            if entry.type in ("", "ModeValueListEntry"):
                entry.type = "ModeValue"
                notes.renamed(entry, "class renamed", "ModeValueListEntry -> ModeValue")


def _type_label_groups(models: ModelSet, notes: Notes) -> None:
    """State the class of the labels of a pairing constraint: there is a second kind of groups now."""
    for constraint in models.parts("constraintsModel", "affinityConstraints"):
        for group in constraint.all("group") if constraint.type == "DataPairingConstraint" else ():
            if not group.type:
                group.type = "LabelEntityGroup"
                notes.renamed(group, "class of a group of labels is stated: LabelEntityGroup")


def _keep_deadlines(models: ModelSet, notes: Notes) -> None:
    for activation in models.parts("swModel", "activations"):
        deadline = activation.child("deadline")
        if activation.type == "PeriodicActivation" and deadline is not None:
            notes.kept(deadline, "deadline of a periodic activation", deadline.get("value") + deadline.get("unit"))
            deadline.type = "TimeObject"
            add_value(activation, "deadline", deadline)


def _change_hardware(models: ModelSet, notes: Notes) -> None:
    for memory in models.parts("hwModel", "memoryTypes"):
        pattern = memory.attributes.pop("xAccessPattern", None)
        if pattern is not None:
            notes.lost(memory, "access pattern of a memory type", pattern, "xAccessPattern")
    for root in models.roots:
        systems = root.find("hwModel", "system")
        if systems:
            _collect_quartzes(systems, notes)


def _collect_quartzes(systems: list[Node], notes: Notes) -> None:
    """All quartzes of a file become parts of the system, and have no parts of the hardware any more."""
    home = systems[0]
    quartzes = [node for system in systems for node in system.walk() if node.tag == "quartzes"]
    if any(quartz.parent is not home for quartz in quartzes):
        for quartz in quartzes:
            if quartz.parent is not home:
                notes.moved(quartz, "quartz -> system", quartz.name)
        home.take(quartzes)
    for quartz in quartzes:
        parts = quartz.all(*_PARTS_OF_QUARTZ)
        for part in parts:
            notes.lost(part, f"{part.tag} of a quartz", part.name)
        remove_all(parts)


STEP = Step(
    "0.8.0", "0.8.1", change, frozenset({*_CLASSES, "SchedulingHWUnit", "SchedulingSWUnit", "schedulingUnit", "coreAllocation"})
)
