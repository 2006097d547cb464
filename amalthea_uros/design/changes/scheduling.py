"""Scheduling: what dispatches processes; priority, deadline and budget of schedulers below others."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.design.changes.key import (
    ISR_ALLOCATIONS,
    OPERATING_SYSTEMS,
    TASK_ALLOCATIONS,
    UNSET,
    Collection,
    Configuration,
    Key,
    duration,
    positive_duration,
    unused,
    whole_number,
)
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.names import require
from amalthea_uros.perf.mapping import IsrAllocation, TaskAllocation
from amalthea_uros.perf.os import SERVERS, InterruptController, OperatingSystem, Parameter, Parent, Policy, Scheduler
from amalthea_uros.perf.system import System
from amalthea_uros.timing.scheduling.allocation import allocated_cores, scheduler_cores, standard_policy
from amalthea_uros.timing.scheduling.ranks import ANALYSED, CAPACITY, PERIOD, TIME_SLICE
from amalthea_uros.units import Duration, Time, time_text


@dataclass(frozen=True, slots=True)
class _Dispatchers:
    """What dispatches processes: schedulers, or interrupt controllers.

    Attributes
    ----------
    allocation : makes one of a process and what dispatches it
    field : of an allocation, with the name of what dispatches the process; also the name of the key
    names : of those in a system
    cores : those for which one is responsible
    has_affinity : whether an allocation can select one of several cores; controllers are added for cores without one
    """

    kind: str
    field: str
    place: Collection
    names: Callable[[System], Iterable[str]]
    cores: Callable[[str, System], tuple[str, ...]]
    has_affinity: bool
    allocation: Callable[[str, str], TaskAllocation | IsrAllocation]

    @property
    def keys(self) -> Mapping[str, Key[str]]:
        """The keys of the processes."""
        return {self.field: Key(str, self._show, self._set), "core": Key(str, _show_core, self._set_core)}

    def _allocations(self, system: System, process: str) -> list[str]:
        allocations = getattr(system.mapping, self.place.collection)
        return [getattr(each, self.field) for each in allocations if getattr(each, self.place.identifier) == process]

    def _present(self, system: System, process: str) -> str | None:
        """What dispatches a process, if anything does."""
        found = self._allocations(system, process)
        if len(found) > 1:
            raise InvalidArgumentError(f"{process!r} is mapped to several {self.kind}s")
        return found[0] if found else None

    def _show(self, configuration: Configuration, process: str) -> str:
        return ", ".join(self._allocations(configuration.system, process)) or UNSET

    def _set(self, configuration: Configuration, process: str, name: str) -> Configuration:
        """Map a process, or map it to something else, without a preference for one of its cores."""
        require(self.kind, [name], self.names(configuration.system))
        return self._mapped(configuration, process, name, ())

    def _set_core(self, configuration: Configuration, process: str, core: str) -> Configuration:
        """Map a process to a core: by what dispatches it now if that is responsible for the core, otherwise by what alone is."""
        system = configuration.system
        present = self._present(system, process)
        require("core", [core], system.cores)
        if not self.has_affinity and not any(core in self.cores(each, system) for each in self.names(system)):
            system = _with_controller(system, core)
            configuration = configuration._replace(system=system)
        responsible = [each for each in self.names(system) if self._can_select(each, core, system)]
        name = present if present is not None and present in responsible else self._only(responsible, process, core)
        return self._mapped(configuration, process, name, (core,) if len(self.cores(name, system)) > 1 else ())

    def _can_select(self, name: str, core: str, system: System) -> bool:
        cores = self.cores(name, system)
        return core in cores and (self.has_affinity or len(cores) == 1)

    def _only(self, responsible: list[str], process: str, core: str) -> str:
        if not responsible:
            advice = f"; state its policy, e.g. {core}.policy=FixedPriorityPreemptive" if self.has_affinity else ""
            raise InvalidArgumentError(f"no {self.kind} is responsible for the core {core!r}{advice}")
        if len(responsible) > 1:
            choices = ", ".join(f"{process}.{self.field}={name}" for name in responsible)
            raise InvalidArgumentError(f"several {self.kind}s are responsible for the core {core!r}; choose one: {choices}")
        return responsible[0]

    def _mapped(self, configuration: Configuration, process: str, name: str, cores: tuple[str, ...]) -> Configuration:
        system = configuration.system
        fields: dict[str, Any] = {self.field: name, **({"cores": cores} if self.has_affinity else {})}
        if self._present(system, process) is None:
            system = self.place.with_item(system, self.allocation(process, name))
        return configuration._replace(system=self.place.with_fields(system, process, **fields))


def _show_core(configuration: Configuration, process: str) -> str:
    return ", ".join(sorted(allocated_cores(configuration.system).get(process, ()))) or UNSET


def _controller_cores(controller: str, system: System) -> tuple[str, ...]:
    return system.interrupt_controllers[controller].cores


_DISPATCHED_TASK_KEYS = _Dispatchers(
    kind="scheduler",
    field="scheduler",
    place=TASK_ALLOCATIONS,
    names=lambda system: system.schedulers,
    cores=scheduler_cores,
    has_affinity=True,
    allocation=lambda task, scheduler: TaskAllocation(task=task, scheduler=scheduler),
).keys
ISR_KEYS = _Dispatchers(
    kind="interrupt controller",
    field="controller",
    place=ISR_ALLOCATIONS,
    names=lambda system: system.interrupt_controllers,
    cores=_controller_cores,
    has_affinity=False,
    allocation=lambda isr, controller: IsrAllocation(isr=isr, controller=controller),
).keys


V = TypeVar("V")


def _with_scheduler(configuration: Configuration, changed: Scheduler) -> Configuration:
    """The configuration with another scheduler of the same name."""
    system: System = configuration.system
    for operating_system in system.os.systems:
        schedulers = tuple(changed if each.name == changed.name else each for each in operating_system.schedulers)
        system = OPERATING_SYSTEMS.with_fields(system, operating_system.name, schedulers=schedulers)
    return configuration._replace(system=system)


def _parent_key(field: str, parse: Callable[[str], V], text: Callable[[V], str]) -> Key[V]:
    """The key for a field of the association with the parent."""

    def show(configuration: Configuration, name: str) -> str:
        value = getattr(configuration.system.schedulers[name].parent, field, None)
        return UNSET if value is None else text(value)

    def with_value(configuration: Configuration, name: str, value: V) -> Configuration:
        scheduler = configuration.system.schedulers[name]
        if scheduler.parent is None:
            raise InvalidArgumentError(f"the scheduler {name!r} has no parent, so it has no {field}")
        parent: Parent = replace(scheduler.parent, **{field: value})  # type: ignore[arg-type]
        return _with_scheduler(configuration, replace(scheduler, parent=parent))

    return Key(parse, show, with_value)


def _server_key(what: str, names: tuple[str, ...]) -> Key[Time]:
    """The key for a time of a server.

    Parameters
    ----------
    names : of the parameter; the first one is that of the newest version
    """

    def show(configuration: Configuration, name: str) -> str:
        scheduler = configuration.system.schedulers[name]
        # Those of the association with its parent count more.
        return _stated((*scheduler.parameters, *(scheduler.parent.parameters if scheduler.parent else ())), names)

    def with_value(configuration: Configuration, name: str, value: Time) -> Configuration:
        scheduler = configuration.system.schedulers[name]
        if standard_policy(scheduler.policy) not in SERVERS:
            raise InvalidArgumentError(
                f"the scheduler {name!r} has no {what}: its policy {scheduler.policy} is not that of a server"
            )
        if scheduler.parent is None:
            changed = replace(scheduler, parameters=_with_time(scheduler.parameters, names, value))
            return _with_scheduler(configuration, changed)
        kept = tuple(each for each in scheduler.parameters if each.name not in names)
        parent = replace(scheduler.parent, parameters=_with_time(scheduler.parent.parameters, names, value))
        return _with_scheduler(configuration, replace(scheduler, parameters=kept, parent=parent))

    return Key(positive_duration, show, with_value)


def _stated(parameters: Iterable[Parameter], names: Iterable[str]) -> str:
    """The time that parameters state under one of some names, as text; the last one of a name counts."""
    values = {parameter.name: parameter.values for parameter in parameters}
    match next((values[each] for each in names if each in values), None):
        case (Duration(time),):
            return time_text(time)
    return UNSET


def _with_time(parameters: Iterable[Parameter], names: Sequence[str], time: Time) -> tuple[Parameter, ...]:
    """Parameters with another value of the one that has one of some names."""
    return (*(each for each in parameters if each.name not in names), Parameter(names[0], (Duration(time),)))


def _show_slice(configuration: Configuration, task: str) -> str:
    allocation = TASK_ALLOCATIONS.find(configuration.system, task)
    return UNSET if allocation is None else _stated(allocation.parameters, [TIME_SLICE])


def _set_slice(configuration: Configuration, task: str, time: Time) -> Configuration:
    allocation = TASK_ALLOCATIONS.find(configuration.system, task)
    if allocation is None:
        raise InvalidArgumentError(f"{task!r} is not mapped to a scheduler, so it has no time slice")
    parameters = _with_time(allocation.parameters, [TIME_SLICE], time)
    return configuration._replace(system=TASK_ALLOCATIONS.with_fields(configuration.system, task, parameters=parameters))


def _show_common_slice(configuration: Configuration, name: str) -> str:
    return _stated(configuration.system.schedulers[name].parameters, [TIME_SLICE])


def _set_common_slice(configuration: Configuration, name: str, time: Time) -> Configuration:
    """State the slice of everything below a scheduler that has no slice itself."""
    scheduler = configuration.system.schedulers[name]
    if standard_policy(scheduler.policy) != Policy.PRIORITY_BASED_ROUND_ROBIN:
        raise InvalidArgumentError(
            f"the scheduler {name!r} has no time slice: its policy {scheduler.policy} is not {Policy.PRIORITY_BASED_ROUND_ROBIN}"
        )
    return _with_scheduler(configuration, replace(scheduler, parameters=_with_time(scheduler.parameters, [TIME_SLICE], time)))


def _policy(text: str) -> str:
    """The standard name of a policy for which there is an analysis."""
    policy = standard_policy(text)
    if policy not in (known := (*ANALYSED, *SERVERS)):
        raise InvalidArgumentError(f"{text!r} is not a policy that can be analysed; expected one of {', '.join(known)}")
    return policy


def _show_policy(configuration: Configuration, name: str) -> str:
    return configuration.system.schedulers[name].policy or UNSET


def _set_policy(configuration: Configuration, name: str, policy: str) -> Configuration:
    return _with_scheduler(configuration, replace(configuration.system.schedulers[name], policy=policy))


def _top_schedulers(core: str, system: System) -> list[Scheduler]:
    """The schedulers that decide for a core, without those below them."""
    return [each for each in system.schedulers.values() if each.parent is None and core in each.cores]


def _show_core_policy(configuration: Configuration, core: str) -> str:
    return ", ".join(each.policy or UNSET for each in _top_schedulers(core, configuration.system)) or UNSET


def _set_core_policy(configuration: Configuration, core: str, policy: str) -> Configuration:
    """Change the policy of the scheduler of a core, or add one, with an operating system of its own."""
    system = configuration.system
    require("core", [core], system.cores)
    present = _top_schedulers(core, system)
    if len(present) > 1:
        choices = ", ".join(f"{each.name}.policy={policy}" for each in present)
        raise InvalidArgumentError(f"several schedulers are responsible for the core {core!r}; choose one: {choices}")
    if present:
        return _set_policy(configuration, present[0].name, policy)
    name = unused(f"{core}_scheduler", (*system.schedulers, *(each.name for each in system.os.systems)))
    added = OperatingSystem(name=name, schedulers=(Scheduler(name=name, policy=policy, cores=(core,), executing_core=core),))
    return configuration._replace(system=OPERATING_SYSTEMS.with_item(system, added))


def _with_controller(system: System, core: str) -> System:
    """The system with an interrupt controller of a core, in an operating system of its own."""
    name = unused(f"{core}_interrupts", (*system.interrupt_controllers, *(each.name for each in system.os.systems)))
    controller = InterruptController(name=name, cores=(core,), executing_core=core)
    return OPERATING_SYSTEMS.with_item(system, OperatingSystem(name=name, interrupt_controllers=(controller,)))


TASK_KEYS: Mapping[str, Key[Any]] = {**_DISPATCHED_TASK_KEYS, "time_slice": Key(positive_duration, _show_slice, _set_slice)}
CORE_POLICY = Key(_policy, _show_core_policy, _set_core_policy)
SCHEDULER_KEYS: dict[str, Key[Any]] = {
    "policy": Key(_policy, _show_policy, _set_policy),
    "priority": _parent_key("priority", whole_number, str),
    "deadline": _parent_key("deadline", duration, time_text),
    "capacity": _server_key("capacity", CAPACITY),
    "budget": _server_key("budget", CAPACITY),
    "period": _server_key("period", PERIOD),
    "time_slice": Key(positive_duration, _show_common_slice, _set_common_slice),
}
