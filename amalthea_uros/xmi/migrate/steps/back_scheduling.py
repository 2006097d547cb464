"""2.0.0 -> 1.2.0, scheduling: definitions become algorithm classes, and parameters the attributes of these and of the allocations.

What the classes cannot hold becomes custom properties, which `restored` turns back: the content of the definitions at the OS model,
the name of a definition that is no class at the scheduler, other parameters at the allocation or scheduler.
"""

from __future__ import annotations

from collections.abc import Iterable

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.back_parameters import (
    ALGORITHMS,
    change_parameters,
    name_of,
    place_in_algorithm,
    place_in_allocation,
    write_defaults,
)
from amalthea_uros.xmi.migrate.steps.definition_maps import PARAMETER_LISTS, as_map
from amalthea_uros.xmi.migrate.steps.kept import keep, kept, prefix
from amalthea_uros.xmi.migrate.steps.properties import text_value
from amalthea_uros.xmi.migrate.steps.restored import DEFINITION, DEFINITIONS, OF_ASSOCIATION, OWN, PROPERTY
from amalthea_uros.xmi.migrate.steps.scheduling_definitions import PRIORITY, QUANTIZED, USER_SPECIFIC
from amalthea_uros.xmi.migrate.steps.standard_definitions import are_standard

_SCHEDULER, _PARAMETER = DEFINITIONS

#: Custom properties of processes.
_TAKEN_FOR_PARAMETERS = {PRIORITY, "osekTaskGroup"}


def change_scheduling(models: ModelSet, notes: Notes) -> None:
    """Turn definitions and parameters into what 1.2.0 has."""
    definitions, parameters = models.nodes(_SCHEDULER), models.nodes(_PARAMETER)
    for same_kind in (definitions, parameters):
        _refuse_ambiguous(same_kind, notes)
    is_standard = _is_standard(models)
    _rename_properties(models.nodes("tasks", "isrs"), notes)
    for node in models.nodes("taskAllocation"):
        write_defaults(node, node, OWN, node.target("scheduler"), "processParameters", notes)
        change_parameters(node, node, OWN, place_in_allocation, notes)
    schedulers = models.nodes("taskSchedulers", "interruptControllers")
    for node in schedulers:
        for association in node.all("parentAssociation"):
            write_defaults(association, node, OF_ASSOCIATION, association.target("parent"), "processParameters", notes)
            change_parameters(association, node, OF_ASSOCIATION, place_in_allocation, notes)
    for node in schedulers:
        _change_scheduler(node, notes)
    if not (is_standard and _are_complete(schedulers, models.nodes("taskAllocation"))):
        for node in (*definitions, *parameters):
            _keep_definition(node, notes)
    remove_all((*definitions, *parameters))


def _is_standard(models: ModelSet) -> bool:
    """Whether the step up makes the same definitions, if nothing but the classes and attributes of 1.2.0 is there."""
    definitions = [node.target("definition") for node in models.nodes("taskSchedulers", "interruptControllers")]
    algorithms = [definition.name for definition in definitions if definition is not None]
    keys = [node.target("key") for node in models.nodes("schedulingParameters")]
    return are_standard(models, algorithms, [key.name for key in keys if key is not None])


def _are_complete(schedulers: list[Node], allocations: list[Node]) -> bool:
    """Whether the classes and attributes of 1.2.0 say everything, and nothing was kept."""
    algorithms = [algorithm for scheduler in schedulers for algorithm in scheduler.all("schedulingAlgorithm")]
    if any(algorithm.type in QUANTIZED and "quantSizeNs" not in algorithm.attributes for algorithm in algorithms):
        return False  # other tools may write the default 0, which the step up takes for none only where definitions were kept
    return not any(kept(node, prefix("2.0.0")) for node in (*schedulers, *allocations))


def _rename_properties(processes: Iterable[Node], notes: Notes) -> None:
    """Rename custom properties that mean nothing since 2.0.0, and of which the step up would make parameters."""
    for process in processes:
        for node in process.all("customProperties"):
            key = node.get("key")
            if key in _TAKEN_FOR_PARAMETERS:
                node.attributes["key"] = PROPERTY + key
                notes.renamed(process, "custom property that is a scheduling parameter in older versions", key)


def _refuse_ambiguous(definitions: Iterable[Node], notes: Notes) -> None:
    """Definitions are kept by name, so each needs its own."""
    names: set[str] = set()
    for node in definitions:
        if not node.name or node.name in names:
            notes.lost(node, "definition without a unique name: in AMALTHEA 1.2.0, the name tells it", repr(node.name), "name")
        names.add(node.name)


def _change_scheduler(scheduler: Node, notes: Notes) -> None:
    definition = scheduler.target("definition")
    algorithm = None
    write_defaults(scheduler, scheduler, OWN, scheduler, "algorithmParameters", notes)
    if definition is not None:
        del scheduler.references["definition"]
        algorithm = _add_algorithm(scheduler, definition, notes)

    def place(_holder: Node, name: str, value: Node) -> bool:
        return algorithm is not None and place_in_algorithm(algorithm, name, value)

    change_parameters(scheduler, scheduler, OWN, place, notes)


def _add_algorithm(scheduler: Node, definition: Node, notes: Notes) -> Node | None:
    if definition.tag != _SCHEDULER:
        notes.lost(scheduler, "the definition of the scheduler is in none of the files", name_of(definition), "definition")
        return None
    if definition.name in ALGORITHMS[scheduler.tag]:
        made = scheduler.add("schedulingAlgorithm", definition.name)
    else:
        made = scheduler.add("schedulingAlgorithm", USER_SPECIFIC)
        keep(scheduler, DEFINITION, text_value(definition.name, scheduler))
    notes.converted(scheduler, "scheduler definition -> algorithm class", f"{definition.name} -> {made.type}", "definition")
    return made


def _keep_definition(node: Node, notes: Notes) -> None:
    holder = node.parent
    if holder is None:
        return
    for name in PARAMETER_LISTS:
        for target in node.references.get(name, ()):
            if target.tag != _PARAMETER:
                notes.lost(node, "a parameter of the scheduler definition is in none of the files", name_of(target), name)

    def report(part: Node) -> None:
        notes.lost(part, "unknown part of a definition")

    keep(holder, DEFINITIONS[node.tag] + node.name, as_map(node, report)).comments = node.comments
    notes.kept(node, "definition of a scheduler or scheduling parameter", node.name)
