"""Operating systems: schedulers, and the processes that they dispatch."""

from __future__ import annotations

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.comments import keep_list, note
from amalthea_uros.inchron_bridge.basics.exporting import Exporting
from amalthea_uros.perf import os as perf
from amalthea_uros.perf.mapping import IsrAllocation, TaskAllocation
from amalthea_uros.timing.scheduling.allocation import standard_policy

#: The operating system for what belongs to none, and the root of every scheduler tree (am2inc, osModel.cpp and relax.cpp).
GLOBAL, ROOT, DEFAULT = "__GLOBAL__", "IsrScheduler", "DefaultScheduler"

#: Policies of which a project has a strategy; the others have none, and become one that nothing else means.
STRATEGIES: dict[str, str] = {
    perf.Policy.FIXED_PRIORITY_PREEMPTIVE: "FixedPriority",
    perf.Policy.OSEK: "FixedPriority",
    perf.Policy.EARLIEST_DEADLINE_FIRST: "EDF",
    perf.Policy.PRIORITY_BASED_ROUND_ROBIN: "RoundRobin",
}
UNKNOWN_STRATEGY = "UserDefined"
#: What a strategy is read as.
POLICIES = {"FixedPriority": perf.Policy.FIXED_PRIORITY_PREEMPTIVE, "EDF": perf.Policy.EARLIEST_DEADLINE_FIRST}
_WRITTEN = frozenset(POLICIES.values())

_CORES = "cpuCores"
#: The key of the allocations of a task besides the one that is the place of its process.
FURTHER = "allocations"


def build_systems(context: Exporting) -> None:
    """Make the operating systems with their schedulers, and put the processes below them."""
    for system in context.system.os.systems:
        _SystemBuilder(system, context).build()
    tasks: dict[str, list[TaskAllocation]] = {}
    for allocation in context.system.mapping.tasks:
        tasks.setdefault(allocation.task, []).append(allocation)
    isrs = {allocation.isr: allocation for allocation in context.system.mapping.isrs}
    for isr in context.system.software.isrs:
        _place_isr(context.need("Process", isr.name, isr.name), isrs.get(isr.name), context)
    for task in context.system.software.tasks:
        _place_task(context.need("Process", task.name, task.name), tasks.get(task.name, []), context)


class _SystemBuilder:
    """One operating system."""

    def __init__(self, system: perf.OperatingSystem, context: Exporting) -> None:
        self.system = system
        self.context = context
        self.root = ProjectObject("Scheduler", name=ROOT)

    def build(self) -> None:
        context, system = self.context, self.system
        made = ProjectObject("GenericSystem", name=system.name)
        made["rtosConfig"] = ProjectObject("RtosConfig", name="RtosConfig", schedulables=[self.root])
        context.keep(made, system, "overhead", "protection")
        context.model.add("systems", context.register("System", system.name, made))
        for controller in system.interrupt_controllers:
            context.register("InterruptController", controller.name, self.root)
            if controller.overhead:
                context.lost(controller, "InterruptController.overhead")
        if len(system.schedulers) > 1:
            note(made, schedulers=[each.name for each in system.schedulers])
        if system.interrupt_controllers:
            keep_list(self.root, "controllers", system.interrupt_controllers)
        for scheduler in system.schedulers:
            context.register("Scheduler", scheduler.name, self.scheduler(scheduler))
        for scheduler in system.schedulers:
            above = context.find("Scheduler", scheduler.parent.scheduler) if scheduler.parent else None
            (above or self.root).add("schedulables", context.need("Scheduler", scheduler.name, system.name))
        self.root[_CORES] = self.root_cores()

    def root_cores(self) -> list[ProjectObject]:
        """The cores of the controllers that have interrupt service routines; if they have none, those of the schedulers below."""
        used = {allocation.controller for allocation in self.context.system.mapping.isrs}
        controllers = [each for each in self.system.interrupt_controllers if each.name in used and each.cores]
        below = [each for each in self.system.schedulers if each.parent is None]
        return list(dict.fromkeys(core for each in controllers or below for core in self.cores(each)))

    def scheduler(self, scheduler: perf.Scheduler) -> ProjectObject:
        """A scheduler with its policy."""
        context = self.context
        strategy = STRATEGIES.get(
            standard_policy(scheduler.policy) or "", UNKNOWN_STRATEGY if scheduler.policy else "FixedPriority"
        )
        made = ProjectObject("Scheduler", name=scheduler.name, strategy=strategy, cpuCores=self.cores(scheduler))
        if scheduler.policy is None:
            context.changed(
                scheduler, "a scheduler without a policy", "as one by fixed priorities, as the importer of INCHRON takes it"
            )
        if strategy == UNKNOWN_STRATEGY:
            context.keep(made, scheduler, "policy")
        elif scheduler.policy not in _WRITTEN:
            note(made, policy=scheduler.policy)  # another name, or OSEK, whose other properties are those of the processes
        context.keep(made, scheduler, "parameters", "parent", "overhead")
        if scheduler.executing_core is not None:
            note(made, executing_core=scheduler.executing_core)
        own = next((each.values[0] for each in scheduler.parameters if each.name == "priority"), None)
        if isinstance(own, int):
            made["priority"] = own
        return made

    def cores(self, scheduler: perf.Scheduler | perf.InterruptController) -> list[ProjectObject]:
        """The cores of a scheduler."""
        return [self.context.need("CpuCore", core, scheduler.name) for core in scheduler.cores]


