"""Short texts of objects for debuggers and notebooks: class and name, and of processes their activation and priority."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel.classes import ISR, ISRAllocation, MappingModel, Process, Quantity, Stimulus, Task, TaskAllocation
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.summary import priority_text, quantity, stimulus_text


def representation(element: Element) -> str:
    """A short text such as `<Task 'Control', every 1 ms, priority 2>`; it does not fail for objects that are not complete."""
    name = element.__dict__.get("name")
    parts = [f"{type(element).__name__} {name!r}" if name else type(element).__name__]
    try:
        parts += _details(element)
    except (AttributeError, TypeError, ValueError):
        # A debugger shows objects whose values are of wrong types, too.
        parts.append("...")
    return f"<{', '.join(parts)}>"


def _details(element: Element) -> list[str]:
    match element:
        case Stimulus():
            return [stimulus_text(element)]
        case Quantity():
            return [quantity(element)]
        case Process():
            priority = next(filter(None, map(priority_text, _allocations(element))), "")
            return [*map(stimulus_text, element.stimuli), *([f"priority {priority}"] if priority else [])]
    return []


def _allocations(process: Process) -> Iterator[TaskAllocation | ISRAllocation]:
    """The allocations of a process, in the files of its model."""
    model = process.model
    roots = [document.root for document in model.documents] if model is not None else []
    for mapping in (part for root in roots for part in root.contents() if isinstance(part, MappingModel)):
        if isinstance(process, Task):
            yield from (each for each in mapping.task_allocation if each.task is process)
        if isinstance(process, ISR):
            yield from (each for each in mapping.isr_allocation if each.isr is process)
