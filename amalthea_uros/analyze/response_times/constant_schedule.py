"""The schedule of a core on which no task preempts another one, with known releases and constant execution times, job by job.

Without preemption a job can end later because another one executes for a shorter time (R. L. Graham, "Bounds on multiprocessing timing
anomalies", SIAM Journal on Applied Mathematics 17(2), 1969), so that the schedule says nothing of execution times that vary. If all are
constant, it is the only behaviour of the core. It is followed until its state is that of a hyperperiod before.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from heapq import heapify, heappop, heappush
from math import lcm

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.perf.activities import SchedulePoint
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.timing.blocking.critical_sections import LockUsage
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess, preemption
from amalthea_uros.units import Time

METHOD = "schedule until it repeats, fixed priorities, non-preemptive, constant execution times"
SOURCE = "job by job"
ASSUMPTION = (
    "execution times with a single value are constant; without preemption, a shorter one can make other tasks later than stated"
)
#: Longer schedules are not played; busy windows give bounds.
MAX_JOBS = 20_000


@dataclass(frozen=True, slots=True, kw_only=True)
class _ConstantTask:
    """A task in the time base of its core; the highest rank is served first."""

    name: str
    rank: int
    period: Time
    offset: Time
    demand: Time


@dataclass(frozen=True, slots=True, order=True)
class _WaitingJob:
    """A job that waits, ordered by its rank, then by its release.

    Attributes
    ----------
    blocking : how long a job of lower rank goes on after the release
    """

    order: int
    release: Time
    task: int
    blocking: Time


def constant_responses(core: str, solution: Solution) -> Mapping[str, Response]:
    """The exact response times, in picoseconds; none if the core is not of this kind, or its schedule too long."""
    tasks = _tasks(core, solution)
    if len(tasks) < 2 or sum(Fraction(task.demand, task.period) for task in tasks) > 1:
        return {}
    times: list[list[tuple[Time, Time]]] = [[] for _ in tasks]
    for count, (job, end) in enumerate(_played(tasks)):
        if count >= MAX_JOBS:
            return {}
        times[job.task].append((end - job.release, job.blocking))
    if any(_may_lose(task, own, solution) for task, own in zip(tasks, times, strict=True)):
        # Without a lost job, others can be later than in the schedule.
        return {}
    solution.context.notes.assume(ASSUMPTION)
    time_base = solution.context.demand_model.time_base(core)
    return {
        task.name: _response(task, own, solution.responses[task.name], time_base)
        for task, own in zip(tasks, times, strict=True)
    }


def _tasks(core: str, solution: Solution) -> Sequence[_ConstantTask]:
    """The tasks of a core of this kind, the most important one first; none for another one."""
    context = solution.context
    if context.decisions or context.has_loops_or_waits(core) or not solution.is_closed(core):
        return ()
    here = [item for item in context.served(core, None) if isinstance(item, ScheduledProcess)]
    if len({item.rank for item in here}) < len(context.served(core, None)) or SchedulePoint in context.system.activity_classes:
        return ()
    time_base, found = context.demand_model.time_base(core), list[_ConstantTask]()
    for place, item in enumerate(here):
        stimulus = known_releases(item.process, context.system)
        if stimulus is None or not _is_constant(item, solution):
            return ()
        found.append(
            _ConstantTask(
                name=item.name,
                rank=-place,
                period=stimulus.period * time_base,
                offset=stimulus.offset * time_base,
                demand=context.demands[item.name].worst,
            )
        )
    return found


def _is_constant(item: ScheduledProcess, solution: Solution) -> bool:
    """Whether a process is never preempted, locks nothing, and always takes the same time."""
    response = solution.responses.get(item.name)
    return (
        preemption(item) is Preemption.NON_PREEMPTIVE
        and item.group is None
        and response is not None
        and response.worst is not None
        and solution.is_analysable(item.name)
        and solution.context.protection[item.name] == LockUsage()
        and all(frame.is_always and frame.worst == frame.best for frame in solution.context.demands[item.name].frames)
    )


def _may_lose(task: _ConstantTask, times: Sequence[tuple[Time, Time]], solution: Solution) -> bool:
    """Whether more jobs of a task are pending than its activation limit allows."""
    process = solution.context.scheduled[task.name].process
    return isinstance(process, Task) and -(-max(times)[0] // task.period) > process.activation_limit


def _played(tasks: Sequence[_ConstantTask]) -> Iterator[tuple[_WaitingJob, Time]]:
    """The jobs with their ends, until the schedule repeats."""
    hyperperiod = lcm(*(task.period for task in tasks))
    boundary = max(task.offset for task in tasks)
    releases = [(task.offset, number) for number, task in enumerate(tasks)]
    heapify(releases)
    waiting: list[_WaitingJob] = []
    now, running, seen = 0, None, set()
    while True:
        if not waiting:
            now = max(now, releases[0][0])
        while releases[0][0] <= now:
            release, number = heappop(releases)
            blocks = running is not None and tasks[running].rank < tasks[number].rank
            heappush(waiting, _WaitingJob(-tasks[number].rank, release, number, now - release if blocks else 0))
            heappush(releases, (release + tasks[number].period, number))
        if now >= boundary:
            boundary += (now - boundary) // hyperperiod * hyperperiod
            state = now - boundary, tuple(sorted((job.task, boundary - job.release) for job in waiting))
            if state in seen:
                return
            seen.add(state)
            boundary += hyperperiod
        job = heappop(waiting)
        now, running = now + tasks[job.task].demand, job.task
        yield job, now


def _response(task: _ConstantTask, times: Sequence[tuple[Time, Time]], bound: Response, time_base: int) -> Response:
    worst, blocking = max(times)
    longest, own = -(-worst // time_base), -(-task.demand // time_base)
    blocked = min(-(-blocking // time_base), longest - own)
    return replace(
        bound,
        worst=longest,
        best=min(times)[0] // time_base,
        method=METHOD,
        source=SOURCE,
        claim=Claim.EXACT,
        jobs=len(times),
        window=longest,
        completions=(),
        terms={"own": own, "interference": longest - own - blocked, "blocking": blocked},
    )
