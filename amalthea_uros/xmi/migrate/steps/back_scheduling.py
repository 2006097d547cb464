"""2.0.0 -> 1.2.0, scheduling: definitions become algorithm classes, and parameters the attributes of these and of the allocations.

What the classes cannot hold becomes custom properties, which `kept` turns back: the content of the definitions at the OS model,
the name of a definition that is no class at the scheduler, other parameters at the allocation or scheduler.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TypeAlias

from amalthea_uros.metamodel.kept_properties import prefix
from amalthea_uros.metamodel.source import FileText
from amalthea_uros.xmi.migrate.steps.kept import (
    DEFINITION,
    DEFINITIONS,
    OF_ASSOCIATION,
    OWN,
    PARAMETER_LISTS,
    PROPERTY,
    ParameterKeys,
    as_map,
    keep,
    kept,
    strings,
)
from amalthea_uros.xmi.migrate.steps.scheduling import (
    BUDGETS,
    EXTENDED,
    PRIORITY,
    QUANTIZED,
    QUANTUM,
    USER_SPECIFIC,
    AddedDefinitions,
)
from amalthea_uros.xmi.migrate.steps.tools import keep_comments, text_value
from amalthea_uros.xmi.tree.model_set import ModelSet, Origins, Tree
from amalthea_uros.xmi.tree.node import Node, remove_all
from amalthea_uros.xmi.tree.notes import StepNotes

# Definitions that the step up makes of the algorithm classes anyway, so that nothing of them needs to be kept

#: What a definition says: tag, attributes, names of the parameters that it refers to.
_Content: TypeAlias = tuple[str, dict[str, str], dict[str, list[str]]]


def are_standard(models: ModelSet, algorithms: list[str], parameters: list[str]) -> bool:
    """Whether the definitions of the files are those that the step up makes for these algorithms and parameters, there and so."""
    tags = ("schedulerDefinitions", "schedulingParameterDefinitions")
    present = models.nodes(*tags)
    place = next((model for root in models.roots if (model := root.child("osModel")) is not None), None)
    if any(node.parent is not place or node.type or node.comments or node.children for node in present):
        return False
    root = Node("Amalthea")
    made_in = root.add("osModel")
    definitions = AddedDefinitions(ModelSet([Tree(Path(), FileText(""), "2.0.0", root)], Origins()))
    for name in algorithms:
        definitions.scheduler(name, root)
    for name in parameters:
        definitions.parameter(name, root)
    definitions.insert(StepNotes())
    return list(map(_content, present)) == [_content(node) for tag in tags for node in made_in.all(tag)]


def _content(node: Node) -> _Content:
    return node.tag, node.attributes, {name: [target.name for target in targets] for name, targets in node.references.items()}


# Parameters: what 1.2.0 has is stated there, anything else becomes custom properties

#: The algorithms that 1.2.0 has, by the tag of the scheduler.
ALGORITHMS = {
    "taskSchedulers": {
        *("FixedPriorityPreemptive", "FixedPriorityPreemptiveWithBudgetEnforcement", "OSEK", "DeadlineMonotonic"),
        *("RateMonotonic", "LeastLocalRemainingExecutionTimeFirst", "EarliestDeadlineFirst", "PriorityBasedRoundRobin"),
        *("DeferrableServer", "PollingPeriodicServer", "SporadicServer", "ConstantBandwidthServer"),
        *("ConstantBandwidthServerWithCASH", "Grouping", *QUANTIZED),
    },
    "interruptControllers": {"PriorityBased"},
}

_NANOSECONDS = {"ns": 1, "us": 1_000, "ms": 1_000_000, "s": 1_000_000_000}

#: A quantum that 1.2.0 can state so that it comes back: 0 is the default there, which the step up takes for none.
_QUANTUM = re.compile("[1-9][0-9]{0,9}").fullmatch
_LARGEST = 2**31 - 1

_PARAMETER = "schedulingParameterDefinitions"

#: Puts a parameter (holder, name, value) where 1.2.0 has a place for it; whether there is one.
Place = Callable[[Node, str, Node], bool]


def write_defaults(
    holder: Node, keeper: Node, keys: ParameterKeys, scheduler: Node | None, kind: str, notes: StepNotes
) -> None:
    """State what the defaults of the definitions say, which 1.2.0 does not have; of what can be stated there at all."""
    definition = None if scheduler is None else scheduler.target("definition")
    if definition is None:
        return
    stated = {key.name for node in holder.all("schedulingParameters") if (key := node.target("key")) is not None}
    written = []
    for parameter in definition.references.get(kind, ()):
        default = parameter.child("defaultValue")
        if default is None or parameter.name in stated or not _has_place(parameter.name, default, kind, definition, scheduler):
            continue
        added = holder.add("schedulingParameters")
        added.refer("key", parameter)
        added.add("value", default.type).attributes = dict(default.attributes)
        stated.add(parameter.name)
        written.append(parameter.name)
        notes.defaulted(
            keeper,
            "default of a scheduling parameter: AMALTHEA 1.2.0 does not have it",
            f"{parameter.name} = {_shown(default)}",
        )
    if written:
        keep(keeper, keys.defaults, strings(written, keeper))


def _has_place(name: str, value: Node, kind: str, definition: Node, scheduler: Node | None) -> bool:
    """Whether 1.2.0 has a place for a parameter: found by putting a copy there."""
    copy = Node("value", value.type, dict(value.attributes))
    if kind == "processParameters":
        return place_in_allocation(Node("taskAllocation"), name, copy)
    is_known = scheduler is not None and definition.name in ALGORITHMS.get(scheduler.tag, ())
    return place_in_algorithm(Node("schedulingAlgorithm", definition.name if is_known else USER_SPECIFIC), name, copy)


def change_parameters(holder: Node, keeper: Node, keys: ParameterKeys, place: Place, notes: StepNotes) -> None:
    """Put the parameters of an allocation, scheduler or association where 1.2.0 has a place for them, else into custom properties."""
    placed: list[str] = []
    others: list[str] = []
    seen: set[str] = set()
    nodes = holder.all("schedulingParameters")
    # The former parts and the new one of 1.2.0 have the same tag.
    remove_all(nodes)
    for node in nodes:
        key, value = node.target("key"), node.child("value")
        problem = _problem(key, value, seen)
        if node.attributes or len(node.children) > 1:
            problem = problem or "scheduling parameter with unknown content"
        if problem or key is None or value is None:
            notes.lost(keeper, problem, name_of(key))
            continue
        name = key.name
        seen.add(name)
        if place(holder, name, value):
            placed.append(name)
            notes.converted(keeper, "scheduling parameter is stated as in AMALTHEA 1.2.0", f"{name} = {_shown(value)}")
            keep_comments(node, holder)
        else:
            others.append(name)
            shown = _shown(value)
            keep(keeper, keys.parameter + name, value).comments = node.comments
            notes.kept(keeper, "scheduling parameter", f"{name} = {shown}")
    order = [name for name in (PRIORITY, *BUDGETS) if name in placed]
    order += [name for name in placed if name not in order] + others
    stated = [key.name for node in nodes if (key := node.target("key")) is not None]
    if order != stated:
        keep(keeper, keys.order, strings(stated, keeper))


def _problem(key: Node | None, value: Node | None, seen: set[str]) -> str:
    """Why a parameter cannot be kept, "" if it can."""
    if key is not None and key.tag != _PARAMETER:
        return "scheduling parameter of which the definition is in none of the files"
    if key is None or not key.name:
        return "scheduling parameter without a definition that has a name"
    if value is None:
        return "scheduling parameter without a value"
    return "scheduling parameter that is stated twice" if key.name in seen else ""


def name_of(key: Node | None) -> str:
    """The name of a definition, also of one that is in none of the files."""
    return "" if key is None else key.name or key.get("path")


def _shown(value: Node) -> str:
    return " ".join(text for name in ("value", "unit") if (text := value.get(name))) or value.type


def place_in_allocation(holder: Node, name: str, value: Node) -> bool:
    """State a parameter in an allocation or association, if 1.2.0 has a place for it."""
    if name == PRIORITY and value.type == "IntegerObject":
        holder.child_or_new("schedulingParameters").attributes["priority"] = value.get("value", "0")
        return True
    if name in BUDGETS and value.type == "Time":
        value.tag, value.type = name, ""
        holder.child_or_new("schedulingParameters").insert(value)
        return True
    return _place_as_extension(holder, name, value)


def place_in_algorithm(algorithm: Node, name: str, value: Node) -> bool:
    """State a parameter in an algorithm, if 1.2.0 has a place for it."""
    if algorithm.type == USER_SPECIFIC:
        return _place_as_extension(algorithm, name, value)
    text = value.get("value")
    factor = _NANOSECONDS.get(value.get("unit"))
    if name != QUANTUM or algorithm.type not in QUANTIZED or value.type != "Time" or not factor or not _QUANTUM(text):
        return False
    if int(text) * factor > _LARGEST:
        return False
    algorithm.attributes["quantSizeNs"] = str(int(text) * factor)
    return True


def _place_as_extension(holder: Node, name: str, value: Node) -> bool:
    if not name.startswith(EXTENDED) or value.type != "StringObject" or "value" not in value.attributes:
        return False
    holder.add("parameterExtensions", like=value, key=name.removeprefix(EXTENDED), value=value.get("value"))
    return True


# Definitions

_SCHEDULER = "schedulerDefinitions"

#: Custom properties of processes.
_TAKEN_FOR_PARAMETERS = {PRIORITY, "osekTaskGroup"}


def change_scheduling(models: ModelSet, notes: StepNotes) -> None:
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


def _rename_properties(processes: Iterable[Node], notes: StepNotes) -> None:
    """Rename custom properties that mean nothing since 2.0.0, and of which the step up would make parameters."""
    for process in processes:
        for node in process.all("customProperties"):
            key = node.get("key")
            if key in _TAKEN_FOR_PARAMETERS:
                node.attributes["key"] = PROPERTY + key
                notes.renamed(process, "custom property that is a scheduling parameter in older versions", key)


def _refuse_ambiguous(definitions: Iterable[Node], notes: StepNotes) -> None:
    """Definitions are kept by name, so each needs its own."""
    names: set[str] = set()
    for node in definitions:
        if not node.name or node.name in names:
            notes.lost(node, "definition without a unique name: AMALTHEA 1.2.0 identifies it by name", repr(node.name), "name")
        names.add(node.name)


def _change_scheduler(scheduler: Node, notes: StepNotes) -> None:
    definition = scheduler.target("definition")
    algorithm = None
    write_defaults(scheduler, scheduler, OWN, scheduler, "algorithmParameters", notes)
    if definition is not None:
        del scheduler.references["definition"]
        algorithm = _add_algorithm(scheduler, definition, notes)

    def place(_holder: Node, name: str, value: Node) -> bool:
        return algorithm is not None and place_in_algorithm(algorithm, name, value)

    change_parameters(scheduler, scheduler, OWN, place, notes)


def _add_algorithm(scheduler: Node, definition: Node, notes: StepNotes) -> Node | None:
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


def _keep_definition(node: Node, notes: StepNotes) -> None:
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
