"""Priorities and task groups that were attributes until 0.8.0, and have been texts in custom properties since.

The converters of APP4MC leave them there, so that the scheduling of the migrated model is not defined.
"""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.numbers import whole_number
from amalthea_uros.xmi.migrate.steps.properties import property_of, property_text
from amalthea_uros.xmi.migrate.steps.scheduling_definitions import PRIORITY, TASK_GROUP, Definitions, algorithm_of, decider
from amalthea_uros.xmi.migrate.steps.scheduling_parameters import add_parameter, parameter_of

#: The custom property of the task group.
_OSEK_GROUP = "osekTaskGroup"


def convert_properties(models: ModelSet, definitions: Definitions, notes: Notes) -> None:
    """Make parameters of allocations of the properties of tasks and ISRs."""
    by_task: dict[Node, list[Node]] = {}
    for allocation in models.nodes("taskAllocation"):
        task = allocation.target("task")
        if task is not None:
            by_task.setdefault(task, []).append(allocation)
    for task, allocations in by_task.items():
        _convert(task, PRIORITY, PRIORITY, allocations, definitions, notes)
    _convert_groups(by_task, definitions, notes)
    for allocation in models.nodes("isrAllocation"):
        _convert_isr(allocation, notes)


def _convert(task: Node, key: str, parameter: str, allocations: list[Node], definitions: Definitions, notes: Notes) -> None:
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


def _convert_groups(by_task: dict[Node, list[Node]], definitions: Definitions, notes: Notes) -> None:
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
            _convert(task, _OSEK_GROUP, TASK_GROUP, osek, definitions, notes)


def _is_osek(allocation: Node) -> bool:
    scheduler = decider(allocation.target("scheduler"))
    return scheduler is not None and algorithm_of(scheduler) == "OSEK"


def _convert_isr(allocation: Node, notes: Notes) -> None:
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
