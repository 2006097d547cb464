"""Priorities of processes and of their allocations, which AMALTHEA 0.8.1 moved.

Until 0.8.0 processes and task allocations both had a priority, whose default 0 editors wrote as well. What is written as 0 is kept
where nothing else states the priority, because from 0.8.1 on 0 and no priority are different things.
"""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.properties import free_key, keys_of, property_of, property_text, put_property, text_value

_KEY = "priority"
_GROUP = "osekTaskGroup"


def move_priorities(models: ModelSet, notes: Notes) -> None:
    """Priority of an allocation -> scheduling parameters; priority and task group of a process -> custom properties."""
    allocated = _move_of_allocations(models, notes)
    allocated |= _replace_defaults_of_isr_allocations(models, notes)
    for tag in ("tasks", "isrs", "processPrototypes"):
        for process in models.parts("swModel", tag):
            _move_of_process(process, process in allocated, notes)
    for task in models.parts("swModel", "tasks"):
        _move_task_group(task, notes)


def _move_of_allocations(models: ModelSet, notes: Notes) -> set[Node]:
    """The tasks of which every allocation states a priority now."""
    allocated: set[Node] = set()
    unstated: set[Node | None] = set()
    for allocation in models.parts("mappingModel", "taskAllocation"):
        text = allocation.attributes.pop(_KEY, None)
        task = allocation.target("task")
        if text is None:
            unstated.add(task)
            continue
        own = _own(task)
        if text == "0" and own not in ("", "0"):
            # As scheduling parameter it would outdo the priority of the task from 2.0.0 on.
            notes.converted(allocation, "priority 0, the old default, left out: the priority of the task applies", own, _KEY)
        else:
            parameters = allocation.child_or_new("schedulingParameters")
            parameters.attributes.setdefault(_KEY, text)
            notes.moved(allocation, "priority of a task allocation -> schedulingParameters", text, _KEY)
            if task is not None:
                allocated.add(task)
    return allocated - unstated


def _replace_defaults_of_isr_allocations(models: ModelSet, notes: Notes) -> set[Node]:
    """The ISRs of which every allocation states a priority; it stays an attribute there, also in the newest version."""
    allocated: set[Node] = set()
    unstated: set[Node | None] = set()
    for allocation in models.parts("mappingModel", "isrAllocation"):
        isr = allocation.target("isr")
        if isr is None or _KEY not in allocation.attributes:
            unstated.add(isr)
            continue
        own = _own(isr)
        if allocation.attributes[_KEY] == "0" and own not in ("", "0"):
            allocation.attributes[_KEY] = own
            notes.converted(allocation, "priority 0, the old default, replaced: the priority of the ISR applies", own, _KEY)
        allocated.add(isr)
    return allocated - unstated


def _move_of_process(process: Node, is_allocated: bool, notes: Notes) -> None:
    text = process.attributes.pop(_KEY, None)
    if text is None:
        return
    if text != "0" or not is_allocated:
        _state(process, _KEY, text, notes)
        notes.kept(process, "priority of a process", text, _KEY)
    elif is_allocated:
        notes.converted(
            process, "priority 0, the old default, left out: the priority of the allocation applies", attribute=_KEY
        )
    else:
        notes.lost(process, "priority 0 of a process", attribute=_KEY)


def _move_task_group(task: Node, notes: Notes) -> None:
    text = task.attributes.pop(_GROUP, None)
    if text == "0":
        # Nothing is lost: a task without group is in group 0.
        notes.converted(task, "OSEK task group 0, the old default, left out", attribute=_GROUP)
    elif text is not None:
        _state(task, _GROUP, text, notes)
        notes.kept(task, "OSEK task group", text, _GROUP)


def _state(process: Node, key: str, text: str, notes: Notes) -> None:
    """Add a custom property that the step to 2.0.0 finds by its key: of another one of that key it would take the value."""
    present = property_of(process, key)
    if property_text(present) == text:
        return
    if present is not None:
        present.attributes["key"] = free_key(key, keys_of(process))
        notes.renamed(
            present, f"custom property {key!r} gets another key: it is what the process states itself", present.get("key")
        )
    put_property(process, key, text_value(text, process))


def _own(process: Node | None) -> str:
    """The priority that a process states itself, also in a file that was migrated before."""
    if process is None:
        return ""
    return process.get(_KEY) or property_text(property_of(process, _KEY)) or ""
