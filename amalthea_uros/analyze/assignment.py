"""Priorities with which all tasks of a core meet their deadlines, if there are any.

N. C. Audsley, "On priority assignment in fixed priority scheduling", Information Processing Letters 79, 2001: starting with
the lowest priority, any task that meets its deadline at it gets it; if there is no such task, there is no assignment. This is optimal
because a response time depends on the set of tasks with higher priority, not on their order.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import response_time
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.analyze.results import Analysis, require_analysis
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.timing.critical_sections import Protection
from amalthea_uros.timing.event_models import rescaled
from amalthea_uros.timing.preemption import is_preemptive
from amalthea_uros.timing.scheduling import EqualPriority, ScheduledProcess
from amalthea_uros.units import Time


def assign(tasks: Sequence[Task], deadlines: Sequence[Time], above: Sequence[Task] = ()) -> list[int] | None:
    """The indices of the tasks, lowest priority first; None if no assignment meets all deadlines.

    Parameters
    ----------
    above : tasks of higher priority than all of them, such as ISRs
    """
    remaining = sorted(range(len(tasks)), key=lambda index: -deadlines[index])
    order: list[int] = []
    while remaining:
        # The task with the longest deadline usually fits (deadline-monotonic order).
        fitting = next((index for index in remaining if _fits(index, remaining, tasks, deadlines, above)), None)
        if fitting is None:
            return None
        remaining.remove(fitting)
        order.append(fitting)
    return order


def _fits(
    index: int, remaining: Sequence[int], tasks: Sequence[Task], deadlines: Sequence[Time], above: Sequence[Task]
) -> bool:
    """Whether a task meets its deadline below all other remaining tasks."""
    higher = [*above, *(tasks[other] for other in remaining if other != index)]
    worst = response_time(tasks[index], Interference.of(higher))[0].worst
    return worst is not None and worst <= deadlines[index]


@dataclass(frozen=True, slots=True, kw_only=True)
class Proposal:
    """Priorities for the tasks of a core.

    Attributes
    ----------
    priorities : by the names of tasks; None if there is no proposal, for the `reason`
    """

    core: str
    current: Mapping[str, int | None]
    priorities: Mapping[str, int] | None
    reason: str = ""


def propose_priorities(analysis: Analysis) -> list[Proposal]:
    """A proposal for each core that executes tasks."""
    require_analysis(analysis)
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
    """Why a process prevents a proposal for its core."""
    name = item.name
    if not solution.is_known(name):
        return f"{name!r} could not be analysed: {solution.reasons.get(name, '')}"
    if item.is_isr:
        return ""
    if item.deadline is None:
        return f"{name!r} has no deadline"
    if item.server is not None or item.equal_priority is not EqualPriority.FIFO or len(item.rank) != len((0, item.priority)):
        return f"{name!r} is not scheduled by a single fixed priority"
    if not is_preemptive(item) or solution.context.protection[item.name] != Protection():
        return f"{name!r} can block other tasks, which depends on the priorities"
    return ""


def _task(item: ScheduledProcess, solution: Solution) -> Task:
    events = rescaled(solution.event_models[item.name], solution.context.time_base(item.name))
    return Task(name=item.name, events=events, demand=solution.context.demands[item.name])
