"""Activations that spread through a system: a process that another one triggers is activated as irregularly as that one ends.

Compositional analysis (K. Richter 2005): the activations of the triggered process are derived from those of the triggering one and the
completions of the jobs in its busy window. This is repeated until nothing changes; irregularity only grows, so that the least fixed
point is found, or there is none.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from amalthea_uros.analyze.response_times.core import responses_on
from amalthea_uros.analyze.results import Response
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.software import Process
from amalthea_uros.timing.activation import Output, UnknownActivationError
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.event_models import Delayed, EventModel, OutputEventModel, Periodic
from amalthea_uros.timing.limits import MAX_INPUT
from amalthea_uros.units import Time

#: Rounds of propagation, and jobs of busy windows in all of them; irregularity that still grows then will not stop.
MAX_ROUNDS = 100
MAX_JOBS = 50_000


def solve(context: TimingContext) -> Solution:
    """All response times, computed as often as they change the activations of others."""
    solution = Solution(context, reasons=dict(context.reasons))
    unsettled: set[str] = set()
    while True:
        growing = _settle(solution, unsettled)
        if not growing:
            return solution
        # Without those that do not settle, and what follows from them, the others may.
        unsettled |= growing
        for name in growing:
            solution.mark_unknown(
                name, "its response time and the arrivals of what it triggers make each other grow without an end"
            )


def _settle(solution: Solution, unsettled: set[str]) -> set[str]:
    """Find response times that fit the activations; gives the processes for which there are none."""
    responses: dict[str, Response] = {}
    work = 0
    for number in range(MAX_ROUNDS):
        before = responses
        solution.event_models = _event_models(solution, unsettled, before)
        responses = {}
        for core in solution.context.system.cores:
            responses |= responses_on(core, solution)
        if responses == before:
            solution.responses = responses
            return set()
        work += sum(response.jobs for response in responses.values())
        if number and work > MAX_JOBS:
            break
    return {name for name, response in responses.items() if response != before.get(name)}


def _event_models(solution: Solution, unsettled: set[str], responses: Mapping[str, Response]) -> dict[str, EventModel]:
    """The activations of each process, given the response times so far."""
    context = solution.context
    output = _output(solution, responses)
    found: dict[str, EventModel] = {}
    for name, scheduled in context.scheduled.items():
        if name in unsettled:
            continue
        try:
            events = context.activations.of(scheduled.process, output)
            if isinstance(events, Periodic) and events.jitter * context.time_base(name) > MAX_INPUT:
                raise UnknownActivationError("its jitter is longer than can be counted")
            found[name] = events
        except UnknownActivationError as error:
            context.notes.warning("ANA005", f"the arrivals of {name!r} are not known: {error}", scheduled.process)
            solution.mark_unknown(name, str(error))
    return found


def _output(solution: Solution, responses: Mapping[str, Response]) -> Output:
    """The events that processes cause by their jobs."""

    def output(process: Process, activations: Callable[[], EventModel]) -> EventModel:
        if process.name in solution.reasons:
            raise UnknownActivationError(f"too little is known of {process.name!r}, which triggers it")
        events = activations()
        response = responses.get(process.name)
        if response is None:
            return events
        if response.worst is None:
            raise UnknownActivationError(f"{process.name!r}, which triggers it, has no bounded response time")
        return completions(events, response, solution.bcet(process.name))

    return output


def completions(events: EventModel, response: Response, bcet: Time) -> EventModel:
    """The completions of the jobs of a task; each of them takes its best-case execution time at least."""
    if response.completions:
        return OutputEventModel(events, response.completions, bcet)
    return Delayed(events, (response.worst or 0) - bcet)
