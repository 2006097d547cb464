"""Priorities under which all tasks of a processor meet their deadlines, if there are any.

N. C. Audsley, "On priority assignment in fixed priority scheduling", Information Processing Letters 79, 2001: from the lowest priority
up, any task that meets its deadline there gets it; if none does, there is no such assignment. It is optimal because a response time
depends on which tasks have higher priorities, not on their order.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.analyze.arrivals import finer
from amalthea_uros.analyze.blocking import Blocking, is_interruptible
from amalthea_uros.analyze.busy_window import Interference
from amalthea_uros.analyze.fixed_priority import response_time
from amalthea_uros.analyze.known import Known
from amalthea_uros.analyze.placement import Placed
from amalthea_uros.analyze.settings import Settings
from amalthea_uros.analyze.system import prepare, respond
from amalthea_uros.analyze.task import Sharing, Task
from amalthea_uros.perf.system import System
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


def propose_priorities(system: System, settings: Settings | None = None) -> list[Proposal]:
    """Priorities for each core on which they decide."""
    known = prepare(system, settings)
    respond(known)
    cores = {core: known.on_core(core) for core in system.cores}
    return [_propose(core, here, known) for core, here in cores.items() if any(not placed.is_isr for placed in here)]


def _propose(core: str, here: Sequence[Placed], known: Known) -> Proposal:
    tasks = [placed for placed in here if not placed.is_isr]
    current = {placed.name: placed.priority for placed in tasks}
    reason = next((why for placed in here if (why := _obstacle(placed, known))), "")
    if reason:
        return Proposal(core=core, current=current, priorities=None, reason=reason)
    grains = known.demands.grains(core)
    deadlines = [(placed.deadline or 0) * grains for placed in tasks]
    above = [_task(placed, known, grains) for placed in here if placed.is_isr]
    order = assign([_task(placed, known, grains) for placed in tasks], deadlines, above)
    if order is None:
        return Proposal(core=core, current=current, priorities=None, reason="no assignment of priorities meets all deadlines")
    numbers = sorted({priority for priority in current.values() if priority is not None})
    if len(numbers) < len(tasks):
        numbers = list(range(1, len(tasks) + 1))
    found = {tasks[index].name: number for index, number in zip(order, numbers, strict=True)}
    return Proposal(core=core, current=current, priorities={placed.name: found[placed.name] for placed in tasks})


def _obstacle(placed: Placed, known: Known) -> str:
    """Why nothing can be proposed for the core of a process."""
    name = placed.name
    if name not in known.costs or name not in known.arrivals:
        return f"too little is known of {name!r}: {known.reasons.get(name, '')}"
    if placed.is_isr:
        return ""
    if placed.deadline is None:
        return f"{name!r} has no deadline"
    if placed.server is not None or placed.sharing is not Sharing.ARRIVAL or len(placed.rank) != len((0, placed.priority)):
        return f"more than one priority decides about {name!r}"
    if not is_interruptible(placed) or Blocking([placed], known.demands).ceilings:
        return f"{name!r} may hold up others, which depends on the priorities"
    return ""


def _task(placed: Placed, known: Known, grains: int) -> Task:
    return Task(name=placed.name, arrivals=finer(known.arrivals[placed.name], grains), cost=known.costs[placed.name])
