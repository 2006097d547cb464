"""Which processes cause the interference in a worst-case response time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.core import periodic_tasks
from amalthea_uros.analyze.results import Analysis, Response
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.timing.multiframe import MultiframeDemand
from amalthea_uros.timing.scheduling import ScheduledProcess
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class Share:
    """The share of one process in the interference: number of jobs, and their time in picoseconds."""

    name: str
    jobs: int
    time: Time


def shares(analysis: Analysis, name: str) -> list[Share]:
    """The shares of all processes, largest first; empty if the method does not give them."""
    solution = analysis.solution_of(name)
    response, scheduled = solution.responses.get(name), solution.context.scheduled.get(name)
    if response is None or response.worst is None or scheduled is None:
        return []
    in_schedule = response.method == schedule.METHOD
    found = _in_schedule(solution, scheduled) if in_schedule else _in_window(solution, scheduled, response)
    return sorted(found, key=lambda share: -share.time)


def _in_schedule(solution: Solution, scheduled: ScheduledProcess) -> list[Share]:
    """The execution of other tasks between the release and the end of the worst job."""
    tasks = periodic_tasks(scheduled.core, solution)
    until = schedule.steady_state_start(tasks) + 2 * schedule.hyperperiod(tasks)
    jobs = schedule.schedule(tasks, until, MultiframeDemand.worst_of, [True] * len(tasks))
    own = jobs[[task.name for task in tasks].index(scheduled.name)]
    worst = int((own.ends - own.releases).argmax())
    begin, end = own.releases[worst], own.ends[worst]
    time_base = solution.context.time_base(scheduled.name)
    found = []
    for task, each in zip(tasks, jobs, strict=True):
        slices = each.execution_slices
        inside = np.minimum(slices[:, 2], end) - np.maximum(slices[:, 1], begin)
        if task.name != scheduled.name and (inside > 0).any():
            count = len(set(slices[inside > 0, 0].tolist()))
            found.append(Share(task.name, count, int(inside[inside > 0].sum()) // time_base))
    return found


def _in_window(solution: Solution, scheduled: ScheduledProcess, response: Response) -> list[Share]:
    """The demand of higher priorities in the busy window, if that is all of the interference."""
    context = solution.context
    time_base = context.time_base(scheduled.name)
    here = context.on_core(scheduled.core)
    found = []
    for other in here:
        if other.name == scheduled.name or other.rank < scheduled.rank:
            continue
        if other.server != scheduled.server or other.name not in solution.event_models:
            return []
        count = solution.event_models[other.name].eta_plus(response.window)
        found.append(Share(other.name, count, context.demands[other.name].max_demand(count) // time_base))
    return found if _adds_up(found, response) else []


def _adds_up(found: Sequence[Share], response: Response) -> bool:
    """Whether the shares add up to the interference, apart from one picosecond of rounding each."""
    return abs(sum(share.time for share in found) - response.terms.get("interference", 0)) <= len(found) + 1
