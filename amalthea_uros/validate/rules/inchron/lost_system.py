"""Parts of the hardware, operating systems, mapping and requirements that am2inc drops, ignores or changes."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel.classes import (
    AffinityConstraint,
    DataAgeConstraint,
    DataCoherencyGroup,
    DataStabilityGroup,
    EventChainLatencyConstraint,
    HwAccessElement,
    HwConnection,
    HwDefinition,
    IAnnotatable,
    LabelEvent,
    OperatingSystem,
    PhysicalSectionConstraint,
    PhysicalSectionMapping,
    ProcessEvent,
    Requirement,
    RunnableAllocation,
    RunnableEvent,
    RunnableSequencingConstraint,
    SchedulerAllocation,
    Semaphore,
    Stimulus,
    TimingConstraint,
)
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule

_DROPPED = (
    TimingConstraint,
    AffinityConstraint,
    RunnableSequencingConstraint,
    DataAgeConstraint,
    DataCoherencyGroup,
    DataStabilityGroup,
    PhysicalSectionConstraint,
    Requirement,
)


@model_rule("INC-CO-KIND", *_DROPPED)
def _check_constraint(element: IAnnotatable, context: Context) -> Iterator[str]:
    if not isinstance(element, EventChainLatencyConstraint):
        yield f"the {type(element).__name__} {name_of(element)!r} is dropped by am2inc"


@model_rule("INC-EV-LABEL-RUN", LabelEvent, ProcessEvent, RunnableEvent)
def _check_event_restriction(element: LabelEvent | ProcessEvent | RunnableEvent, context: Context) -> Iterator[str]:
    if isinstance(element, LabelEvent):
        restriction = None if element.runnable is None else f"the runnable {element.runnable.name or ''!r}"
    else:
        restriction = None if element.processing_unit is None else f"the core {element.processing_unit.name or ''!r}"
    if restriction is not None:
        yield f"the restriction of the event {element.name or ''!r} to {restriction} is dropped by am2inc"


#: The features of connections and module definitions that specify the cost of an access.
_COSTS = frozenset({"access_latency", "read_latency", "write_latency", "data_rate"})


@model_rule("INC-HW-ACCESS", HwAccessElement, HwConnection, HwDefinition)
def _check_access_cost(element: HwAccessElement | HwConnection | HwDefinition, context: Context) -> Iterator[str]:
    if isinstance(element, HwAccessElement):
        yield f"the cost of accesses to {element.destination.name if element.destination else ''!r} is ignored by am2inc"
    elif any(element.__dict__.get(name) is not None for name in _COSTS & element.__dict__.keys()):
        yield f"the access cost of {element.name or ''!r} is ignored by am2inc"


@model_rule("INC-MAP-EXECPU", SchedulerAllocation)
def _check_executing_unit(element: SchedulerAllocation, context: Context) -> Iterator[str]:
    core = element.executing_pu
    if core is not None and core not in element.responsibility:
        name = element.scheduler.name if element.scheduler is not None else None
        yield f"the executing processing unit {core.name or ''!r} of the scheduler {name or ''!r} is ignored by am2inc"


@model_rule("INC-MAP-RUNNABLE", RunnableAllocation)
def _check_runnable_allocation(element: RunnableAllocation, context: Context) -> Iterator[str]:
    name = element.entity.name if element.entity is not None else None
    yield f"the allocation of the runnable {name or ''!r} is dropped by am2inc"


@model_rule("INC-MAP-SECTION", PhysicalSectionMapping)
def _check_section_mapping(element: PhysicalSectionMapping, context: Context) -> Iterator[str]:
    yield f"the physical section mapping {element.name or ''!r} is dropped by am2inc"


@model_rule("INC-OS-CONSISTENCY", OperatingSystem)
def _check_data_consistency(element: OperatingSystem, context: Context) -> Iterator[str]:
    stated = element.os_data_consistency
    if stated is not None and (stated.mode not in (None, "_undefined_", "noProtection") or next(stated.contents(), None)):
        yield f"the data consistency of the operating system {element.name or ''!r} is ignored by am2inc"


@model_rule("INC-OS-IC", OperatingSystem)
def _check_interrupt_controllers(element: OperatingSystem, context: Context) -> Iterator[str]:
    count = len(element.interrupt_controllers)
    if count > 1:
        yield f"the {count} interrupt controllers of {element.name or ''!r} are merged by am2inc"


@model_rule("INC-OS-SEMA-TYPE", Semaphore)
def _check_semaphore(element: Semaphore, context: Context) -> Iterator[str]:
    is_plain = element.semaphore_type in (None, "_undefined_", "CountingSemaphore")
    if not is_plain or element.priority_ceiling_protocol or element.effective("ownership"):
        yield f"the semaphore {element.name or ''!r} is changed to a plain counting semaphore by am2inc"


@model_rule("INC-ST-MODELIST", Stimulus)
def _check_mode_values(element: Stimulus, context: Context) -> Iterator[str]:
    if element.set_mode_value_list is not None:
        yield f"the mode values set by the stimulus {element.name or ''!r} are ignored by am2inc"
