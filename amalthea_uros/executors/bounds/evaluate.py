"""The results for all executors that spin in loops."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from amalthea_uros._internal.by_name import Results
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.bounds.cycle import Cycle
from amalthea_uros.executors.bounds.handles import SOURCE, handle_result
from amalthea_uros.executors.bounds.losses import slots_of_pool, stored_messages, with_lost_messages
from amalthea_uros.executors.bounds.solved_system import METHOD, SolvedSystem
from amalthea_uros.executors.results import ExecutorResult, HandleResult
from amalthea_uros.executors.semantics.readiness import sharing
from amalthea_uros.perf.executors import Executor
from amalthea_uros.perf.network import Span
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time


def evaluate_executors(
    solved: SolvedSystem, *, sending: Mapping[str, Span], extra_jitter: Mapping[str, Time | None]
) -> tuple[ExecutorResult, ...]:
    """The results for all executors of a system.

    Parameters
    ----------
    sending : times from the call of publish to its return, besides its execution, by the names of transmissions. Of a publication that
        is absent, or has no maximum, the time until it times out counts
    extra_jitter : by which messages are late on their way, besides what is stated for them, by the names of handles; None if unknown.
        A message that a wire brings and that is absent has an unknown jitter
    """
    executors = solved.context.system.executors
    cycles: dict[Executor, Cycle] = {}
    results: dict[Executor, ExecutorResult] = {}
    for executor in executors:
        try:
            cycles[executor] = cycle = Cycle.of(executor, solved, sending)
        except UnknownError as error:
            results[executor] = _unknown(executor, str(error))
        else:
            results[executor] = _bounded(cycle, extra_jitter)
    for executor in executors:
        together = sharing(executor, executors)
        stored = stored_messages({each: results[each].handles for each in together}, extra_jitter)
        needed = slots_of_pool(together, executors, stored)
        handles = results[executor].handles
        if executor in cycles:
            handles = Results(with_lost_messages(handles, cycles[executor], stored, needed))
        results[executor] = replace(results[executor], handles=handles, slots_needed=needed)
    return tuple(results.values())


def _bounded(cycle: Cycle, extra_jitter: Mapping[str, Time | None]) -> ExecutorResult:
    executor = cycle.executor
    return ExecutorResult(
        name=executor.name,
        task=executor.task,
        round=Span(least=cycle.demand.spin.lower // cycle.time_base, most=cycle.busy),
        loop=Span(least=cycle.shortest, most=cycle.longest_with_wait),
        handles=Results(handle_result(handle, cycle, extra_jitter) for handle in executor.handles),
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
