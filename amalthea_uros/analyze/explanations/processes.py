"""What the worst-case response times of processes and callbacks consist of: own execution, and interference."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

import numpy as np

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.core_schedule import METHOD, CoreSchedule
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.explanations import (
    CallbackExplanation,
    ExecutionShare,
    Load,
    Origin,
    OriginKind,
    ProcessExplanation,
    Share,
)
from amalthea_uros.errors import UnknownError
from amalthea_uros.judge.verdict import FAILURES, Verdict
from amalthea_uros.perf.activities import Activity, Call, Execute, ExecutionNeed, Group, LabelAccess, Loop, WaitEvent, walk
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.basics.time_base import Ticks, max_time, min_time
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.jobs.counters import takes_effect
from amalthea_uros.timing.response import Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess, Server


def explain_process(analysis: Analysis, name: str) -> ProcessExplanation:
    """Explain the response time of a process."""
    process, context = analysis.processes[name], analysis.solution.context
    scheduled = context.scheduled.get(name)
    is_unbounded = process.response is None or process.response.worst is None
    is_late = is_unbounded or process.verdict in (*FAILURES, Verdict.UNKNOWN)
    schedule = _schedule(analysis, name)
    worst_job = None if schedule is None else _worst_job(schedule, name) + 1
    server = context.servers.get(scheduled.server or "") if scheduled is not None else None
    return ProcessExplanation(
        process=process,
        execution=tuple(execution_shares(context, name)),
        shares=tuple(shares(analysis, name)),
        loads=tuple(_loads(analysis.solution, scheduled)) if is_late and scheduled is not None else (),
        supply=Fraction(server.budget, server.period) if server is not None else Fraction(1),
        callbacks=tuple(each for each in analysis.callbacks if each.process == name),
        worst_job=worst_job,
        in_worst_job=()
        if worst_job is None
        else tuple(
            share.counter is None or takes_effect(share.counter, worst_job)
            for share in execution_shares(analysis.solution_of(name).context, name)
        ),
        origins=tuple(origins(analysis.solution, name)) if is_unbounded else (),
    )


def _schedule(analysis: Analysis, name: str) -> CoreSchedule | None:
    """The schedule that the response time of a process is from; None if it is from another method."""
    solution = analysis.solution_of(name)
    response = solution.responses.get(name)
    is_scheduled = response is not None and response.method == METHOD
    return solution.schedule(solution.context.scheduled[name].core, with_slices=True) if is_scheduled else None


def _worst_job(schedule: CoreSchedule, name: str) -> int:
    """The index of the job with the worst-case response time."""
    jobs = schedule.worst[name]
    return int((jobs.ends - jobs.releases).argmax())


def _loads(solution: Solution, scheduled: ScheduledProcess) -> list[Load]:
    """The loads at the rank of a process or higher, largest first; scheduler decisions interrupt all of them."""
    context = solution.context
    time_base, blocking = context.demand_model.time_base(scheduled.core), Blocking.of(context.on_core(scheduled.core), solution)
    found = []
    for item in context.served(scheduled.core, scheduled.server):
        if blocking.is_below(item, scheduled):
            continue
        if isinstance(item, Server):
            found.append(Load(name=item.name, priority=item.rank[-1], utilisation=Fraction(item.budget, item.period)))
        else:
            found.append(Load(name=item.name, priority=item.priority, utilisation=_utilisation(solution, item)))
    for other in context.on_core(scheduled.core) if scheduled.server is None else ():
        if other.name in context.decisions and other.name in solution.event_models:
            rate = context.decisions[other.name].mean_worst * solution.event_models[other.name].rate
            found.append(Load(name=f"scheduler decisions for {other.name}", priority=None, utilisation=rate / time_base))
    return sorted(found, key=lambda load: -(load.utilisation or 0))


def _utilisation(solution: Solution, item: ScheduledProcess) -> Fraction | None:
    if not solution.is_known(item.name):
        return None
    demand, events = solution.context.demands[item.name], solution.event_models[item.name]
    return demand.mean_worst * events.rate / solution.context.time_base(item.name)


def shares(analysis: Analysis, name: str) -> list[Share]:
    """The shares of all processes, largest first; empty if the method does not give them."""
    solution = analysis.solution_of(name)
    response, scheduled = solution.responses.get(name), solution.context.scheduled.get(name)
    if response is None or response.worst is None or scheduled is None or name in solution.context.system.executor_of_task:
        return []
    schedule = _schedule(analysis, name)
    found = _in_window(solution, scheduled, response) if schedule is None else _in_schedule(solution, name, schedule)
    return sorted(found, key=lambda share: -share.time)


def _in_schedule(solution: Solution, name: str, schedule: CoreSchedule) -> list[Share]:
    """The execution of other tasks between the release and the end of the worst job."""
    own, worst = schedule.worst[name], _worst_job(schedule, name)
    begin, end = own.releases[worst], own.ends[worst]
    time_base = solution.context.time_base(name)
    found = []
    for other, jobs in schedule.worst.items():
        slices = jobs.execution_slices
        inside = np.minimum(slices[:, 2], end) - np.maximum(slices[:, 1], begin)
        if other != name and (inside > 0).any():
            count = len(set(slices[inside > 0, 0].tolist()))
            found.append(Share(other, count, int(inside[inside > 0].sum()) // time_base))
    return found


def _in_window(solution: Solution, scheduled: ScheduledProcess, response: Response) -> list[Share]:
    """The demand of higher priorities in the busy window, if that is all of the interference."""
    context = solution.context
    time_base = context.time_base(scheduled.name)
    here = context.on_core(scheduled.core)
    blocking, found = Blocking.of(here, solution), []
    for other in here:
        if other.name == scheduled.name or blocking.is_below(other, scheduled):
            continue
        if other.server != scheduled.server or other.name not in solution.event_models:
            return []
        count = solution.event_models[other.name].eta_plus(response.window)
        found.append(Share(other.name, count, min_time(context.demands[other.name].max_demand(count), time_base)))
    # Apart from one picosecond of rounding each, the shares must add up.
    difference = sum(share.time for share in found) - response.terms.get("interference", 0)
    return found if abs(difference) <= len(found) + 1 else []


def explain_callback(analysis: Analysis, name: str) -> tuple[CallbackExplanation, ...]:
    """The explanation of a callback, for each process that calls it."""
    found = []
    for callback in analysis.callbacks:
        if callback.name == name:
            here = (executor for executor in analysis.executors if executor.task == callback.process)
            handles = tuple(handle for executor in here for handle in executor.handles if handle.runnable == name)
            execution = () if handles else _until(execution_shares(analysis.solution.context, callback.process), name)
            process = analysis.processes[callback.process]
            found.append(CallbackExplanation(callback=callback, process=process, execution=execution, handles=handles))
    return tuple(found)


def _until(shares: list[ExecutionShare], name: str) -> tuple[ExecutionShare, ...]:
    """The shares up to the one of a runnable; all of them if a job calls it inside another runnable."""
    index = next((number for number, share in enumerate(shares) if share.is_runnable and share.name == name), len(shares))
    return tuple(shares[: index + 1])


OWN, ACCESSES, OTHER = "own execution", "label accesses", "other activities"


OVERHEADS = "overheads and copies"


def execution_shares(context: TimingContext, name: str) -> list[ExecutionShare]:
    """The shares, in order of execution; their times add up to the worst-case execution time if that is known."""
    scheduled = context.scheduled.get(name)
    if scheduled is None:
        return []
    grouped: dict[tuple[str, bool, Counter | None], list[Activity]] = {}
    for activity in _flat(scheduled.process.activities):
        grouped.setdefault(_kind(activity), []).append(activity)
    found, executed = [], Ticks(0)
    time_base = context.time_base(name)
    for (kind, is_runnable, counter), activities in grouped.items():
        before = max_time(executed, time_base)
        time, reason = None, ""
        try:
            demand = context.execution_model(name).of_activities(scheduled.process, activities, scheduled.core)
            executed = Ticks(executed + demand.worst)
            time = max_time(executed, time_base) - before
        except UnknownError as error:
            reason = str(error)
        if time != 0:
            found.append(
                ExecutionShare(
                    name=kind, is_runnable=is_runnable, time=time, calls=len(activities), counter=counter, reason=reason
                )
            )
    whole = context.stated_demand(name) if name in context.waiting else context.demands.get(name)
    rest = 0 if whole is None else max_time(whole.worst, time_base) - max_time(executed, time_base)
    return [*found, ExecutionShare(name=OVERHEADS, is_runnable=False, time=rest)] if rest > 0 else found


def _flat(activities: Sequence[Activity]) -> Iterator[Activity]:
    """The activities of a process, with those of its groups instead of the groups."""
    for activity in activities:
        if isinstance(activity, Group):
            yield from _flat(activity.activities)
        else:
            yield activity


def _kind(activity: Activity) -> tuple[str, bool, Counter | None]:
    """What is shown as one row: the name of a runnable and its counter, or what else an activity is."""
    match activity:
        case Call(runnable=runnable, counter=counter):
            return runnable, True, counter
        case Execute() | ExecutionNeed():
            return OWN, False, None
        case LabelAccess():
            return ACCESSES, False, None
    return OTHER, False, None


_REMEDIES = {
    OriginKind.MAPPING: "Map it to a scheduler or interrupt controller that is responsible for one core with a known clock.",
    OriginKind.ACTIVATION: "Give it a stimulus with a period, or with a minimum time between two activations.",
    OriginKind.OVERLOAD: "Shorten execution times, lengthen periods, or move processes to another core.",
}


def origins(solution: Solution, name: str) -> list[Origin]:
    """The processes from which it comes that the response time of a process has no bound; nothing if it has one."""
    return list(_OriginSearch(solution, set()).of(name))


@dataclass(frozen=True, slots=True)
class _OriginSearch:
    """Follows the dependencies of processes without a bound; each is visited once."""

    solution: Solution
    visited: set[str]

    @property
    def context(self) -> TimingContext:
        return self.solution.context

    def of(self, name: str) -> Iterator[Origin]:
        response = self.solution.responses.get(name)
        if name in self.solution.migrating or name in self.visited or (response is not None and response.worst is not None):
            return
        self.visited.add(name)
        if response is not None:
            yield self._origin(name, OriginKind.OVERLOAD if response.is_overload else OriginKind.OTHER, response.reason)
            return
        reason = self.solution.reasons.get(name, "it was not analysed")
        scheduled = self.context.scheduled.get(name)
        if scheduled is None:
            yield self._origin(name, OriginKind.MAPPING, reason)
        elif name not in self.context.demands:
            yield self._origin(name, OriginKind.DEMAND, reason)
        else:
            others = self._triggering(scheduled) if name not in self.solution.event_models else self._preceding(scheduled)
            found = [origin for other in others for origin in self.of(other)]
            is_inactive = name not in self.solution.event_models
            yield from found or [self._origin(name, OriginKind.ACTIVATION if is_inactive else OriginKind.OTHER, reason)]

    def _triggering(self, scheduled: ScheduledProcess) -> Iterator[str]:
        """The processes that activate a process."""
        for stimulus in scheduled.process.stimuli:
            for position in self.context.dataflow.fired_at(stimulus):
                yield position.process.name

    def _preceding(self, scheduled: ScheduledProcess) -> Iterator[str]:
        """The processes of the same or a higher rank on its core, or of unknown rank, and those that can block it."""
        touching = self.context.touching
        yield from touching.intruders(scheduled.core)
        yield from touching.by_semaphores(scheduled.name)
        for other in self.context.on_core(scheduled.core):
            if other.name != scheduled.name and (other.rank >= scheduled.rank or not self.solution.is_analysable(other.name)):
                yield other.name

    def _origin(self, name: str, kind: OriginKind, reason: str) -> Origin:
        remedy = self._demand_remedy(name) if kind is OriginKind.DEMAND else _REMEDIES.get(kind, "")
        gap = self.context.scheduled[name].order_gap if name in self.context.scheduled else None
        if not remedy and gap is not None:
            remedy = f"State the {'priority' if gap.is_of_priority else 'deadline'} of each task of its scheduler."
        return Origin(process=name, kind=kind, reason=reason, remedy=remedy)

    def _demand_remedy(self, name: str) -> str:
        """What makes the execution time of a process known."""
        activities = list(walk(self.context.scheduled[name].process.activities))
        if any(isinstance(each, WaitEvent) for each in activities):
            return "Trigger a separate task instead of waiting for the event."
        unknown = [share.name for share in execution_shares(self.context, name) if share.time is None and share.is_runnable]
        if any(isinstance(each, Loop) for each in activities):
            return "State how often its loops iterate at most."
        what = " and ".join(map(repr, unknown)) or "it"
        return f"State the execution time of {what}."
