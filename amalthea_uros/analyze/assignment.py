"""Priorities under which all tasks of a processor meet their deadlines, if there are any.

N. C. Audsley, "On priority assignment in fixed priority scheduling", Information Processing Letters 79, 2001: from the lowest priority
up, any task that meets its deadline there gets it; if none does, there is no such assignment. It is optimal because a response time
depends on which tasks have higher priorities, not on their order.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import response_time
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.analyze.results import Analysis
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.timing.event_models import rescaled
from amalthea_uros.timing.preemption import is_preemptive
from amalthea_uros.timing.scheduling import EqualPriority, ScheduledProcess
from amalthea_uros.units import Time


def assign(tasks: Sequence[Task], deadlines: Sequence[Time], above: Sequence[Task] = ()) -> list[int] | None:
    """The tasks by their indices, those of the lowest priority first; None if no assignment meets all deadlines.

    Parameters
    ----------
    above : tasks that come before all of them, such as interrupts
    """
    left = sorted(range(len(tasks)), key=lambda index: -deadlines[index])
    order: list[int] = []
    while left:
        # Most often the one with the longest deadline fits, which is deadline-monotonic order.
        fitting = next((index for index in left if _fits(index, left, tasks, deadlines, above)), None)
        if fitting is None:
            return None
        left.remove(fitting)
        order.append(fitting)
    return order


def _fits(index: int, left: Sequence[int], tasks: Sequence[Task], deadlines: Sequence[Time], above: Sequence[Task]) -> bool:
    """Whether a task meets its deadline below all others that are left."""
    higher = [*above, *(tasks[other] for other in left if other != index)]
    worst = response_time(tasks[index], Interference.of(higher))[0].worst
    return worst is not None and worst <= deadlines[index]


@dataclass(frozen=True, slots=True, kw_only=True)
class Proposal:
    """Priorities for the tasks of a core.

    Attributes
    ----------
    priorities : by the names of tasks; None if there are none that meet all deadlines, or none can be proposed, as `reason` says
    """

    core: str
    current: Mapping[str, int | None]
    priorities: Mapping[str, int] | None
    reason: str = ""


def propose_priorities(analysis: Analysis) -> list[Proposal]:
    """Priorities for each core on which they decide."""
    solution = analysis.solution
    cores = {core: solution.context.on_core(core) for core in solution.context.system.cores}
    return [_propose(core, here, solution) for core, here in cores.items() if any(not item.is_isr for item in here)]


def _propose(core: str, here: Sequence[ScheduledProcess], solution: Solution) -> Proposal:
    tasks = [item for item in here if not item.is_isr]
    current = {item.name: item.priority for item in tasks}
    reason = next((why for item in here if (why := _obstacle(item, solution))), "")
    if reason:
        return Proposal(core=core, current=current, priorities=None, reason=reason)
    time_base = solution.context.demand_model.time_base(core)
    deadlines = [(item.deadline or 0) * time_base for item in tasks]
    above = [_task(item, solution) for item in here if item.is_isr]
    order = assign([_task(item, solution) for item in tasks], deadlines, above)
    if order is None:
        return Proposal(core=core, current=current, priorities=None, reason="no assignment of priorities meets all deadlines")
    numbers = sorted({priority for priority in current.values() if priority is not None})
    if len(numbers) < len(tasks):
        numbers = list(range(1, len(tasks) + 1))
    found = {tasks[index].name: number for index, number in zip(order, numbers, strict=True)}
    return Proposal(core=core, current=current, priorities={item.name: found[item.name] for item in tasks})


def _obstacle(item: ScheduledProcess, solution: Solution) -> str:
    """Why nothing can be proposed for the core of a process."""
    name = item.name
    if not solution.is_known(name):
        return f"too little is known of {name!r}: {solution.reasons.get(name, '')}"
    if item.is_isr:
        return ""
    if item.deadline is None:
        return f"{name!r} has no deadline"
    if item.server is not None or item.equal_priority is not EqualPriority.FIFO or len(item.rank) != len((0, item.priority)):
        return f"more than one priority decides about {name!r}"
    if not is_preemptive(item) or Blocking([item], solution.context.demand_model).ceilings:
        return f"{name!r} may hold up others, which depends on the priorities"
    return ""


def _task(item: ScheduledProcess, solution: Solution) -> Task:
    events = rescaled(solution.event_models[item.name], solution.context.time_base(item.name))
    return Task(name=item.name, arrivals=events, cost=solution.context.demands[item.name])
