"""The time for which jobs wait for events, as it follows from the response times of the processes that set them.

Who waits for the job that it triggers waits at most for the response time of that, and who waits for a periodic process at most for
the longest time to its next activation and its response time.

The wait counts as execution of the job, for itself and for those of lower rank: suspension-oblivious analysis (J.-J. Chen, G. Nelissen,
W.-H. Huang and others, "Many suspensions, many problems: a review of self-suspending tasks in real-time systems", Real-Time Systems 55,
2019, section 4.2.1). In a busy window, at any time when nothing of its level executes, some job of it waits; so the window is at most
as long as if waiting were executing. That holds for fixed priorities with preemption. Elsewhere, what is not preempted could keep a
job off again after each wait, and a budget could be used up meanwhile: then the wait has no bound here.

A job that ends before the next one is activated can also be seen in segments: each part between its waits is a job of its own, which
begins when the wait ends. At that time nothing of it has been executed since interfering tasks became busy, so that it ends within
one window of that part; the waits take their time in between, and nothing that executes meanwhile adds to them (segmented
self-suspension, ibid., section 5). The shorter of the two bounds counts.

Who polls for an event delays everything without a higher rank on its core. If that sets the event, nobody ever does.

A job that its waiting process has triggered finds the one before it completed, if setting the event is the last thing that it does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.response_times.task import AnalysedTask
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.software import Task
from amalthea_uros.timing.basics.time_base import MAX_INPUT, to_ticks
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.multiframe import NOTHING, DemandFrame, MultiframeDemand
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, ScheduledProcess
from amalthea_uros.timing.waits import WITHOUT_BOUND, AwaitedEvent, WaitingProcess
from amalthea_uros.units import Rounding, Time, rounded_time_text

SOURCE = "Chen, Nelissen, Huang and others 2019"
SEGMENTS = "busy windows between waits, fixed priorities, preemptive"


def reasons_besides_waits(context: TimingContext) -> dict[str, str]:
    """Why processes are unknown, without those of which only the time for which they wait is not known yet."""
    return {name: reason for name, reason in context.reasons.items() if name not in context.waiting or reason != WITHOUT_BOUND}


def bound_waits(solution: Solution, responses: Mapping[str, Response]) -> None:
    """Put the demands of processes that wait into the timing context, given the response times of the previous step."""
    context = solution.context
    for name, waiting in context.waiting.items():
        context.demands.pop(name, None)
        if name in solution.reasons:
            continue
        try:
            _require_supported(context.scheduled[name], context)
            longest = sum(_longest(name, each, solution, responses) for each in waiting.awaited)
            if longest > MAX_INPUT:
                raise UnknownError("the time for which it waits exceeds the supported range of times")
        except UnknownError as error:
            solution.mark_unknown(name, str(error))
            continue
        wait = DemandFrame(worst=to_ticks(longest, context.time_base(name)), best=NOTHING, least=NOTHING)
        context.demands[name] = MultiframeDemand((*waiting.demand.frames, wait))


def warn_of_unknown_waits(solution: Solution) -> None:
    """Report the processes of which the time for which they wait has no bound."""
    context = solution.context
    for name in context.waiting:
        if name not in context.demands and name in solution.reasons:
            message = f"the execution demand of {name!r} is unknown: {solution.reasons[name]}"
            context.notes.warning("ANA004", message, context.scheduled[name].process)


def _require_supported(item: ScheduledProcess, context: TimingContext) -> None:
    """Refuse cores on which waiting could do more than executing."""
    here = context.served(item.core, item.server)
    processes = [other for other in here if isinstance(other, ScheduledProcess)]
    reason = ""
    if item.server is not None or len(processes) < len(here):
        reason = "its core is shared by servers with budgets"
    elif any(other.name in context.decisions for other in context.on_core(item.core)):
        reason = "its scheduler takes time for each decision"
    elif item.is_isr:
        reason = "it is an interrupt service routine"
    elif any(other.equal_priority not in (EqualPriority.FIFO, EqualPriority.UNKNOWN) for other in processes):
        reason = "its core is not scheduled by fixed priorities alone"
    elif any(other.name in context.system.executor_of_task for other in processes):
        reason = "an executor spins in a loop on its core"
    else:
        blocking = Blocking(processes, context.stretches, context.protection)
        blocker = next((other.name for other in processes if blocking.keeps_off_others(other)), None)
        if blocker is not None:
            reason = f"{blocker!r} on its core cannot be preempted everywhere"
    if reason:
        raise UnknownError(f"it waits for events, for which the analysis has no bound, because {reason}")


def _longest(name: str, awaited: AwaitedEvent, solution: Solution, responses: Mapping[str, Response]) -> Time:
    """The longest time for which a job waits for an event; without response times, a lower bound of that."""
    context, setter = solution.context, awaited.setter
    waits = f"it waits for {awaited.event!r}, which {setter!r} sets"
    if setter in solution.reasons:
        raise UnknownError(f"{waits}, and that could not be analysed")
    own, other = context.scheduled[name], context.scheduled[setter]
    if awaited.is_active and own.core == other.core and own.rank >= other.rank:
        raise UnknownError(
            f"{waits}: it polls for that on the same core, where {setter!r} cannot preempt it, and so never sets it"
        )
    response = responses.get(setter)
    if response is None:
        return awaited.gap or 0
    if response.worst is None:
        raise UnknownError(f"{waits}, and that has no bounded response time: {response.reason}")
    if _can_lose(name, awaited, solution, responses):
        longest = rounded_time_text(response.worst, Rounding.UP)
        raise UnknownError(f"{waits} after up to {longest}, so that activations may be lost")
    return response.worst + (awaited.gap or 0)


def _can_lose(name: str, awaited: AwaitedEvent, solution: Solution, responses: Mapping[str, Response]) -> bool:
    """Whether an activation of who sets an event can be lost.

    A process that others trigger finds at most the job pending that has already set the event. That has ended when the next job of
    who waits begins, if the bound of its response time, which contains the whole wait, is within the time between its activations.
    """
    process = solution.context.scheduled[awaited.setter].process
    limit = process.activation_limit if isinstance(process, Task) else 1
    if awaited.gap is None and limit > 1:
        return False
    pending = name if awaited.gap is None else awaited.setter
    response, events = responses.get(pending), solution.event_models.get(pending)
    if response is None or events is None:
        return False
    return response.worst is None or events.eta_plus(response.worst) > limit


def shorter_by_segments(response: Response, task: AnalysedTask, waiting: WaitingProcess, higher: Interference) -> Response:
    """The response time of a process that waits, by the windows of its segments if that bound is shorter.

    Parameters
    ----------
    response : the one with waiting as execution
    higher : all interfering tasks, of its rank and above, on a core where all are preempted at once
    """
    if higher.overloads_with(replace(task, demand=waiting.demand)):
        return response
    # What a job does at the end of a segment takes no time, but it may do so only when it has the core again.
    *until_waits, last = waiting.segments
    windows = [*(higher.window(segment + 1, 0) for segment in until_waits), higher.window(last, 0)]
    executing = -len(until_waits)
    for window in windows:
        if window is None:
            return response
        executing += window
    wait = task.demand.worst - waiting.demand.worst
    worst = executing + wait
    if worst > task.events.delta_min(2) or (response.worst is not None and response.worst <= worst):
        return response
    own = task.demand.worst
    return Response(
        worst=worst,
        best=response.best,
        method=SEGMENTS,
        source="Lehoczky 1990",
        claim=Claim.BOUND,
        window=worst,
        terms={"own": own, "interference": worst - own, "blocking": 0},
    )


def beside_waits(response: Response, task: AnalysedTask, waiting: WaitingProcess | None) -> Response:
    """A response time on a core with processes that wait: others can execute meanwhile, and no wait is certain to be as long."""
    reason = response.reason
    if response.is_overload:
        reason = f"{reason}, if each wait for an event takes as long as it can"
    terms = response.terms
    if waiting is not None and terms.get("own") == task.demand.worst:
        own = waiting.demand.worst
        terms = {**terms, "own": own, "waits for events": task.demand.worst - own}
    # Who waits is late with the rest of its job, so that later jobs do not end at their usual distances.
    return replace(
        response,
        best=task.demand.best,
        completions=(),
        terms=terms,
        source=f"{response.source}; waits: {SOURCE}",
        is_overload=False,
        reason=reason,
    )
