"""1.2.0 -> 2.0.0, scheduling: definitions take the place of the classes of algorithms, and of features for parameters."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import count
from typing import NamedTuple

from amalthea_uros.xmi.migrate.steps.tools import (
    add_property,
    keep_comments,
    move_properties,
    property_of,
    property_text,
    whole_number,
)
from amalthea_uros.xmi.tree.model_set import ModelSet
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import StepNotes

PRIORITY, TASK_GROUP, QUANTUM = "priority", "taskGroup", "quantSize"

#: Parameters of servers; until 1.2.0 parts of their own.
BUDGETS = ("minBudget", "maxBudget", "replenishment")

#: What the names of parameters begin with that were pairs of a key and a text.
EXTENDED = "extended: "

USER_SPECIFIC = "UserSpecificSchedulingAlgorithm"

#: Parameters of each process, for the algorithms of which APP4MC has definitions.
_OF_PROCESSES: dict[str, tuple[str, ...]] = {
    "FixedPriorityPreemptive": (PRIORITY,),
    "OSEK": (PRIORITY, TASK_GROUP),
    "StaticCyclic": ("cycleOrder",),
    "PriorityBased": (PRIORITY,),
}
#: Algorithms with a quantum, which is a parameter of the algorithm itself.
QUANTIZED = ("PfairPD2", "PartlyPFairPD2", "EarlyReleaseFairPD2", "PartlyEarlyReleaseFairPD2")

#: The options of the known definitions.
_OPTIONS = dict.fromkeys(("requiresParentScheduler", "passesParametersUpwards", "hasExactlyOneChild"), "false")


class _Kind(NamedTuple):
    """How a parameter is defined."""

    type: str
    mandatory: bool


_PARAMETERS = {
    **dict.fromkeys((PRIORITY, TASK_GROUP, "cycleOrder"), _Kind("Integer", mandatory=True)),
    **dict.fromkeys((*BUDGETS, QUANTUM), _Kind("Time", mandatory=False)),
}
_OTHER = _Kind("String", mandatory=False)


class AddedDefinitions:
    """The definitions of a set of files: those that are there, and those that are needed."""

    def __init__(self, models: ModelSet) -> None:
        self.models = models
        self.schedulers = _present(models, "schedulerDefinitions")
        self.parameters = _present(models, "schedulingParameterDefinitions")
        self.made: list[Node] = []
        self._numbers = count(1)

    def scheduler(self, algorithm: str, like: Node) -> Node:
        """The definition of an algorithm, by the name of its former class."""
        found = self.schedulers.get(algorithm)
        if found is None:
            of_processes = _OF_PROCESSES.get(algorithm, ())
            found = self._make("schedulerDefinitions", algorithm, like, _OPTIONS if of_processes else {})
            self._refer(found, "algorithmParameters", (QUANTUM,) if algorithm in QUANTIZED else ())
            self._refer(found, "processParameters", of_processes)
            self.schedulers[algorithm] = found
        return found

    def user_specific(self, keys: Iterable[str], like: Node) -> Node:
        """A definition for one scheduler with an algorithm of the user."""
        name = next(name for number in self._numbers if (name := f"{USER_SPECIFIC}{number}") not in self.schedulers)
        found = self.schedulers[name] = self._make("schedulerDefinitions", name, like, {})
        self._refer(found, "algorithmParameters", [EXTENDED + key for key in keys])
        return found

    def parameter(self, name: str, like: Node) -> Node:
        """The definition of a parameter."""
        found = self.parameters.get(name)
        if found is None:
            kind = _PARAMETERS.get(name, _OTHER)
            attributes = {"type": kind.type, "many": "false", "mandatory": "true" if kind.mandatory else "false"}
            found = self.parameters[name] = self._make("schedulingParameterDefinitions", name, like, attributes)
        return found

    def insert(self, notes: StepNotes) -> None:
        """Put what was made into the model: one set of definitions for all files."""
        if not self.made:
            return
        model = self._os_model(self.made[0])
        model.take(sorted(self.made, key=_order))
        for definition in self.made:
            what = "algorithm" if definition.tag == "schedulerDefinitions" else "parameter"
            notes.converted(definition, f"scheduling {what} is now described by a definition", definition.name)

    def _os_model(self, first: Node) -> Node:
        trees = (*self.models.active, *self.models.trees)
        present = next((model for tree in trees if (model := tree.root.child("osModel")) is not None), None)
        return present or self.models.roots[0].add("osModel", like=first)

    def _make(self, tag: str, name: str, like: Node, attributes: dict[str, str]) -> Node:
        made = Node(tag, "", {"name": name, **attributes}, like.origin)
        self.made.append(made)
        return made

    def _refer(self, definition: Node, reference: str, names: Sequence[str]) -> None:
        for name in dict.fromkeys(names):
            definition.refer(reference, self.parameter(name, definition))


def _present(models: ModelSet, tag: str) -> dict[str, Node]:
    found: dict[str, Node] = {}
    for tree in models.trees:
        for definition in tree.root.find("osModel", tag):
            found.setdefault(definition.name, definition)
    return found


def _order(definition: Node) -> tuple[str, bool, str, int]:
    """By name; standard parameters first, numbered algorithms by their numbers."""
    name = definition.name
    number = name.removeprefix(USER_SPECIFIC) if name.startswith(USER_SPECIFIC) else ""
    base, value = (USER_SPECIFIC, int(number)) if number.isdecimal() else (name, 0)
    return definition.tag, name.startswith(EXTENDED), base, value


def decider(scheduler: Node | None) -> Node | None:
    """The scheduler that decides: a grouping leaves that to its parent."""
    seen: set[Node] = set()
    while scheduler is not None and scheduler not in seen and algorithm_of(scheduler) == "Grouping":
        seen.add(scheduler)
        association = scheduler.child("parentAssociation")
        scheduler = association.target("parent") if association is not None else None
    return scheduler


def algorithm_of(scheduler: Node) -> str:
    """The name of the definition, "" if there is none."""
    definition = scheduler.target("definition")
    return definition.name if definition is not None else ""


# Algorithms and parameters of schedulers and allocations

_TAG = "schedulingParameters"

#: The size of a quantum, which has no unit.
_QUANTUM_NS = "quantSizeNs"


def convert_algorithms(models: ModelSet, definitions: AddedDefinitions, notes: StepNotes) -> None:
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


def _set_definition(scheduler: Node, algorithm: Node, definitions: AddedDefinitions, notes: StepNotes) -> None:
    if not algorithm.type:
        notes.lost(scheduler, "scheduling algorithm without a class")
        return
    if algorithm.type == USER_SPECIFIC:
        keys = [extension.get("key") for extension in algorithm.all("parameterExtensions")]
        scheduler.refer("definition", definitions.user_specific(keys, algorithm))
    else:
        scheduler.refer("definition", definitions.scheduler(algorithm.type, algorithm))
    notes.converted(scheduler, "scheduling algorithm is now a reference to a scheduler definition", algorithm.type)


def _convert_quantum(scheduler: Node, algorithm: Node, definitions: AddedDefinitions, notes: StepNotes) -> None:
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


def convert_parameters(models: ModelSet, definitions: AddedDefinitions, notes: StepNotes) -> None:
    """Give allocations and associations their parameters by definitions."""
    for holder in models.nodes("taskAllocation", "parentAssociation"):
        for parameters in holder.all(_TAG):
            if not (parameters.references.get("key") or "key" in parameters.attributes or parameters.child("value")):
                parameters.remove()
                keep_comments(parameters, holder)
                _convert_fixed(holder, parameters, definitions, notes)
        for extension in holder.all("parameterExtensions"):
            _convert_extension(holder, extension, definitions, notes)


def _convert_fixed(holder: Node, old: Node, definitions: AddedDefinitions, notes: StepNotes) -> None:
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


def _note_unknown(holder: Node, old: Node, notes: StepNotes) -> None:
    for name in (*old.attributes, *old.references, *(part.tag for part in old.children)):
        notes.lost(holder, "unknown scheduling parameter", name)


def _convert_extension(holder: Node, extension: Node, definitions: AddedDefinitions, notes: StepNotes) -> None:
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


def add_parameter(holder: Node, name: str, definitions: AddedDefinitions, type_name: str = "", /, **value: str) -> Node:
    """State a parameter, by default without a value."""
    added = holder.add(_TAG)
    added.refer("key", definitions.parameter(name, added))
    if type_name:
        added.add("value", type_name).attributes.update(value)
    return added


# Priorities and task groups that were attributes until 0.8.0, and have been texts in custom properties since
#
# The converters of APP4MC leave them there, so that the scheduling of the migrated model is not defined.

#: The custom property of the task group.
_OSEK_GROUP = "osekTaskGroup"


def convert_properties(models: ModelSet, definitions: AddedDefinitions, notes: StepNotes) -> None:
    """Make parameters of allocations of the properties of tasks and ISRs."""
    by_task: dict[Node, list[Node]] = {}
    for allocation in models.nodes("taskAllocation"):
        task = allocation.target("task")
        if task is not None:
            by_task.setdefault(task, []).append(allocation)
    for task, allocations in by_task.items():
        _convert_property(task, PRIORITY, PRIORITY, allocations, definitions, notes)
    _convert_groups(by_task, definitions, notes)
    for allocation in models.nodes("isrAllocation"):
        _convert_isr(allocation, notes)


def _convert_property(
    task: Node, key: str, parameter: str, allocations: list[Node], definitions: AddedDefinitions, notes: StepNotes
) -> None:
    """State a property in every allocation that does not; it remains as long as one of them states something else."""
    found = property_of(task, key)
    number = whole_number(property_text(found) or "")
    if found is None or number is None:
        return
    stated = [parameter_of(allocation, parameter) for allocation in allocations]
    for allocation, present in zip(allocations, stated, strict=True):
        if present is None:
            add_parameter(allocation, parameter, definitions, "IntegerObject", value=str(number))
            notes.converted(allocation, f"custom property {key!r} of the task is now a scheduling parameter", str(number))
    if all(present is None or _value(present) == number for present in stated):
        found.remove()


def _value(parameter: Node) -> int | None:
    value = parameter.child("value")
    return whole_number(value.get("value")) if value is not None else None


def _convert_groups(by_task: dict[Node, list[Node]], definitions: AddedDefinitions, notes: StepNotes) -> None:
    """Task groups are a parameter of OSEK only."""
    # The converter to 0.8.1 wrote down every group but 0, so that a task without one is in group 0 if others have one.
    any_stated = any(property_of(task, _OSEK_GROUP) for task in by_task)
    for task, allocations in by_task.items():
        osek = [allocation for allocation in allocations if _is_osek(allocation)]
        if not osek:
            continue
        if property_of(task, _OSEK_GROUP) is None:
            for allocation in osek:
                if any_stated and parameter_of(allocation, TASK_GROUP) is None:
                    add_parameter(allocation, TASK_GROUP, definitions, "IntegerObject", value="0")
                    notes.defaulted(allocation, "task group 0: no other one was stated, but for other tasks it was")
        else:
            _convert_property(task, _OSEK_GROUP, TASK_GROUP, osek, definitions, notes)


def _is_osek(allocation: Node) -> bool:
    scheduler = decider(allocation.target("scheduler"))
    return scheduler is not None and algorithm_of(scheduler) == "OSEK"


def _convert_isr(allocation: Node, notes: StepNotes) -> None:
    isr = allocation.target("isr")
    found = property_of(isr, PRIORITY) if isr is not None else None
    number = whole_number(property_text(found) or "")
    if found is None or number is None:
        return
    if PRIORITY not in allocation.attributes:
        allocation.attributes[PRIORITY] = str(number)
        notes.converted(allocation, "custom property 'priority' of the ISR is now the priority of its allocation", str(number))
    if whole_number(allocation.get(PRIORITY)) == number:
        found.remove()
