"""The operating system model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from amalthea_uros._internal.records import replace
from amalthea_uros.bridge.basics.codecs import PLAIN, enumeration, marked, reference, same_names
from amalthea_uros.bridge.basics.context import Building, Extracting
from amalthea_uros.bridge.basics.entries import ClassEntry, ClassTable
from amalthea_uros.bridge.basics.kinds import ObjectKind
from amalthea_uros.bridge.tables.activities import ACTIVITIES, DEMAND, ITEMS, PROTECTIONS
from amalthea_uros.bridge.tables.parameters import Given, SchedulingDefinitions, extract_parameters, extract_policy
from amalthea_uros.metamodel import classes as am
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.kept_properties import OWNERSHIP
from amalthea_uros.perf import os as perf
from amalthea_uros.perf.activities import Protection
from amalthea_uros.units import Duration


class _SemaphoreEntry(ClassEntry):
    """Semaphores; before AMALTHEA 3.0.0 the type says that nobody owns a counting one, and a property says anything else."""

    def fill(self, element: Element, item: perf.Semaphore, context: Building) -> Element:
        if context.is_at_least(3, 0, 0):
            return super().fill(element, item, context)
        semaphore = super().fill(element, replace(item, ownership=True), context)
        if item.ownership is not _is_owned(item.kind):
            assert isinstance(semaphore, am.Semaphore)
            kept = am.CustomProperty(key=OWNERSHIP, value=am.BooleanObject(value=item.ownership))
            semaphore.custom_properties.append(kept)
        return semaphore

    def values(self, element: Element, context: Extracting, *, strictly: bool = False) -> dict[str, Any] | None:
        values = super().values(element, context, strictly=strictly)
        if values is not None and context.is_older(element, 3, 0, 0):
            assert isinstance(element, am.Semaphore)
            codec = marked(OWNERSHIP, _is_owned(values["kind"]))
            values["ownership"] = codec.extract(element.custom_properties, context, element)
        return values


def _is_owned(kind: perf.SemaphoreKind | None) -> bool:
    return kind is not perf.SemaphoreKind.COUNTING


SEMAPHORES = ClassTable(
    _SemaphoreEntry(
        perf.Semaphore,
        am.Semaphore,
        kind=("semaphore_type", same_names(perf.SemaphoreKind, am.SemaphoreType, COUNTING="COUNTING_SEMAPHORE")),
        users="max_value",
        initial_users="initial_value",
        ceiling="priority_ceiling_protocol",
        ownership=PLAIN,
    )
)

#: Services whose feature is not their name after `api_`.
_SERVICES = {service: f"api_{service.name.lower()}" for service in perf.Service} | {
    perf.Service.SUSPEND_INTERRUPTS: "api_suspend_os_interrupts",
    perf.Service.RESUME_INTERRUPTS: "api_resume_os_interrupts",
    perf.Service.SERVER_CALL: "api_synchronous_server_call_point",
}
#: Who keeps data consistent; an operating system cannot inherit that.
_PROTECTION = enumeration(
    {Protection[one]: am.OsDataConsistencyMode[other] for one, other in PROTECTIONS.items() if one != "INHERITED"}
)
_OVERHEAD, _SCHEDULER = reference(ObjectKind.OVERHEAD), reference(ObjectKind.SCHEDULER)


def build_overhead(overhead: perf.Overhead, element: Any, context: Building) -> None:
    """Fill what an operating system costs."""
    context.at(overhead)
    if overhead.services:
        element.api_overhead = am.OsAPIOverhead()
        for service, demand in overhead.services:
            setattr(element.api_overhead, _SERVICES[service], DEMAND.build(demand, context))
    for stated, feature in ((overhead.category_1, "isr_category1_overhead"), (overhead.category_2, "isr_category2_overhead")):
        if stated is not None:
            before, after = (DEMAND.build_given(demand, context) for demand in (stated.before, stated.after))
            setattr(element, feature, am.OsISROverhead(pre_execution_overhead=before, post_execution_overhead=after))


def extract_overhead(element: am.OsOverhead, context: Extracting) -> perf.Overhead:
    """The way back."""
    api = element.api_overhead
    services = []
    for service, feature in _SERVICES.items():
        demand = DEMAND.extract_given(getattr(api, feature, None), context, element)
        if demand is not None:
            services.append((service, demand))
    return perf.Overhead(
        name=context.names[element],
        origin=context.location(element),
        services=tuple(services),
        category_1=_isr_overhead(element.isr_category1_overhead, context),
        category_2=_isr_overhead(element.isr_category2_overhead, context),
    )


def _isr_overhead(element: am.OsISROverhead | None, context: Extracting) -> perf.IsrOverhead | None:
    if element is None:
        return None
    return perf.IsrOverhead(
        before=DEMAND.extract_given(element.pre_execution_overhead, context, element),
        after=DEMAND.extract_given(element.post_execution_overhead, context, element),
    )


# Schedulers


def build_system(system: perf.OperatingSystem, context: Building) -> am.OperatingSystem:
    """An operating system with schedulers that references will find; `fill_system` does the rest."""
    element = am.OperatingSystem(name=system.name)
    context.register(system, element)
    for scheduler in system.schedulers:
        element.task_schedulers.append(am.TaskScheduler(name=scheduler.name))
        context.register(scheduler, element.task_schedulers[-1])
    for controller in system.interrupt_controllers:
        element.interrupt_controllers.append(am.InterruptController(name=controller.name))
        context.register(controller, element.interrupt_controllers[-1])
    return element


def fill_system(system: perf.OperatingSystem, element: am.OperatingSystem, definitions: SchedulingDefinitions) -> None:
    """Everything of an operating system that refers to something."""
    context = definitions.context
    context.at(system)
    element.overhead = _OVERHEAD.build(system.overhead, context)
    if system.protection is not None:
        element.os_data_consistency = am.OsDataConsistency(mode=_PROTECTION.build(system.protection, context))
    policies = {scheduler.name: scheduler.policy for scheduler in system.schedulers}
    for scheduler, task_scheduler in zip(system.schedulers, element.task_schedulers, strict=True):
        _fill_scheduler(scheduler, task_scheduler, definitions)
        if scheduler.parent is not None:
            parent = scheduler.parent
            association = am.SchedulerAssociation(parent=_SCHEDULER.build(parent.scheduler, context))
            task_scheduler.parent_association = association
            given = Given(parent.priority, parent.deadline, parent.parameters)
            definitions.set_parameters(association, scheduler, given, policies.get(parent.scheduler), of_process=True)
    for controller, interrupts in zip(system.interrupt_controllers, element.interrupt_controllers, strict=True):
        _fill_scheduler(controller, interrupts, definitions)


def _fill_scheduler(
    scheduler: perf.Scheduler | perf.InterruptController, element: Any, definitions: SchedulingDefinitions
) -> None:
    definitions.context.at(scheduler)
    definitions.set_policy(element, scheduler, scheduler.policy)
    given = Given(None, None, scheduler.parameters)
    definitions.set_parameters(element, scheduler, given, scheduler.policy, of_process=False)
    element.computation_items = ITEMS.build(scheduler.overhead, definitions.context)


#: Which cores schedulers decide for, in AMALTHEA a matter of the mapping model.
SchedulerAllocations = Mapping[am.Scheduler | None, Sequence[am.SchedulerAllocation]]


def extract_system(element: am.OperatingSystem, allocations: SchedulerAllocations, context: Extracting) -> perf.OperatingSystem:
    """An operating system with its schedulers."""
    return perf.OperatingSystem(
        name=context.names[element],
        origin=context.location(element),
        schedulers=tuple(_scheduler(scheduler, allocations, context) for scheduler in element.task_schedulers),
        interrupt_controllers=tuple(
            perf.InterruptController(**_common(controller, allocations, context))
            for controller in element.interrupt_controllers
        ),
        overhead=_OVERHEAD.extract(element.overhead, context, element),
        protection=_PROTECTION.extract_given(getattr(element.os_data_consistency, "mode", None), context, element),
    )


def _scheduler(element: am.TaskScheduler, allocations: SchedulerAllocations, context: Extracting) -> perf.Scheduler:
    association = element.parent_association
    parent = None
    if association is not None:
        name = _SCHEDULER.extract(association.parent, context, element)
        definition = association.parent.definition if association.parent is not None else None
        defaults = definition.process_parameters if definition is not None else ()
        given = extract_parameters(association, context, defaults, kept=element.custom_properties)
        if name is not None:
            parent = perf.Parent(scheduler=name, priority=given.priority, deadline=given.deadline, parameters=given.parameters)
    return perf.Scheduler(**_common(element, allocations, context), parent=parent)


def _common(element: Any, allocations: SchedulerAllocations, context: Extracting) -> dict[str, Any]:
    """What task schedulers and interrupt controllers have."""
    cores: dict[str, None] = {}
    executing: str | None = None
    for allocation in allocations.get(element, ()):
        for core in allocation.responsibility:
            if core in context.names:
                cores[context.names[core]] = None
        executing = executing or context.names.get(allocation.executing_pu)  # type: ignore[arg-type]
    definition = element.definition
    given = extract_parameters(element, context, definition.algorithm_parameters if definition is not None else ())
    stated = given.parameters
    if given.priority is not None:
        stated = (perf.Parameter("priority", (given.priority,)), *stated)
    if given.deadline is not None:
        stated = (*stated, perf.Parameter("deadline", (Duration(given.deadline),)))
    return {
        "name": context.names[element],
        "origin": context.location(element),
        "policy": extract_policy(element),
        "cores": tuple(cores),
        "executing_core": executing,
        "parameters": stated,
        "overhead": ACTIVITIES.extract_all(element.computation_items, context),
    }
