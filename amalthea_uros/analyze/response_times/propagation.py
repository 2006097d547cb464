"""Propagation of event models: the completions of a process are the activations of the processes that it triggers.

Compositional analysis (K. Richter 2005): the activations of a triggered process are derived from those of the triggering one and the
completions of the jobs in its busy window. This is repeated until nothing changes. Jitter can only increase, so that the least fixed
point is found if there is one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.analyze.response_times.constant_schedule import constant_responses
from amalthea_uros.analyze.response_times.core import responses_on
from amalthea_uros.analyze.response_times.known_best_cases import raised
from amalthea_uros.analyze.response_times.known_offsets import tightened
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.semantics.loops import sleep_of, why_dense, workload
from amalthea_uros.perf.activities import Trigger
from amalthea_uros.perf.software import Process
from amalthea_uros.timing.activation.activations import Output
from amalthea_uros.timing.basics.time_base import MAX_INPUT, max_time
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.event_models.models import Delayed, EventModel, OutputEventModel, PeriodicEvents
from amalthea_uros.timing.response import Response
from amalthea_uros.timing.scheduling.scheduled import ScheduledProcess
from amalthea_uros.units import Time

#: Maximum number of rounds, and of jobs of busy windows in all rounds; if jitter still increases then, it does not converge.
MAX_ROUNDS = 100
MAX_JOBS = 50_000


def solve(context: TimingContext) -> Solution:
    """All response times, computed until they no longer change activations."""
    solution = Solution(context, reasons=dict(context.reasons))
    diverging: set[str] = set()
    while True:
        changing = _iterate(solution, diverging)
        if not changing:
            for core in context.system.cores:
                solution.responses |= constant_responses(core, solution) or tightened(core, solution)
                solution.responses |= raised(core, solution)
            return solution
        # Without the diverging processes and those that depend on them, the others can converge.
        diverging |= changing
        for name in changing:
            solution.mark_unknown(
                name, "its response time and the jitter of the processes that it triggers increase each other without limit"
            )


def _iterate(solution: Solution, diverging: set[str]) -> set[str]:
    """Find response times that are consistent with the activations; returns the processes that do not converge."""
    responses: dict[str, Response] = {}
    on_cores: dict[str, _CoreRound] = {}
    work = 0
    for number in range(MAX_ROUNDS):
        previous, known_reasons = responses, len(solution.reasons)
        solution.event_models = _event_models(solution, diverging, previous)
        responses = {}
        for core in solution.context.system.cores:
            on_cores[core] = _round_on(core, solution, on_cores.get(core))
            responses |= on_cores[core].responses
        # What became unknown in this round makes unknown what it activates.
        if responses == previous and len(solution.reasons) == known_reasons:
            solution.responses = responses
            return set()
        work += sum(response.jobs for response in responses.values())
        if number and work > MAX_JOBS:
            break
    return {name for name, response in responses.items() if response != previous.get(name)}


@dataclass(frozen=True, slots=True)
class _CoreRound:
    """The response times on a core, and the activations that they follow from; None for those that are unknown."""

    activations: Sequence[EventModel | None]
    responses: Mapping[str, Response]


def _round_on(core: str, solution: Solution, previous: _CoreRound | None) -> _CoreRound:
    """The response times on a core; those of the previous round if its activations have not changed."""
    activations = [solution.event_models.get(scheduled.name) for scheduled in solution.context.on_core(core)]
    if previous is not None and activations == previous.activations:
        return previous
    return _CoreRound(activations, responses_on(core, solution))


def _event_models(solution: Solution, diverging: set[str], responses: Mapping[str, Response]) -> dict[str, EventModel]:
    """The activations of each process, given the previous response times."""
    context = solution.context
    output = _output(solution, responses)
    found: dict[str, EventModel] = {}
    for name, scheduled in context.scheduled.items():
        if name in diverging:
            continue
        try:
            _require_known_iterations(name, context)
            events = _workload(scheduled, context.activations.of(scheduled.process, output), context)
            if isinstance(events, PeriodicEvents) and events.jitter * context.time_base(name) > MAX_INPUT:
                raise UnknownError("its jitter exceeds the supported range of times")
            found[name] = events
        except UnknownError as error:
            context.notes.warning("ANA005", f"the activation pattern of {name!r} is unknown: {error}", scheduled.process)
            solution.mark_unknown(name, str(error))
    return found


def _workload(item: ScheduledProcess, events: EventModel, context: TimingContext) -> EventModel:
    """The activations of a process; of the rounds of an executor with a sleep, those of rounds that all are the longest."""
    executor, demand = context.system.executor_of_task.get(item.name), context.demands.get(item.name)
    if executor is None or demand is None:
        return events
    return workload(executor, events, max_time(demand.worst, context.time_base(item.name)))


def _require_known_iterations(name: str, context: TimingContext) -> None:
    """Refuse rounds of an executor that can be closer together than their stimulus says, if that matters to any other process."""
    executor, item = context.system.executor_of_task.get(name), context.scheduled[name]
    demand = context.demands.get(name)
    if executor is None or demand is None:
        return
    reason = why_dense(executor, context.system.executors, max_time(demand.worst, context.time_base(name)))
    delayed = (other for other in context.on_core(item.core) if other.rank <= item.rank and other.name != item.name)
    if reason and (any(delayed) or _triggers_others(item, context)):
        raise UnknownError(reason)


def _triggers_others(item: ScheduledProcess, context: TimingContext) -> bool:
    """Whether a process activates others."""
    try:
        positions = context.dataflow.events.positions(item.name)
    except UnknownError:
        return True
    return any(isinstance(position.activity, Trigger) for position in positions)


def _output(solution: Solution, responses: Mapping[str, Response]) -> Output:
    """The events caused by the jobs of processes."""
    context = solution.context

    def output(process: Process, activations: Callable[[], EventModel], has_fixed_place: bool) -> EventModel:
        if process.name in solution.reasons:
            raise UnknownError(f"it is triggered by {process.name!r}, which could not be analysed")
        events = activations()
        executor = context.system.executor_of_task.get(process.name)
        if executor is not None and sleep_of(executor).lower:
            # Between two rounds are the sleep and at least a whole round, from any point of the one to that of the other.
            return events
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
