"""Where processes execute and data are stored, and in which order processes execute."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from fractions import Fraction
from math import ceil

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.magnitudes import bits
from amalthea_uros.timing.activation.load import unit_hint
from amalthea_uros.timing.scheduling.allocation import is_by_priority, sharing_a_priority
from amalthea_uros.units import data_size_text, number_text
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.quantities import clock
from amalthea_uros.validate.rule import SystemProblem, model_rule, system_rule
from amalthea_uros.validate.scheduling import deciding, policy, priority
from amalthea_uros.validate.system_context import SystemContext
from amalthea_uros.validate.wording import joined


@model_rule("TIM-ALLOCATION", am.Process)
def _check_allocation(element: am.Process, context: Context) -> Iterator[str]:
    if not isinstance(element, am.Task | am.ISR):
        return
    times = context.once(_allocations)[element]
    if times == 0:
        yield f"{element.name!r} is not allocated to a scheduler or an interrupt controller"
    elif times > 1:
        yield f"{element.name!r} is allocated {times} times"


def _allocations(context: Context) -> Counter[am.Process]:
    """How often each process is allocated to a scheduler or an interrupt controller."""
    tasks = (allocation.task for allocation in context.all(am.TaskAllocation) if allocation.scheduler is not None)
    isrs = (allocation.isr for allocation in context.all(am.ISRAllocation) if allocation.controller is not None)
    return Counter(process for process in (*tasks, *isrs) if process is not None)


@model_rule("TIM-CLOCK", am.ProcessingUnit)
def _check_clock(element: am.ProcessingUnit, context: Context) -> Iterator[str]:
    if clock(element) is None:
        yield f"the clock frequency of {element.name!r} is unknown"


@model_rule("TIM-POLICY", am.TaskScheduler)
def _check_policy(element: am.TaskScheduler, context: Context) -> Iterator[str]:
    if policy(element) is None and context.uses(am.TaskAllocation, "scheduler")[element]:
        yield f"scheduler {element.name!r} has tasks, but no policy"


@model_rule("TIM-PRIORITY", am.TaskAllocation)
def _check_priority(element: am.TaskAllocation, context: Context) -> Iterator[str]:
    if element.task is not None and is_by_priority(policy(deciding(element.scheduler))) and priority(element) is None:
        yield f"task {element.task.name!r} has no priority"


@system_rule("TIM-PRIORITY-SHARED")
def _check_priority_shared(context: SystemContext) -> Iterator[SystemProblem]:
    for allocation, shared, others in sharing_a_priority(context.system, context.cores):
        have = "has" if len(others) == 1 else "have"
        message = f"{allocation.task!r} has the priority {shared}, as {joined(map(repr, others))} {have}"
        yield SystemProblem(allocation, message, allocation.task)


@system_rule("TIM-OVERLOAD")
def _check_overload(context: SystemContext) -> Iterator[SystemProblem]:
    for core, total in context.certain_loads.items():
        if total > 1:
            largest = sorted(context.loads.get(core, {}).items(), key=lambda item: item[1], reverse=True)
            parts = joined(f"{_percent(share)} by {process!r}" for process, share in largest)
            message = f"overload: the worst-case load of {core!r} is {_percent(total)}: {parts}"
            item = context.system.cores[core]
            hint = unit_hint(total, context.system.frequency_of(item.clock))
            yield SystemProblem(item, f"{message}; {hint}" if hint else message)


def _percent(share: Fraction | int) -> str:
    # Rounded up, so that an overload never looks like 100 %.
    return f"{number_text(Fraction(ceil(share * 100_000), 1000))} %"


@model_rule("TIM-MEMORY", am.Memory)
def _check_memory(element: am.Memory, context: Context) -> Iterator[str]:
    size = bits(element.definition.size) if element.definition is not None else None
    mapped = context.once(_mapped).get(element, {})
    needed = sum(bits(part.size) or 0 for part in mapped)
    if size is not None and needed > size:
        yield f"{element.name!r} has a size of {data_size_text(size)}, but the objects mapped to it need {data_size_text(needed)}"


def _mapped(context: Context) -> dict[am.Memory, dict[am.AbstractMemoryElement, None]]:
    """The objects mapped to each memory, each of them once, even if it is mapped in several ways."""
    sections: dict[am.Section, list[am.AbstractMemoryElement]] = {}
    candidates: tuple[am.Label | am.Runnable, ...] = (*context.all(am.Label), *context.all(am.Runnable))
    for part in candidates:
        if part.section is not None:
            sections.setdefault(part.section, []).append(part)
    found: dict[am.Memory, dict[am.AbstractMemoryElement, None]] = {}
    for mapping in context.all(am.MemoryMapping):
        if mapping.memory is not None and mapping.abstract_element is not None:
            found.setdefault(mapping.memory, {})[mapping.abstract_element] = None
    for placed in context.all(am.PhysicalSectionMapping):
        if placed.memory is not None:
            parts = [part for section in placed.origin for part in sections.get(section, ())]
            found.setdefault(placed.memory, {}).update(dict.fromkeys((*parts, *placed.labels, *placed.run_entities)))
    return found
