"""Which core serves a process, by which policy and with which priority."""

from __future__ import annotations

from dataclasses import dataclass

from amalthea_uros.analyze.notes import Notes
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.software import Process
from amalthea_uros.perf.system import System
from amalthea_uros.units import Time

#: Policies that serve the highest priority first and always preempt.
FIXED_PRIORITY = {Policy.FIXED_PRIORITY_PREEMPTIVE, Policy.OSEK}


@dataclass(frozen=True, slots=True, kw_only=True)
class Placed:
    """A process on a core.

    Attributes
    ----------
    rank : interrupt service routines come before tasks, then priorities decide; higher is served first
    """

    process: Process
    core: str
    is_isr: bool
    priority: int
    deadline: Time | None

    @property
    def rank(self) -> tuple[bool, int]:
        """What decides who is served first."""
        return (self.is_isr, self.priority)


class UnplacedError(Exception):
    """It is not known how a process is served; the text says why."""


@dataclass(slots=True)
class Placement:
    """Finds the places of processes."""

    system: System
    notes: Notes

    def task(self, allocation: TaskAllocation) -> Placed:
        """The place of a task.

        Raises
        ------
        UnplacedError : there is no analysis for how it is scheduled.
        """
        process = self.system.processes.get(allocation.task)
        scheduler = self.system.schedulers.get(allocation.scheduler)
        if process is None or scheduler is None:
            raise UnplacedError("its task or scheduler is not part of the model")
        self._check_policy(scheduler)
        if allocation.priority is None:
            raise UnplacedError("it has no priority")
        return Placed(
            process=process,
            core=self._core(scheduler, allocation.cores),
            is_isr=False,
            priority=allocation.priority,
            deadline=allocation.deadline,
        )

    def _check_policy(self, scheduler: Scheduler) -> None:
        if scheduler.policy is None:
            message = f"the scheduler {scheduler.name!r} names no policy, fixed priorities with preemption are taken"
            self.notes.warning("ANA001", message, scheduler)
        elif scheduler.policy not in FIXED_PRIORITY:
            message = f"there is no analysis for the policy {scheduler.policy!r} of the scheduler {scheduler.name!r}"
            self.notes.warning("ANA002", message, scheduler)
            raise UnplacedError(f"there is no analysis for the policy {scheduler.policy}")
        parents = {other.parent.scheduler for other in self.system.schedulers.values() if other.parent is not None}
        if scheduler.parent is not None or scheduler.name in parents:
            message = f"there is no analysis for schedulers below each other, such as {scheduler.name!r}"
            self.notes.warning("ANA002", message, scheduler)
            raise UnplacedError("there is no analysis for schedulers below each other")

    def _core(self, scheduler: Scheduler, wanted: tuple[str, ...]) -> str:
        cores = [core for core in scheduler.cores if core in wanted] if wanted else list(scheduler.cores)
        if len(cores) != 1:
            why = "several cores serve it" if cores else "no core serves it"
            message = (
                f"the scheduler {scheduler.name!r} decides for {len(scheduler.cores)} cores; only one per task is analysed"
            )
            self.notes.warning("ANA002", message, scheduler)
            raise UnplacedError(why)
        others = [s.name for s in self.system.schedulers.values() if cores[0] in s.cores and s.name != scheduler.name]
        if others:
            message = f"the core {cores[0]!r} is served by {scheduler.name!r} and by {others[0]!r}"
            self.notes.warning("ANA002", message, scheduler)
            raise UnplacedError("two schedulers share its core")
        return cores[0]

    def isr(self, name: str, controller_name: str, priority: int | None) -> Placed:
        """The place of an interrupt service routine; raises as `task`."""
        process = self.system.processes.get(name)
        controller = self.system.interrupt_controllers.get(controller_name)
        if process is None or controller is None:
            raise UnplacedError("its controller is not part of the model")
        if len(controller.cores) != 1:
            raise UnplacedError("several cores serve it" if controller.cores else "no core serves it")
        return Placed(process=process, core=controller.cores[0], is_isr=True, priority=priority or 0, deadline=None)
