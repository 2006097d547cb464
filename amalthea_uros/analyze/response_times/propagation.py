"""Propagation of event models: the completions of a process are the activations of the processes that it triggers.

Compositional analysis (K. Richter 2005): the activations of a triggered process are derived from those of the triggering one and the
completions of the jobs in its busy window. This is repeated until nothing changes. Jitter can only increase, so that the least fixed
point is found if there is one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.response_times.core import responses_on
from amalthea_uros.analyze.response_times.known_best_cases import raised
from amalthea_uros.analyze.response_times.known_offsets import tightened
from amalthea_uros.analyze.response_times.non_preemptive_schedule import scheduled_responses
from amalthea_uros.analyze.response_times.several_cores import responses_on_several_cores
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.response_times.waits import bound_waits, reasons_besides_waits, warn_of_unknown_waits
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.results import ExecutorOccurrences, merged_occurrences
from amalthea_uros.executors.semantics.loops import sleep_of, why_deferred, why_dense, workload
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.software import Process
from amalthea_uros.timing.activation.activations import Output
from amalthea_uros.timing.basics.time_base import MAX_INPUT, max_time
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.derived import Delayed, OutputEventModel, aggregated
from amalthea_uros.timing.event_models.models import EventModel, PeriodicEvents
from amalthea_uros.timing.response import Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess
from amalthea_uros.units import Time

#: Maximum number of steps, and of jobs of busy windows in all steps; if jitter still increases then, it does not converge.
MAX_ROUNDS = 100
MAX_JOBS = 50_000


def solve(context: TimingContext) -> Solution:
    """All response times, computed until they no longer change activations."""
    migrating = responses_on_several_cores(context)
    unbounded = {name: each.response.reason for name, each in migrating.items() if each.response.worst is None}
    bounded = {name: each for name, each in migrating.items() if name not in unbounded}
    solution = Solution(context, reasons={**reasons_besides_waits(context), **unbounded}, migrating=bounded)
    diverging: set[str] = set()
    while True:
        changing = _iterate(solution, diverging)
        if not changing:
            for core in context.system.cores:
                if solution.is_exact(core):
                    continue
                solution.responses |= scheduled_responses(core, solution) or tightened(core, solution)
                solution.responses |= raised(core, solution)
            warn_of_unknown_waits(solution)
            return solution
        # Without the diverging processes and those that depend on them, the others can converge.
        diverging |= changing
        for name in changing:
            solution.mark_unknown(
                name,
                "its response time and the time for which it waits increase each other without limit"
                if name in context.waiting
                else "its response time and the jitter of the processes that it triggers increase each other without limit",
            )


def _iterate(solution: Solution, diverging: set[str]) -> set[str]:
    """Find response times that are consistent with the activations; returns the processes that do not converge."""
    responses: dict[str, Response] = {}
    on_cores: dict[str, _CoreRound] = {}
    work = 0
    for number in range(MAX_ROUNDS):
        previous, known_reasons, activations = responses, len(solution.reasons), solution.event_models
        executors = _executor_occurrences(solution, previous if number else None)
        bound_waits(solution, previous)
        solution.sent_again = {name: each for name, each in executors.again.items() if not isinstance(each, str)}
        solution.event_models = _event_models(solution, diverging, previous, executors)
        responses = {}
        for core in solution.context.system.cores:
            on_cores[core] = _round_on(core, solution, on_cores.get(core))
            responses |= on_cores[core].responses
        # What became unknown in this step makes unknown what it activates.
        is_stable = not solution.context.system.executors or solution.event_models == activations
        if responses == previous and is_stable and len(solution.reasons) == known_reasons:
            solution.responses = responses
            return set()
        work += sum(response.jobs for response in responses.values())
        if number and work > MAX_JOBS:
            break
    changing = {name for name, response in responses.items() if response != previous.get(name)}
    return changing | {name for name, events in solution.event_models.items() if events != activations.get(name)}


def _executor_occurrences(solution: Solution, responses: Mapping[str, Response] | None) -> ExecutorOccurrences:
    """When executors send, and how late they are, as it follows from the previous step; the least for the first one."""
    if not solution.context.system.executors:
        return ExecutorOccurrences()
    from amalthea_uros.executors.bounds.occurrences import least_occurrences, occurrences

    if responses is None:
        return merged_occurrences(least_occurrences(client.context) for client in solution.clients)
    # What is derived from a solution is kept in it, so that each step needs its own.
    solution = replace(solution, responses=dict(responses), schedules={}, _threads={})
    return merged_occurrences(map(occurrences, solution.clients))


@dataclass(frozen=True, slots=True)
class _CoreRound:
    """The response times on a core, and the activations and demands that they follow from; None for those that are unknown."""

    activations: Sequence[tuple[EventModel | None, MultiframeDemand | None]]
    responses: Mapping[str, Response]


def _round_on(core: str, solution: Solution, previous: _CoreRound | None) -> _CoreRound:
    """The response times on a core; those of the previous step if its activations have not changed."""
    names = [scheduled.name for scheduled in solution.context.on_core(core)]
    activations = [(solution.event_models.get(name), solution.context.demands.get(name)) for name in names]
    if previous is not None and activations == previous.activations:
        return previous
    responses = responses_on(core, solution)
    solution.jobs += sum(response.jobs for response in responses.values())
    return _CoreRound(activations, responses)


def _event_models(
    solution: Solution, diverging: set[str], responses: Mapping[str, Response], executors: ExecutorOccurrences
) -> dict[str, EventModel]:
    """The activations of each process, given the previous response times."""
    context = solution.context
    output = _output(solution, responses, executors)
    found: dict[str, EventModel] = {}
    for name, scheduled in context.scheduled.items():
        if name in diverging:
            continue
        try:
            events = _with_sent_again(name, _activations(scheduled, output, executors, context), executors)
            if isinstance(events, PeriodicEvents) and events.jitter * context.time_base(name) > MAX_INPUT:
                raise UnknownError("its jitter exceeds the supported range of times")
            found[name] = events
        except UnknownError as error:
            context.notes.warning("ANA005", f"the activation pattern of {name!r} is unknown: {error}", scheduled.process)
            solution.mark_unknown(name, str(error))
    return found


def _activations(item: ScheduledProcess, output: Output, executors: ExecutorOccurrences, context: TimingContext) -> EventModel:
    """The activations of a process; of messages of executors, and of their iterations, as `executors.bounds` has them."""
    if item.name in executors.sent:
        sent = executors.sent[item.name]
        if sent is None:
            raise UnknownError("how late the executor that sends it is has no bound")
        return sent
    events, executor = context.activations.of(item.process, output), activated_with(item.name, context)
    demand = None if executor is None else context.demands.get(executor.task)
    if executor is None or demand is None:
        return events
    longest = max_time(demand.worst, context.time_base(executor.task))
    if _has_effects(item, executors, context):
        late, deferred = executors.lateness[executor.task], why_deferred(executor)
        can_overrun = executor.task in executors.overrunning
        reason = why_dense(executor, context.system.executors, can_overrun=can_overrun) or (deferred if late is None else "")
        if reason:
            raise UnknownError(reason)
        if deferred and late:
            return Delayed(events, late)
    return workload(executor, events, longest) if item.name == executor.task else events


def _with_sent_again(name: str, events: EventModel, executors: ExecutorOccurrences) -> EventModel:
    """The activations of a process, with those of a message that is sent again because some are lost."""
    if name not in executors.again:
        return events
    again = executors.again[name]
    if isinstance(again, str):
        raise UnknownError(again)
    return aggregated((events, again))


def activated_with(name: str, context: TimingContext) -> Executor | None:
    """The executor whose iterations a process executes, or activates as an interrupt of the operating system, with the same stimuli."""
    system = context.system
    own = system.executor_of_task.get(name)
    if own is not None:
        return own
    stimuli = system.processes[name].stimuli
    return next((each for each in system.executors if stimuli and system.processes[each.task].stimuli == stimuli), None)


def _has_effects(item: ScheduledProcess, executors: ExecutorOccurrences, context: TimingContext) -> bool:
    """Whether it matters to other processes when iterations of an executor execute, besides those messages that are known."""
    own_thread = context.system.tasks_of_thread(item.name)
    if any(other.rank <= item.rank and other.name not in own_thread for other in context.on_core(item.core)):
        return True
    try:
        positions = context.dataflow.events.positions(item.name)
    except UnknownError:
        return True
    triggered = (position.activity.stimulus for position in positions if isinstance(position.activity, Trigger))
    return any(name not in executors.sent for stimulus in triggered for name in context.activations.activated(stimulus))


def _output(solution: Solution, responses: Mapping[str, Response], executors: ExecutorOccurrences) -> Output:
    """The events caused by the jobs of processes."""
    context = solution.context

    def output(process: Process, activations: Callable[[], EventModel], has_fixed_place: bool) -> EventModel:
        if process.name in solution.reasons:
            raise UnknownError(f"it is triggered by {process.name!r}, which could not be analysed")
        events = _with_sent_again(process.name, activations(), executors)
        executor = context.system.executor_of_task.get(process.name)
        if executor is not None and sleep_of(executor).lower:
            # Between two rounds are the sleep and at least a whole round, from any point of the one to that of the other.
            return events
        if executor is not None and why_deferred(executor):
            late = executors.lateness[process.name]
            if late is None:
                raise UnknownError(f"it is triggered by {process.name!r}, which has no bounded response time")
            return Delayed(events, late)
        response = responses.get(process.name)
        if response is None:
            return events
        if response.worst is None:
            raise UnknownError(f"it is triggered by {process.name!r}, which has no bounded response time")
        # An event that a part of the job can follow or precede can occur at any time from its start to its end.
        return completions(events, response, solution.bcet(process.name) if has_fixed_place else 0)

    return output


def completions(events: EventModel, response: Response, bcet: Time) -> EventModel:
    """The completions of the jobs of a task; each job takes at least its best-case execution time."""
    if response.completions:
        return OutputEventModel(events, response.completions, bcet)
    return Delayed(events, (response.worst or 0) - bcet)
