"""The maximum time until a job has executed a part of its demand, under fixed priorities.

The busy window of `fixed_priority`, with only this part of the last job: as long as that has not been executed, the core serves earlier
jobs, tasks of higher priority, or the one task of lower priority that blocks. This holds for tasks of any preemption mode, because none
lets tasks of lower priority go first once it has started; only the advantage of not being preempted is given away.

An access after that part takes no time, and the job may make it only when it has the core again: what arrives at the end of the window
counts, too. Since times are integers, this is the window up to the beginning of one unit more.
"""

from __future__ import annotations

from amalthea_uros.analyze.response_times import fixed_priority
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess
from amalthea_uros.units import Time


def time_until_executed(name: str, executed: Time, solution: Solution) -> Time | None:
    """The maximum time from the activation of a process to what follows a part of its demand, in the time base of its core.

    None where the busy window does not follow the jobs of a process: under other policies, with equal priorities, in servers, where a
    scheduler takes time to decide, and where somebody can wait for a semaphore in the middle of a job.

    Parameters
    ----------
    executed : the worst-case demand of that part, in the time base; 0 for the start of the job
    """
    context = solution.context
    scheduled = context.scheduled[name]
    here = context.served(scheduled.core, scheduled.server)
    processes = [item for item in here if isinstance(item, ScheduledProcess)]
    if scheduled.server is not None or len(processes) < len(here) or any(item.name in context.decisions for item in here):
        return None
    blocking = Blocking.of(processes, solution)
    level = blocking.level(scheduled)
    above = [item for item in processes if item.rank >= level.rank and item.name != name]
    if level.is_flat or any(item.rank == scheduled.rank for item in above) or blocking.obstacle(scheduled):
        return None
    task, *higher = (AnalysedTask.of(item, solution) for item in (scheduled, *above))
    return _longest(task, Interference.of(higher), blocking.time(scheduled), executed)


def _longest(task: AnalysedTask, higher: Interference, blocking: Time, executed: Time) -> Time | None:
    longest: Time = 0
    for job in range(1, fixed_priority.max_jobs(task)):
        window = higher.window(blocking + task.demand.max_demand(job), 0)
        part = higher.window(blocking + task.demand.max_demand(job - 1) + executed + 1, 0)
        if window is None or part is None:
            return None
        longest = max(longest, part - 1 - task.events.delta_min(job))
        if window <= task.events.delta_min(job + 1):
            return longest
    return None
