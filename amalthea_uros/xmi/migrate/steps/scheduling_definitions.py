"""Definitions of schedulers and of scheduling parameters, which take the place of the classes of algorithms in 2.0.0."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import count
from typing import NamedTuple

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes

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


class Definitions:
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

    def insert(self, notes: Notes) -> None:
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
