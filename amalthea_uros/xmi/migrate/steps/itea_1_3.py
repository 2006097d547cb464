"""ITEA 1.2.0 -> ITEA 1.3.0: written defaults, deadlines as requirements, modes, parts of component models."""

from __future__ import annotations

from functools import partial

from amalthea_uros.xmi.migrate.classes import local_name
from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Kind, Notes
from amalthea_uros.xmi.migrate.postponed import Postponed
from amalthea_uros.xmi.migrate.step import Step
from amalthea_uros.xmi.migrate.steps.file_roots import wrap_objects
from amalthea_uros.xmi.migrate.steps.itea_defaults import write_defaults
from amalthea_uros.xmi.migrate.steps.itea_modes import convert_label_values
from amalthea_uros.xmi.migrate.steps.itea_tools import (
    by_root,
    sub_model_or_new,
    trees_of,
)
from amalthea_uros.xmi.migrate.steps.later import BEYOND_ITEA
from amalthea_uros.xmi.migrate.steps.properties import add_property

#: Parts of component models, by class -> tag, and whether the class is still stated.
_COMPONENT_PARTS = {
    "Component": ("components", False),
    "Composite": ("components", True),
    "System": ("systems", False),
    "ComponentInstance": ("componentInstances", False),
    "Connector": ("connectors", False),
}

_PROCESSES = ("isrs", "tasks", "processPrototypes")


def change(models: ModelSet, notes: Notes) -> None:
    """Change the content of the files of AMALTHEA ITEA 1.2.0."""
    wrap_objects(models, notes)
    write_defaults(models, notes)
    for node in models.rename_classes({"sw:SchedulingSWUnit": "os:SchedulingSWUnit"}):
        notes.renamed(node, "class SchedulingSWUnit moves from package sw to os")
    _rename_attributes(models, notes)
    _remove_unspecified(models, notes)
    _split_components(models, notes)
    convert_label_values(models, notes)
    _convert_deadlines(models, notes)
    for label in models.nodes("labels"):
        value = label.attributes.pop("initialValue", None)
        if value is not None:
            keep = partial(add_property, label, "initialValue", value)
            what = ("initial value of a label", f"{label.name}: {value}", "initialValue")
            models.postponed.append(Postponed(BEYOND_ITEA, keep, Kind.KEPT, label, *what))


def _rename_attributes(models: ModelSet, notes: Notes) -> None:
    for tag in models.nodes("tags"):
        if tag.rename("tagName", "name"):
            notes.renamed(tag, "tagName is name", attribute="tagName")
    for age in models.nodes("dataAge"):
        if age.rename("maximumCyle", "maximumCycle"):
            notes.renamed(age, "maximumCyle is maximumCycle", attribute="maximumCyle")


def _remove_unspecified(models: ModelSet, notes: Notes) -> None:
    for node in models.nodes("calls", "runnableItems", "runnableItem"):
        if node.attributes.get("waitingBehaviour") == "unspecified":
            del node.attributes["waitingBehaviour"]
            notes.renamed(
                node, "waitingBehaviour='unspecified' is not written: it is the default", attribute="waitingBehaviour"
            )


def _split_components(models: ModelSet, notes: Notes) -> None:
    for node in models.nodes("elements"):
        known = _COMPONENT_PARTS.get(local_name(node.type))
        if known is None:
            continue
        node.tag, is_stated = known
        if not is_stated:
            node.target_class, node.type = node.type, ""
        notes.renamed(node, f"elements of component models: {node.tag}", node.name)


def _convert_deadlines(models: ModelSet, notes: Notes) -> None:
    """Deadlines of tasks, ISRs and prototypes -> requirements."""
    trees = trees_of(models)
    holders = [node for node in models.nodes(*_PROCESSES) if node.children and node.child("deadline") is not None]
    holders.sort(key=lambda node: node.origin)
    for root, processes in by_root(holders).items():
        for process in processes:
            deadlines = process.all("deadline")
            for deadline in deadlines:
                requirement = _require(sub_model_or_new(trees[root], "constraintsModel"), process, deadline, notes)
                if "value" not in deadline.attributes:
                    message = "a deadline without value is no requirement"
                    drop = requirement.remove
                    models.postponed.append(Postponed(BEYOND_ITEA, drop, Kind.CONVERTED, deadline, message, is_kept=True))
            remove_all(deadlines)


def _require(model: Node, process: Node, deadline: Node, notes: Notes) -> Node:
    requirement = model.add("requirements", "constraints:ProcessRequirement", like=deadline)
    requirement.attributes |= {"name": process.name} if "name" in process.attributes else {}
    requirement.attributes["severity"] = "Cosmetic"
    requirement.refer("process", process)
    requirement.comments = deadline.comments
    limit = requirement.add("limit", "constraints:TimeRequirementLimit", limitType="UpperLimit", metric="ResponseTime")
    # A time without value was 0.
    value, unit = deadline.get("value", "0"), deadline.get("unit", "ps")
    limit.add("limitValue", value=value, unit=unit)
    notes.converted(deadline, "deadline: requirement for the response time", f"{process.name}: {value} {unit}")
    return requirement


STEP = Step(
    "ITEA 1.2.0",
    "ITEA 1.3.0",
    change,
    frozenset({"setLabelsList", "enablingLabelsList", "disablingLabelsList", "sw:LabelSwitch", "sw:SchedulingSWUnit"}),
)
