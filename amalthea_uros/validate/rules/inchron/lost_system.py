"""Parts of the hardware, operating systems, mapping and requirements that am2inc drops, ignores or changes."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.naming import name_of
from amalthea_uros.validate.context import Context
from amalthea_uros.validate.rule import model_rule

_DROPPED = (
    am.TimingConstraint,
    am.AffinityConstraint,
    am.RunnableSequencingConstraint,
    am.DataAgeConstraint,
    am.DataCoherencyGroup,
    am.DataStabilityGroup,
    am.PhysicalSectionConstraint,
    am.Requirement,
)


@model_rule("INC-CO-KIND", *_DROPPED)
def _check_constraint(element: am.IAnnotatable, context: Context) -> Iterator[str]:
    if not isinstance(element, am.EventChainLatencyConstraint):
        yield f"the {type(element).__name__} {name_of(element)!r} is dropped by am2inc"


@model_rule("INC-EV-LABEL-RUN", am.LabelEvent, am.ProcessEvent, am.RunnableEvent)
def _check_event_restriction(element: am.LabelEvent | am.ProcessEvent | am.RunnableEvent, context: Context) -> Iterator[str]:
    if isinstance(element, am.LabelEvent):
        restriction = None if element.runnable is None else f"the runnable {element.runnable.name or ''!r}"
    else:
        restriction = None if element.processing_unit is None else f"the core {element.processing_unit.name or ''!r}"
    if restriction is not None:
        yield f"the restriction of the event {element.name or ''!r} to {restriction} is dropped by am2inc"


#: The features of connections and module definitions that specify the cost of an access.
_COSTS = frozenset({"access_latency", "read_latency", "write_latency", "data_rate"})


@model_rule("INC-HW-ACCESS", am.HwAccessElement, am.HwConnection, am.HwDefinition)
def _check_access_cost(element: am.HwAccessElement | am.HwConnection | am.HwDefinition, context: Context) -> Iterator[str]:
    if isinstance(element, am.HwAccessElement):
        yield f"the cost of accesses to {element.destination.name if element.destination else ''!r} is ignored by am2inc"
    elif any(element.__dict__.get(name) is not None for name in _COSTS & element.__dict__.keys()):
        yield f"the access cost of {element.name or ''!r} is ignored by am2inc"


@model_rule("INC-MAP-EXECPU", am.SchedulerAllocation)
def _check_executing_unit(element: am.SchedulerAllocation, context: Context) -> Iterator[str]:
    core = element.executing_pu
    if core is not None and core not in element.responsibility:
        name = element.scheduler.name if element.scheduler is not None else None
        yield f"the executing processing unit {core.name or ''!r} of the scheduler {name or ''!r} is ignored by am2inc"


@model_rule("INC-MAP-RUNNABLE", am.RunnableAllocation)
def _check_runnable_allocation(element: am.RunnableAllocation, context: Context) -> Iterator[str]:
    name = element.entity.name if element.entity is not None else None
    yield f"the allocation of the runnable {name or ''!r} is dropped by am2inc"


@model_rule("INC-MAP-SECTION", am.PhysicalSectionMapping)
def _check_section_mapping(element: am.PhysicalSectionMapping, context: Context) -> Iterator[str]:
    yield f"the physical section mapping {element.name or ''!r} is dropped by am2inc"


@model_rule("INC-OS-CONSISTENCY", am.OperatingSystem)
def _check_data_consistency(element: am.OperatingSystem, context: Context) -> Iterator[str]:
    stated = element.os_data_consistency
    if stated is not None and (stated.mode not in (None, "_undefined_", "noProtection") or next(stated.contents(), None)):
        yield f"the data consistency of the operating system {element.name or ''!r} is ignored by am2inc"


@model_rule("INC-OS-IC", am.OperatingSystem)
def _check_interrupt_controllers(element: am.OperatingSystem, context: Context) -> Iterator[str]:
    count = len(element.interrupt_controllers)
    if count > 1:
        yield f"the {count} interrupt controllers of {element.name or ''!r} are merged by am2inc"


@model_rule("INC-OS-SEMA-TYPE", am.Semaphore)
def _check_semaphore(element: am.Semaphore, context: Context) -> Iterator[str]:
    is_plain = element.semaphore_type in (None, "_undefined_", "CountingSemaphore")
    if not is_plain or element.priority_ceiling_protocol or element.effective("ownership"):
        yield f"the semaphore {element.name or ''!r} is changed to a plain counting semaphore by am2inc"


@model_rule("INC-ST-MODELIST", am.Stimulus)
def _check_mode_values(element: am.Stimulus, context: Context) -> Iterator[str]:
    if element.set_mode_value_list is not None:
        yield f"the mode values set by the stimulus {element.name or ''!r} are ignored by am2inc"
