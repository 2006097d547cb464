"""The operating systems of a project, and what they dispatch."""

from __future__ import annotations

from collections.abc import Iterator
from operator import attrgetter

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.inchron_bridge.basics.orders import in_order
from amalthea_uros.inchron_bridge.basics.values import time_of
from amalthea_uros.inchron_bridge.tables.os import DEFAULT, FURTHER, GLOBAL, POLICIES
from amalthea_uros.perf import os as perf
from amalthea_uros.perf.mapping import IsrAllocation, TaskAllocation


@dataclass(slots=True)
class Dispatch:
    """The allocations and operating systems of a project.

    Attributes
    ----------
    unknown : cores on which something is executed that is not understood, by its name; no cores stand for all
    """

    systems: list[perf.OperatingSystem] = field(default_factory=list)
    tasks: list[TaskAllocation] = field(default_factory=list)
    isrs: list[IsrAllocation] = field(default_factory=list)
    unknown: list[ProjectObject] = field(default_factory=list)


def extract_systems(context: Importing, model: ProjectObject) -> Dispatch:
    """The operating systems with schedulers and allocations."""
    result = Dispatch()
    for system in model["systems"]:
        if system.kind != "GenericSystem":
            context.leave_out(system)
            result.unknown.append(system)
            continue
        _SystemReader(system, context, result).extract()
    return result


class _SystemReader:
    """One operating system."""

    def __init__(self, system: ProjectObject, context: Importing, result: Dispatch) -> None:
        self.system = system
        self.context = context
        self.result = result
        self.schedulers: list[perf.Scheduler] = []
        self.controllers: list[perf.InterruptController] = []
        self.known = {context.name_of("CpuCore", core) for cpu in context.model["cpus"] for core in cpu["cores"]}

    def extract(self) -> None:
        for root in self.system["rtosConfig"]["schedulables"]:
            self.root(root)
        if self.system.name == GLOBAL and not self.controllers:
            return
        kept = self.context.fields(self.system, perf.OperatingSystem, ("overhead", "protection"))
        schedulers = in_order(self.schedulers, attrgetter("name"), self.context.noted(self.system).get("schedulers"))
        made = perf.OperatingSystem(
            name=self.context.name("System", self.system),
            schedulers=schedulers,
            interrupt_controllers=tuple(self.controllers),
            origin=self.context.located(self.system),  # type: ignore[arg-type]
            **kept,
        )
        self.result.systems.append(made)

    def root(self, root: ProjectObject) -> None:
        """The root of a scheduler tree: what dispatches interrupts, if there are only schedulers and ISRs below it."""
        context = self.context
        processes = [each for each in root["schedulables"] if each.kind == "Process"]
        if any(not each["isr"] for each in processes):
            self.scheduler(root, None)
            return
        kept = [each for each in context.list_of(root, "controllers", (perf.InterruptController,)) if self.has_cores(each)]
        if not kept and processes and self.system.name != GLOBAL:
            kept = [perf.InterruptController(name=root.name, cores=self.cores(root))]
        renamed = {each.name: context.name("InterruptController", root, each.name) for each in kept}
        origin = context.location(root)
        self.controllers += [replace(each, name=renamed[each.name], origin=origin) for each in kept]
        if kept:
            self.isrs(processes, renamed, root)
        for each in root["schedulables"]:
            self.below(each, None)

    def has_cores(self, controller: perf.InterruptController) -> bool:
        """Whether the cores that a comment names are those of the project."""
        return self.known.issuperset(controller.cores) and controller.executing_core in (*self.known, None)

    def isrs(self, processes: list[ProjectObject], controllers: dict[str, str], root: ProjectObject) -> None:
        """The allocations of interrupt service routines."""
        for process in processes:
            isr = self.context.name_of("Process", process)
            stated = self.context.noted(process).get("controller")
            if isr is None or (stated is None and self.system.name == GLOBAL):
                continue
            controller = controllers.get(stated if isinstance(stated, str) else "", next(iter(controllers.values())))
            self.result.isrs.append(IsrAllocation(isr=isr, controller=controller, priority=self.priority(process, root)))

    def below(self, item: ProjectObject, parent: ProjectObject | None) -> None:
        """Read a part of a scheduler, besides ISRs of the root."""
        if item.kind == "Scheduler":
            self.scheduler(item, parent)
        elif item.kind != "Process":
            self.context.leave_out(item)
            self.result.unknown.append(item)

    def scheduler(self, item: ProjectObject, parent: ProjectObject | None) -> None:
        """A scheduler with the tasks below it."""
        context = self.context
        if self.system.name == GLOBAL and item.name == DEFAULT and not item["cpuCores"]:
            return
        name = context.name("Scheduler", item)
        kept = context.fields(item, perf.Scheduler, ("policy", "parameters", "parent", "overhead", "executing_core"))
        above = context.name_of("Scheduler", parent)
        values = {
            "policy": _policy(item),
            "parent": perf.Parent(scheduler=above, priority=item["priority"]) if above is not None else None,
            **kept,
        }
        if values.get("executing_core") not in self.known:
            values.pop("executing_core", None)
        cores = self.cores(item)
        self.schedulers.append(perf.Scheduler(name=name, cores=cores, origin=context.located(item), **values))  # type: ignore[arg-type]
        for process in (each for each in item["schedulables"] if each.kind == "Process"):
            self.task(process, name, item)
        for each in item["schedulables"]:
            self.below(each, item)

    def task(self, process: ProjectObject, scheduler: str, above: ProjectObject) -> None:
        """The allocation of a task."""
        context = self.context
        task = context.name_of("Process", process)
        if task is None:
            return
        allocation = TaskAllocation(
            task=task,
            scheduler=scheduler,
            priority=self.priority(process, above),
            deadline=time_of(process["deadline"]),
            cores=self.cores(process),
            origin=context.located(process),  # type: ignore[arg-type]
            **context.fields(process, TaskAllocation, ("parameters",)),
        )
        self.result.tasks += [allocation, *context.list_of(process, FURTHER, (TaskAllocation,))]

    def priority(self, process: ProjectObject, above: ProjectObject) -> int | None:
        """The priority; higher numbers are served first, unless the scheduler inverts the order."""
        content = self.context.noted(process)
        if "priority" in content and content["priority"] is None and not process["priority"]:
            return None
        return -process["priority"] if above["invertPriorityOrder"] else process["priority"]  # type: ignore[no-any-return]

    def cores(self, item: ProjectObject) -> tuple[str, ...]:
        """The cores of a scheduler or process."""
        return tuple(name for core in item["cpuCores"] if (name := self.context.name_of("CpuCore", core)) is not None)


def _policy(scheduler: ProjectObject) -> str:
    """The policy; the name of an unknown one for what a scheduler may do otherwise."""
    kind, strategy = scheduler["type"], scheduler["strategy"]
    is_plain = kind == "Preemptive" and not scheduler["propagateProcessPriorities"] and not scheduler["synchronized"]
    if strategy == "OSEK" and is_plain:
        return perf.Policy.OSEK
    return POLICIES.get(strategy, strategy) if is_plain and strategy != "RoundRobin" else f"{kind} {strategy}"


def processes_of(model: ProjectObject) -> Iterator[ProjectObject]:
    """The processes of all operating systems that are understood, in the order of the file."""
    for system in model["systems"]:
        if system.kind == "GenericSystem":
            yield from (item for item in system["rtosConfig"].walk() if item.kind == "Process")
