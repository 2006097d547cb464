"""Response times of tasks that any core of their scheduler executes, by fixed priorities.

If nothing is preempted, `non_preemptive_cores` has the method. The rest is about tasks that are preempted at once, and migrate.

M. Bertogna and M. Cirinei, "Response-time analysis for globally scheduled symmetric multiprocessor platforms", RTSS 2007: a job of a
task k that has not ended after L has been kept from all m cores for more than L - C_k, so that

    R = C_k + floor(sum over higher priorities of min(W_i(R), R - C_k + 1) / m)

where W_i(L) is the most that a task executes in L if its first job there ends as late as its own response time allows, and the others
follow as early as they can. N. Guan, M. Stigge, W. Yi and G. Yu, "New response time bounds for fixed priority multiprocessor
scheduling", RTSS 2009: it is enough to look at intervals before which some core has been free of higher priorities, so that at most
m - 1 tasks bring a job in that was activated before; the others begin with the interval.

Both hold for sporadic tasks of which each job ends before the next one is activated, on cores that are alike, if nothing else executes
there and nothing keeps a job of higher priority off. All times are multiples of one unit. What is not so is refused with its reason.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.response_times import non_preemptive_cores
from amalthea_uros.analyze.response_times.core import in_picoseconds
from amalthea_uros.analyze.response_times.non_preemptive_schedule import ASSUMPTION as CONSTANT_TIMES
from amalthea_uros.analyze.response_times.non_preemptive_schedule import job_stream
from amalthea_uros.analyze.response_times.schedule_abstraction import JobStream
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import SchedulePoint
from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.perf.stimuli import EventTriggered, InterProcess
from amalthea_uros.timing.activation.releases import RELEASES, releases_with_jitter, response_time_limits
from amalthea_uros.timing.basics.notes import AnalysisNotes
from amalthea_uros.timing.basics.time_base import MAX_INPUT
from amalthea_uros.timing.blocking.critical_sections import LockUsage
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents
from amalthea_uros.timing.jobs.executed import states_execution_time
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.ranks import SchedulingOrder
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, Rank
from amalthea_uros.units import Time

METHOD = "interference on several cores, fixed priorities, preemptive"
SOURCE = "Bertogna, Cirinei 2007; Guan, Stigge, Yi, Yu 2009"
ASSUMPTION = "tasks that several cores can execute migrate without cost, at any time"
#: Steps of a fixed point; with more, the load is so high that a bound would be useless.
MAX_STEPS = 10_000


@dataclass(frozen=True, slots=True)
class MigratingTask:
    """A task that any of some cores executes; times are in the time base of the cores.

    Attributes
    ----------
    distance : the least time between two activations
    jobs : if none of them is ever preempted
    """

    name: str
    rank: Rank
    demand: MultiframeDemand
    events: EventModel
    distance: Time
    jobs: JobStream | None = None

    @property
    def longest(self) -> Time:
        """The worst-case execution time."""
        return self.demand.worst

    def with_carry_in(self, window: Time, response: Time) -> Time:
        """The most that it executes in a window that can begin while a job is pending."""
        length = window + response - self.longest
        whole, rest = divmod(length, self.distance)
        return whole * self.longest + min(self.longest, rest)

    def without_carry_in(self, window: Time) -> Time:
        """The most that it executes in a window before which no job is pending."""
        whole, rest = divmod(window, self.distance)
        return whole * self.longest + min(self.longest, rest)


@dataclass(frozen=True, slots=True)
class MigratingResult:
    """The response time of a task that several cores can execute, in picoseconds, and what it follows from."""

    response: Response
    demand: MultiframeDemand
    events: EventModel
    time_base: int


def responses_on_several_cores(context: TimingContext) -> dict[str, MigratingResult]:
    """The response times of the tasks of all schedulers to which the method applies."""
    results: dict[str, MigratingResult] = {}
    for scheduler in context.system.schedulers.values():
        if len(set(scheduler.cores)) < 2 or scheduler.parent is not None:
            continue
        try:
            tasks = _tasks(scheduler.name, context)
        except UnknownError as error:
            context.notes.warning("ANA002", f"tasks of the scheduler {scheduler.name!r} are not analysed: {error}", scheduler)
            continue
        cores, time_base = len(set(scheduler.cores)), context.demand_model.time_base(scheduler.cores[0])
        streams = [task.jobs for task in tasks if task.jobs is not None]
        responses = non_preemptive_cores.response_times(streams, cores) if streams else response_times(tasks, cores)
        for assumption in (RELEASES, CONSTANT_TIMES) if streams else (ASSUMPTION,) if tasks else ():
            context.notes.assume(assumption)
        for task, response in zip(tasks, responses, strict=True):
            results[task.name] = MigratingResult(in_picoseconds(response, time_base), task.demand, task.events, time_base)
    return results


def _tasks(name: str, context: TimingContext) -> Sequence[MigratingTask]:
    """The tasks of a scheduler, the most important one first; none if each one has a core of its own.

    Raises
    ------
    UnknownError : the method does not apply to them.
    """
    system = context.system
    scheduler = system.schedulers[name]
    allocations = [each for each in system.mapping.tasks if each.scheduler == name]
    cores = set(scheduler.cores)
    if all(each.task in context.scheduled for each in allocations):
        return ()
    for each in allocations:
        if each.cores and set(each.cores) != cores:
            raise UnknownError(f"{each.task!r} can run on some of its cores only")
    own = {each.task for each in allocations}
    if len(own) < len(allocations) or any(each.task in own and each.scheduler != name for each in system.mapping.tasks):
        raise UnknownError("a task is allocated more than once")
    for other in system.processes:
        if other not in own and not cores.isdisjoint(context.touching.cores_of(other)):
            raise UnknownError(f"{other!r}, which it does not schedule, can run on its cores")
    if any(each.parent is not None and each.parent.scheduler == name for each in system.schedulers.values()):
        raise UnknownError("it has other schedulers below it")
    if scheduler.overhead:
        raise UnknownError("it takes time for each decision")
    order = SchedulingOrder(system, AnalysisNotes(), response_time_limits(system))
    tasks = []
    for each in allocations:
        item = order.on_any_core(each)
        if item.equal_priority is not EqualPriority.FIFO or item.group is not None or item.server is not None:
            raise UnknownError("it does not schedule all of its tasks by fixed priorities")
        tasks.append(_task(item.process, item.rank, sorted(cores), context))
    if len({task.rank for task in tasks}) < len(tasks):
        raise UnknownError("some of its tasks share a priority")
    if len({task.jobs is None for task in tasks}) > 1:
        raise UnknownError("some of its tasks are preempted, and others are not")
    return sorted(tasks, key=lambda task: task.rank, reverse=True)


def _task(process: object, rank: Rank, cores: Sequence[str], context: TimingContext) -> MigratingTask:
    """A task of which each job ends alone; raises as `_tasks`."""
    assert isinstance(process, Task)
    name, model = process.name, context.demand_model
    is_preempted = process.preemption is Preemption.PREEMPTIVE
    if not (is_preempted or _is_never_preempted(process, context)) or context.touching.protection[name] != LockUsage():
        raise UnknownError(f"{name!r} cannot be preempted everywhere")
    if name in context.system.executor_of_task or name in context.unknown_demands:
        raise UnknownError(f"{name!r} does not only execute what its activities say")
    demands = [model.of_process(process, core) for core in cores]
    if not states_execution_time(process, context.system) or demands[0].worst > MAX_INPUT:
        raise UnknownError(f"the execution time of {name!r} is unknown or too long")
    if len({(model.time_base(core), demand) for core, demand in zip(cores, demands, strict=True)}) > 1:
        raise UnknownError(f"{name!r} does not take the same time on each of its cores")
    stimuli = [context.system.stimuli_by_name.get(each) for each in process.stimuli]
    if any(isinstance(each, InterProcess | EventTriggered) for each in stimuli):
        raise UnknownError(f"other processes activate {name!r}")
    events = context.activations.of(process)
    distance = events.delta_min(2) if isinstance(events, PeriodicEvents) else 0
    if not distance:
        raise UnknownError(f"{name!r} has no least time between two activations")
    time_base, releases = model.time_base(cores[0]), releases_with_jitter(process, context.system)
    if is_preempted:
        return MigratingTask(name, rank, demands[0], events, distance * time_base)
    if releases is None:
        raise UnknownError(f"{name!r} is not preempted, and when it is activated is unknown")
    return MigratingTask(name, rank, demands[0], events, distance * time_base, job_stream(releases, demands[0], time_base))


def _is_never_preempted(task: Task, context: TimingContext) -> bool:
    return task.preemption is Preemption.NON_PREEMPTIVE and SchedulePoint not in context.system.activity_classes


def response_times(tasks: Sequence[MigratingTask], cores: int) -> Iterator[Response]:
    """The response times of tasks, the most important one first; from the first one without a bound on, none has one."""
    known: dict[str, Time] = {}
    reason = ""
    for number, task in enumerate(tasks):
        if not reason:
            bound = _response(task, tasks[:number], known, cores)
            if bound is None:
                reason = f"it need not end before its next activation, where the analysis of {cores} cores has no bound"
            else:
                known[task.name] = bound
        worst = None if reason else known[task.name]
        yield Response(
            worst=worst,
            best=task.demand.best,
            method=METHOD,
            source=SOURCE,
            claim=Claim.BOUND,
            window=worst or 0,
            terms={} if worst is None else {"own": task.longest, "interference": worst - task.longest},
            reason=reason,
        )
        if worst is None and task.name not in reason and not reason.startswith("depends"):
            reason = f"depends on {task.name!r}, which has no bounded response time"


def _response(task: MigratingTask, higher: Sequence[MigratingTask], known: Mapping[str, Time], cores: int) -> Time | None:
    """The response time of a task below tasks of known ones; None if it can be longer than the distance of activations."""
    window = task.longest
    for _ in range(MAX_STEPS):
        if window > task.distance:
            return None
        load = _LevelLoad.of(window, higher, known)
        delay = load.least_time(window - task.longest + 1, cores)
        if task.longest + delay - 1 == window:
            return window
        window = task.longest + delay - 1
    return None


@dataclass(frozen=True, slots=True)
class _LevelLoad:
    """The most that each task of higher priority executes in a window, without and with a job that it brings in."""

    amounts: Sequence[tuple[Time, Time]]

    @classmethod
    def of(cls, window: Time, higher: Sequence[MigratingTask], known: Mapping[str, Time]) -> _LevelLoad:
        """The load by tasks of known response times."""
        return cls([(each.without_carry_in(window), each.with_carry_in(window, known[each.name])) for each in higher])

    def interference(self, most: Time, cores: int) -> Time:
        """The time for which cores are busy with other tasks, on all cores together, if no task counts for more than a time."""
        fresh = [min(without, most) for without, _ in self.amounts]
        more = sorted((max(0, min(brought, most) - min(without, most)) for without, brought in self.amounts), reverse=True)
        return sum(fresh) + sum(more[: cores - 1])

    def least_time(self, start: Time, cores: int) -> Time:
        """The least time, not below `start`, for which not all cores can be busy; the share of it that they are only decreases."""
        low, high = start, start + sum(max(pair) for pair in self.amounts)
        while low < high:
            middle = (low + high) // 2
            if self.interference(middle, cores) < cores * middle:
                high = middle
            else:
                low = middle + 1
        return low
