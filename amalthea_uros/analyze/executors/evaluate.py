"""The results for all executors that spin in loops."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.executors.cycle import Cycle, UnknownCycleError
from amalthea_uros.analyze.executors.handles import SOURCE, handle_result
from amalthea_uros.analyze.executors.losses import slots_of_pool, stored_messages, with_lost_messages
from amalthea_uros.analyze.executors.results import ExecutorResult, HandleResult
from amalthea_uros.analyze.executors.window import METHOD
from amalthea_uros.analyze.results import Claim, Response
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.network import Span
from amalthea_uros.timing.executors.readiness import sharing
from amalthea_uros.units import Time


def evaluate_executors(
    solution: Solution, *, sending: Mapping[str, Span], extra_jitter: Mapping[str, Time | None]
) -> tuple[ExecutorResult, ...]:
    """The results for all executors of a system.

    Parameters
    ----------
    sending : times from the call of publish to its return, besides its execution, by the names of transmissions. Of a publication that
        is absent, or has no maximum, the time until it gives up counts
    extra_jitter : by which messages are late on their way, besides what is stated for them, by the names of handles; None if unknown.
        A message that a wire brings and that is absent has an unknown jitter
    """
    executors = solution.context.system.executors
    results = {each: _evaluated(each, solution, sending, extra_jitter) for each in executors}
    cycles = cycles_of(solution, sending)
    for executor in executors:
        together = sharing(executor, executors)
        stored = stored_messages({each: results[each].handles for each in together}, extra_jitter)
        needed = slots_of_pool(together, executors, stored)
        found, cycle = results[executor], cycles.get(executor)
        handles = found.handles if cycle is None else Results(with_lost_messages(found.handles, cycle, stored, needed))
        results[executor] = replace(found, handles=handles, slots_needed=needed)
    return tuple(results.values())


def cycles_of(solution: Solution, sending: Mapping[str, Span]) -> dict[Executor, Cycle]:
    """The rounds of the executors of which they are known."""
    found = {}
    for executor in solution.context.system.executors:
        try:
            found[executor] = Cycle.of(executor, solution, sending)
        except UnknownCycleError:
            continue
    return found


def _evaluated(
    executor: Executor, solution: Solution, sending: Mapping[str, Span], extra_jitter: Mapping[str, Time | None]
) -> ExecutorResult:
    try:
        cycle = Cycle.of(executor, solution, sending)
    except UnknownCycleError as error:
        return _unknown(executor, str(error))
    handles = [handle_result(handle, cycle, extra_jitter) for handle in executor.handles]
    return ExecutorResult(
        name=executor.name,
        task=executor.task,
        round=Span(least=cycle.costs.spin.best // cycle.time_base, most=cycle.busy),
        loop=Span(least=cycle.shortest, most=cycle.longest_with_wait),
        handles=Results(handles),
        reason="" if cycle.longest is not None else cycle.unbounded,
    )


def _unknown(executor: Executor, reason: str) -> ExecutorResult:
    return ExecutorResult(
        name=executor.name,
        task=executor.task,
        round=Span(),
        loop=Span(),
        handles=Results(
            HandleResult(
                name=handle.name,
                kind=handle.kind,
                runnable=handle.runnable,
                interval=handle.interval,
                response=Response(worst=None, best=0, method=METHOD, source=SOURCE, claim=Claim.BOUND, reason=reason),
            )
            for handle in executor.handles
        ),
        reason=reason,
    )
