"""Algorithms and parameters of schedulers and allocations -> what refers to definitions."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.numbers import whole_number
from amalthea_uros.xmi.migrate.steps.properties import add_property, move_properties
from amalthea_uros.xmi.migrate.steps.scheduling_definitions import (
    BUDGETS,
    EXTENDED,
    PRIORITY,
    QUANTUM,
    USER_SPECIFIC,
    Definitions,
)
from amalthea_uros.xmi.migrate.steps.v0_9_parts import keep_comments

_TAG = "schedulingParameters"

#: The size of a quantum, which has no unit.
_QUANTUM_NS = "quantSizeNs"


def convert_algorithms(models: ModelSet, definitions: Definitions, notes: Notes) -> None:
    """Let schedulers refer to a definition of their algorithm."""
    for algorithm in models.nodes("schedulingAlgorithm"):
        scheduler = algorithm.parent
        if scheduler is None:
            continue
        algorithm.remove()
        keep_comments(algorithm, scheduler)
        if scheduler.references.get("definition"):
            notes.lost(scheduler, "second scheduling algorithm", algorithm.type)
            continue
        _set_definition(scheduler, algorithm, definitions, notes)
        _convert_quantum(scheduler, algorithm, definitions, notes)
        for extension in algorithm.all("parameterExtensions"):
            _convert_extension(scheduler, extension, definitions, notes)
        move_properties(algorithm, scheduler)
        _note_unknown(scheduler, algorithm, notes)


def _set_definition(scheduler: Node, algorithm: Node, definitions: Definitions, notes: Notes) -> None:
    if not algorithm.type:
        notes.lost(scheduler, "scheduling algorithm without a class")
        return
    if algorithm.type == USER_SPECIFIC:
        keys = [extension.get("key") for extension in algorithm.all("parameterExtensions")]
        scheduler.refer("definition", definitions.user_specific(keys, algorithm))
    else:
        scheduler.refer("definition", definitions.scheduler(algorithm.type, algorithm))
    notes.converted(scheduler, "scheduling algorithm is now a reference to a scheduler definition", algorithm.type)


def _convert_quantum(scheduler: Node, algorithm: Node, definitions: Definitions, notes: Notes) -> None:
    """The size of the quantum was an attribute; steps from older versions may have kept it as an extension."""
    texts = [algorithm.attributes.pop(_QUANTUM_NS)] if _QUANTUM_NS in algorithm.attributes else []
    if algorithm.type != USER_SPECIFIC:
        for extension in algorithm.all("parameterExtensions"):
            if extension.get("key") == _QUANTUM_NS and not texts:
                extension.remove()
                keep_comments(extension, scheduler)
                texts.append(extension.get("value"))
    for text in texts:
        if whole_number(text) is None:
            add_property(scheduler, _QUANTUM_NS, text)
            notes.kept(scheduler, "size of the quantum is not a number", text)
        else:
            add_parameter(scheduler, QUANTUM, definitions, "Time", value=text, unit="ns")
            notes.converted(scheduler, "size of the quantum is now a scheduling parameter", f"{text} ns")


def convert_parameters(models: ModelSet, definitions: Definitions, notes: Notes) -> None:
    """Give allocations and associations their parameters by definitions."""
    for holder in models.nodes("taskAllocation", "parentAssociation"):
        for parameters in holder.all(_TAG):
            if not (parameters.references.get("key") or "key" in parameters.attributes or parameters.child("value")):
                parameters.remove()
                keep_comments(parameters, holder)
                _convert_fixed(holder, parameters, definitions, notes)
        for extension in holder.all("parameterExtensions"):
            _convert_extension(holder, extension, definitions, notes)


def _convert_fixed(holder: Node, old: Node, definitions: Definitions, notes: Notes) -> None:
    """Convert the parameters that had features of their own."""
    priority = old.attributes.pop(PRIORITY, None)
    if priority is not None:
        add_parameter(holder, PRIORITY, definitions, "IntegerObject", value=priority)
        notes.converted(holder, "priority is now a scheduling parameter with a definition", priority)
    for name in BUDGETS:
        for time in old.all(name):
            time.remove()
            added = add_parameter(holder, name, definitions)
            time.tag, time.type = "value", "Time"
            added.insert(time)
            notes.converted(holder, f"{name} is now a scheduling parameter with a definition")
    _note_unknown(holder, old, notes)


def _note_unknown(holder: Node, old: Node, notes: Notes) -> None:
    for name in (*old.attributes, *old.references, *(part.tag for part in old.children)):
        notes.lost(holder, "unknown scheduling parameter", name)


def _convert_extension(holder: Node, extension: Node, definitions: Definitions, notes: Notes) -> None:
    extension.remove()
    name = EXTENDED + extension.get("key")
    added = add_parameter(holder, name, definitions, "StringObject", value=extension.get("value"))
    keep_comments(extension, added)
    notes.converted(holder, "parameter extension is now a scheduling parameter with a definition", extension.get("key"))


def parameter_of(holder: Node, name: str) -> Node | None:
    """The parameter of that name, None if it is not stated."""
    for parameters in holder.all(_TAG):
        key = parameters.target("key")
        if key is not None and (key.name or key.get("path")) == name:
            return parameters
    return None


def add_parameter(holder: Node, name: str, definitions: Definitions, type_name: str = "", /, **value: str) -> Node:
    """State a parameter, by default without a value."""
    added = holder.add(_TAG)
    added.refer("key", definitions.parameter(name, added))
    if type_name:
        added.add("value", type_name).attributes.update(value)
    return added
