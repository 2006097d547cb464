"""What the worst-case response times of processes and callbacks consist of: own execution, and interference."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from amalthea_uros.analyze.explanations.execution_shares import ExecutionShare, execution_shares
from amalthea_uros.analyze.explanations.origins import Origin, origins
from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.core import periodic_tasks
from amalthea_uros.analyze.response_times.core_schedule import CoreSchedules
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.processes import CallbackResult, ProcessResult
from amalthea_uros.executors.results import HandleResult
from amalthea_uros.judge.verdict import FAILURES, Verdict
from amalthea_uros.timing.basics.time_base import min_time
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.jobs.counters import takes_effect
from amalthea_uros.timing.response import Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess, Server
from amalthea_uros.units import Time


@dataclass(frozen=True, slots=True)
class Share:
    """The share of one process in the interference: number of jobs, and their time in picoseconds."""

    name: str
    jobs: int
    time: Time


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """The part of the core, or of the budget of a server, that something needs in the long run; None if it is unknown."""

    name: str
    priority: int | None
    utilisation: Fraction | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessExplanation:
    """What the response time of a process consists of.

    Attributes
    ----------
    execution : shares in its worst-case execution time
    shares : in the interference, largest first
    loads : if its deadline is not met, or it is unknown whether it is: of itself and of all that is served before it or in turn
        with it, largest first
    supply : the part of the core that is there for them: less than 1 in a server
    callbacks : that its jobs call, in order
    worst_job : number of the job with the worst-case response time; None if it is unknown
    in_worst_job : for each share of `execution`, whether that job executes it; empty if the job is unknown
    origins : if its response time has no bound: where that comes from
    """

    process: ProcessResult
    execution: tuple[ExecutionShare, ...]
    shares: tuple[Share, ...]
    loads: tuple[Load, ...] = ()
    supply: Fraction = Fraction(1)
    callbacks: tuple[CallbackResult, ...] = ()
    worst_job: int | None = None
    in_worst_job: tuple[bool, ...] = ()
    origins: tuple[Origin, ...] = ()

    @property
    def load(self) -> Fraction | None:
        """The sum of the loads; None if one is unknown."""
        known = [load.utilisation for load in self.loads if load.utilisation is not None]
        return sum(known, Fraction(0)) if len(known) == len(self.loads) else None


def explain_process(analysis: Analysis, name: str) -> ProcessExplanation:
    """Explain the response time of a process."""
    process, context = analysis.processes[name], analysis.solution.context
    scheduled = context.scheduled.get(name)
    is_unbounded = process.response is None or process.response.worst is None
    is_late = is_unbounded or process.verdict in (*FAILURES, Verdict.UNKNOWN)
    worst_job = _worst_job(analysis, name)
    server = context.servers.get(scheduled.server or "") if scheduled is not None else None
    return ProcessExplanation(
        process=process,
        execution=tuple(execution_shares(context, name)),
        shares=tuple(shares(analysis, name)),
        loads=tuple(_loads(analysis.solution, scheduled)) if is_late and scheduled is not None else (),
        supply=Fraction(server.budget, server.period) if server is not None else Fraction(1),
        callbacks=tuple(each for each in analysis.callbacks if each.process == name),
        worst_job=worst_job,
        in_worst_job=_executed_in(analysis, name, worst_job) if worst_job is not None else (),
        origins=tuple(origins(analysis.solution, name)) if is_unbounded else (),
    )


def _worst_job(analysis: Analysis, name: str) -> int | None:
    """The number of the job with the worst-case response time; None if the schedule is unknown."""
    solution = analysis.solution_of(name)
    response, scheduled = solution.responses.get(name), solution.context.scheduled.get(name)
    if response is None or scheduled is None or response.method != schedule.METHOD:
        return None
    found = CoreSchedules(solution).of(scheduled.core, with_slices=False)
    if found is None:
        return None
    jobs = found.worst[name]
    return int((jobs.ends - jobs.releases).argmax()) + 1


def _executed_in(analysis: Analysis, name: str, job: int) -> tuple[bool, ...]:
    """For each execution share, whether a job executes it, in the phase in which the response time is the worst."""
    shares = execution_shares(analysis.solution_of(name).context, name)
    return tuple(share.counter is None or takes_effect(share.counter, job) for share in shares)


def _loads(solution: Solution, scheduled: ScheduledProcess) -> list[Load]:
    """The loads at the rank of a process or higher, largest first; scheduler decisions interrupt all of them."""
    context = solution.context
    time_base = context.demand_model.time_base(scheduled.core)
    found = []
    for item in context.served(scheduled.core, scheduled.server):
        if item.rank < scheduled.rank:
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
    tasks = periodic_tasks(scheduled.core, solution) if response.method == schedule.METHOD else []
    found = _in_schedule(solution, scheduled, tasks) if tasks else _in_window(solution, scheduled, response)
    return sorted(found, key=lambda share: -share.time)


def _in_schedule(solution: Solution, scheduled: ScheduledProcess, tasks: Sequence[schedule.PeriodicTask]) -> list[Share]:
    """The execution of other tasks between the release and the end of the worst job."""
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
        found.append(Share(other.name, count, min_time(context.demands[other.name].max_demand(count), time_base)))
    return found if _adds_up(found, response) else []


def _adds_up(found: Sequence[Share], response: Response) -> bool:
    """Whether the shares add up to the interference, apart from one picosecond of rounding each."""
    return abs(sum(share.time for share in found) - response.terms.get("interference", 0)) <= len(found) + 1


@dataclass(frozen=True, slots=True, kw_only=True)
class CallbackExplanation:
    """What the response time of a callback consists of.

    Attributes
    ----------
    process : whose jobs call it
    execution : what these jobs execute up to the callback, in order, with the callback itself last
    handles : in an executor that spins in a loop, the handles that call it; their terms take the response time apart
    """

    callback: CallbackResult
    process: ProcessResult
    execution: tuple[ExecutionShare, ...]
    handles: tuple[HandleResult, ...] = ()


def explain_callback(analysis: Analysis, name: str) -> tuple[CallbackExplanation, ...]:
    """The explanation of a callback, for each process that calls it."""
    return tuple(
        CallbackExplanation(
            callback=callback,
            process=analysis.processes[callback.process],
            execution=() if handles else _until(execution_shares(analysis.solution.context, callback.process), name),
            handles=handles,
        )
        for callback in analysis.callbacks
        if callback.name == name
        for handles in [_handles(analysis, callback)]
    )


def _handles(analysis: Analysis, callback: CallbackResult) -> tuple[HandleResult, ...]:
    """The handles of an executor that spins in a loop that call a callback."""
    found = (executor for executor in analysis.executors if executor.task == callback.process)
    return tuple(handle for executor in found for handle in executor.handles if handle.runnable == callback.name)


def _until(shares: list[ExecutionShare], name: str) -> tuple[ExecutionShare, ...]:
    """The shares up to the one of a runnable; all of them if a job calls it inside another runnable."""
    index = next((number for number, share in enumerate(shares) if share.is_runnable and share.name == name), len(shares))
    return tuple(shares[: index + 1])