def global_system(context: Exporting) -> ProjectObject:
    """The operating system for what belongs to none, made when it is first needed."""
    result = context.find("System", GLOBAL)
    if result is None:
        default = context.register("Scheduler", DEFAULT, ProjectObject("Scheduler", name=DEFAULT))
        root = context.register("InterruptController", GLOBAL, ProjectObject("Scheduler", name=ROOT, schedulables=[default]))
        config = ProjectObject("RtosConfig", name="RtosConfig", schedulables=[root])
        result = context.register("System", GLOBAL, ProjectObject("GenericSystem", name=GLOBAL, rtosConfig=config))
        context.model.add("systems", result)
    return result


def _place_isr(process: ProjectObject, allocation: IsrAllocation | None, context: Exporting) -> None:
    controller = context.find("InterruptController", allocation.controller) if allocation else None
    if controller is None:
        global_system(context)
        controller = context.need("InterruptController", GLOBAL, GLOBAL)
    if allocation is not None:
        note(process, controller=allocation.controller)
        result = context.system.interrupt_controllers.get(allocation.controller)
        process[_CORES] = [context.need("CpuCore", core, process.name) for core in (result.cores if result else ())]
        _set_priority(process, allocation.priority)
    controller.add("schedulables", process)


def _set_priority(process: ProjectObject, priority: int | None) -> None:
    """A process of a project always has a priority; that it has none is not the same as 0."""
    process["priority"] = priority or 0
    if priority is None:
        note(process, priority=None)


def _place_task(process: ProjectObject, allocations: list[TaskAllocation], context: Exporting) -> None:
    if not allocations:
        global_system(context)
        context.need("Scheduler", DEFAULT, GLOBAL).add("schedulables", process)
    for allocation in allocations[:1]:
        _set_priority(process, allocation.priority)
        process[_CORES] = [context.need("CpuCore", core, process.name) for core in allocation.cores]
        if allocation.deadline is not None:
            process["deadline"] = context.time(allocation.deadline, process.name)
        context.keep(process, allocation, "parameters")
        context.need("Scheduler", allocation.scheduler, process.name).add("schedulables", process)
    for other in allocations[1:]:
        context.lost(process, f"a second allocation, to {other.scheduler},")
    keep_list(process, FURTHER, allocations[1:])
