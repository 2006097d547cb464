"""ITEA 1.1.0 -> ITEA 1.2.0: operating systems, kinds of allocations, statistics of label accesses."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from amalthea_uros.xmi.migrate.steps.file_roots import is_isr, sub_models
from amalthea_uros.xmi.migrate.steps.tools import attributes_text
from amalthea_uros.xmi.tree.classes import local_name
from amalthea_uros.xmi.tree.model_set import ModelSet, Step
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import BEYOND_ITEA, NoteKind, Postponed, StepNotes


def change(models: ModelSet, notes: StepNotes) -> None:
    """Change the content of the files of AMALTHEA ITEA 1.1.0."""
    for node in models.rename_classes({"os:DeadlineMonotinic": "os:DeadlineMonotonic"}):
        notes.renamed(node, "class DeadlineMonotinic is DeadlineMonotonic")
    for model in sub_models(models, "osModel"):
        _move_schedulers(model, notes)
    for access in models.nodes("runnableItems", "runnableItem"):
        if access.children and local_name(access.type) == "LabelAccess":
            _keep_fitting_statistics(access, notes)
    _Allocations(notes).split(models)


def _move_schedulers(model: Node, notes: StepNotes) -> None:
    schedulers = model.all("scheduler")
    if not schedulers:
        return
    system = model.add("operatingSystems", at=model.children.index(schedulers[0]), like=schedulers[0], name="OperatingSystem")
    system.take(schedulers)
    for scheduler in schedulers:
        scheduler.tag, scheduler.type, scheduler.target_class = "taskSchedulers", "", "os:TaskScheduler"
        notes.moved(scheduler, "scheduler of the OS model is a task scheduler of an operating system", scheduler.name)


def _keep_fitting_statistics(access: Node, notes: StepNotes) -> None:
    """One value in the place of those of reading and writing: the one that fits the kind of access."""
    kind = access.get("access", "read")
    for statistic in access.all("statistic"):
        found = {part.tag: part for part in statistic.children}
        value = found.get(kind) if kind in ("read", "write") else None
        misses = found.get("readCacheMisses")
        if kind == "write":
            misses = found.get("writeCacheMisses", misses)
        for part, tag in ((value, "value"), (misses, "cacheMisses")):
            if part is not None:
                notes.renamed(part, f"statistic {part.tag!r} of a label access is {tag!r}")
                part.tag = tag
        for part in statistic.all("read", "write", "readCacheMisses", "writeCacheMisses"):
            notes.lost(part, f"statistic {part.tag!r}: the label access is of the other kind", attributes_text(part))
            part.remove()


class _Allocations:
    """`executableAllocation` -> `processAllocation` of tasks and ISRs, `runnableAllocation`."""

    def __init__(self, notes: StepNotes) -> None:
        self.notes = notes
        #: The interrupt controller for the ISRs of an operating system that had none.
        self.controllers: dict[Node, Node] = {}
        #: The schedulers that an interrupt controller takes the place of.
        self.replaced: dict[Node, dict[Node, None]] = {}

    def split(self, models: ModelSet) -> None:
        """Convert all allocations."""
        for allocation in models.nodes("executableAllocation"):
            kind = local_name(allocation.type)
            if kind == "RunnableAllocation" or (kind != "ProcessAllocation" and "entity" in allocation.references):
                allocation.tag, allocation.type = "runnableAllocation", "mapping:RunnableAllocation"
                self.notes.renamed(allocation, "allocation of a runnable has a separate feature")
            else:
                allocation.tag = "processAllocation"
                self.split_process(allocation)
        for controller, schedulers in self.replaced.items():
            message = "interrupt controller of ISRs: it has the cores of the schedulers whose place it takes"
            restore = partial(_allocate, controller, list(schedulers), models)
            what = (NoteKind.CONVERTED, controller, message, controller.name)
            models.postponed.append(Postponed(BEYOND_ITEA, restore, *what, is_kept=True))

    def split_process(self, allocation: Node) -> None:
        """Make an allocation of a process one of a task or of an ISR."""
        process, scheduler = allocation.target("process"), allocation.target("scheduler")
        if process is not None and is_isr(process):
            allocation.type = "mapping:ISRAllocation"
            self.notes.converted(allocation, "allocation of a process is one of an ISR", process.name)
            if scheduler is not None:
                self.give_controller(allocation, scheduler)
            return
        allocation.type = "mapping:TaskAllocation"
        if process is not None and process.is_proxy and not process.get("class"):
            self.notes.defaulted(
                allocation, "allocation of a process that is not in the files; assuming a task", process.get("path")
            )
        else:
            self.notes.converted(allocation, "allocation of a process is one of a task", process.name if process else "")

    def give_controller(self, allocation: Node, scheduler: Node) -> None:
        """Let an interrupt controller take the place of the scheduler of an ISR; all ISRs of an operating system share one."""
        if scheduler.tag == "interruptControllers":
            return
        system = scheduler.parent
        if scheduler.is_proxy or system is None:
            allocation.references.pop("scheduler", None)
            message = "scheduler of an ISR: not found in the files, and ISRs now have interrupt controllers"
            self.notes.lost(allocation, message, scheduler.get("path"), "scheduler")
            return
        controller = self.controllers.get(system)
        if controller is None:
            name = f"interruptController{len(self.controllers) + 1}_migration_generated"
            controller = system.add("interruptControllers", at=system.children.index(scheduler), like=scheduler, name=name)
            controller.add("schedulingAlgorithm", "os:PriorityBased")
            controller.target_class = "os:InterruptController"
            self.controllers[system] = controller
        allocation.references["scheduler"] = [controller]
        self.replaced.setdefault(controller, {})[scheduler] = None
        self.notes.lost(
            allocation,
            "scheduler of an ISR: ISRs have interrupt controllers now, and a new one takes its place",
            f"{scheduler.name} -> {controller.name}",
            "scheduler",
        )


def _allocate(controller: Node, schedulers: Sequence[Node], models: ModelSet) -> None:
    """Allocate an interrupt controller to the cores of some schedulers, so that its ISRs are executed where they were."""
    for allocation in [node for tree in models.trees for node in tree.root.walk() if node.tag == "coreAllocation"]:
        holder = allocation.parent
        if holder is None or allocation.target("scheduler") not in schedulers or not allocation.references.get("core"):
            continue
        made = holder.add("coreAllocation", at=holder.children.index(allocation) + 1, like=allocation)
        made.refer("scheduler", controller)
        made.refer("core", *allocation.references["core"])


STEP = Step("ITEA 1.1.0", "ITEA 1.2.0", change, frozenset({"executableAllocation", "os:DeadlineMonotinic"}))
