"""The mapping of processes to schedulers and cores."""

from __future__ import annotations

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.mapping import IsrAllocation, TaskAllocation
from amalthea_uros.perf.system import System
from amalthea_uros.services.changes.key import ISR_ALLOCATIONS, TASK_ALLOCATIONS, UNSET, Configuration, Key
from amalthea_uros.services.names import require
from amalthea_uros.timing.allocation import allocated_cores, scheduler_cores


def _allocation(system: System, task: str) -> TaskAllocation:
    """The only allocation of a task."""
    found = [allocation for allocation in system.mapping.tasks if allocation.task == task]
    if len(found) != 1:
        raise InvalidArgumentError(f"{task!r} is mapped to {'several schedulers' if found else 'no scheduler'}")
    return found[0]


def _isr_allocation(system: System, isr: str) -> IsrAllocation:
    """The only allocation of an interrupt service routine."""
    found = [allocation for allocation in system.mapping.isrs if allocation.isr == isr]
    if len(found) != 1:
        raise InvalidArgumentError(
            f"{isr!r} is mapped to {'several interrupt controllers' if found else 'no interrupt controller'}"
        )
    return found[0]


def _show_core(configuration: Configuration, process: str) -> str:
    return ", ".join(sorted(allocated_cores(configuration.system).get(process, ()))) or UNSET


def _show_scheduler(configuration: Configuration, task: str) -> str:
    return ", ".join(each.scheduler for each in configuration.system.mapping.tasks if each.task == task) or UNSET


def _show_controller(configuration: Configuration, isr: str) -> str:
    return ", ".join(each.controller for each in configuration.system.mapping.isrs if each.isr == isr) or UNSET


def _set_scheduler(configuration: Configuration, task: str, scheduler: str) -> Configuration:
    """Map a task to a scheduler, without a preference for one of its cores."""
    system = configuration.system
    _allocation(system, task)
    require("scheduler", [scheduler], system.schedulers)
    return configuration._replace(system=TASK_ALLOCATIONS.with_fields(system, task, scheduler=scheduler, cores=()))


def _set_core(configuration: Configuration, task: str, core: str) -> Configuration:
    """Map a task to a core: by its present scheduler if it is responsible for the core, otherwise by the only one that is."""
    system = configuration.system
    present = _allocation(system, task).scheduler
    require("core", [core], system.cores)
    responsible = [name for name in system.schedulers if core in scheduler_cores(name, system)]
    scheduler = present if present in responsible else _only("scheduler", responsible, core, task)
    cores = (core,) if len(scheduler_cores(scheduler, system)) > 1 else ()
    return configuration._replace(system=TASK_ALLOCATIONS.with_fields(system, task, scheduler=scheduler, cores=cores))


def _set_controller(configuration: Configuration, isr: str, controller: str) -> Configuration:
    system = configuration.system
    _isr_allocation(system, isr)
    require("interrupt controller", [controller], system.interrupt_controllers)
    return configuration._replace(system=ISR_ALLOCATIONS.with_fields(system, isr, controller=controller))


def _set_isr_core(configuration: Configuration, isr: str, core: str) -> Configuration:
    """Map an interrupt service routine to the only interrupt controller that is responsible for a core alone."""
    system = configuration.system
    _isr_allocation(system, isr)
    require("core", [core], system.cores)
    responsible = [each.name for each in system.interrupt_controllers.values() if each.cores == (core,)]
    controller = _only("interrupt controller", responsible, core, isr)
    return configuration._replace(system=ISR_ALLOCATIONS.with_fields(system, isr, controller=controller))


def _only(kind: str, responsible: list[str], core: str, process: str) -> str:
    if not responsible:
        raise InvalidArgumentError(f"no {kind} is responsible for the core {core!r}")
    if len(responsible) > 1:
        key = "scheduler" if kind == "scheduler" else "controller"
        choices = ", ".join(f"{process}.{key}={name}" for name in responsible)
        raise InvalidArgumentError(f"several {kind}s are responsible for the core {core!r}; choose one: {choices}")
    return responsible[0]


TASK_KEYS = {"scheduler": Key(str, _show_scheduler, _set_scheduler), "core": Key(str, _show_core, _set_core)}
ISR_KEYS = {"controller": Key(str, _show_controller, _set_controller), "core": Key(str, _show_core, _set_isr_core)}
