"""Hosts, messages and executors in loops: most systems have none, and their analyses take long to import."""

from __future__ import annotations

from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.chains import ChainResult
from amalthea_uros.executors.results import ExecutorResult
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.relays import sends_to_controllers
from amalthea_uros.timing.basics.settings import Settings


def solved(system: System, settings: Settings) -> Solution:
    """The response times for unknown phases, with the messages of the host and of controllers as these send them."""
    solution = solve(timing_context(system, settings))
    if not solution.context.system.host.executors and not sends_to_controllers(solution.context.system):
        return solution
    from amalthea_uros.analyze.host.handover import with_messages_of_others

    return with_messages_of_others(system, solution)


def executors_and_messages(
    solution: Solution,
) -> tuple[Results[ExecutorResult], Results[ChainResult], Results[ExecutorResult]]:
    """The results of executors in loops, of the chains that cross them or wires, and of executors of the host."""
    if not solution.context.system.has_messages_or_loops:
        return Results(), Results(), Results()
    from amalthea_uros.analyze.chains.message_chains import evaluate_executors_and_messages
    from amalthea_uros.executors.bounds.findings import note_executors

    results = evaluate_executors_and_messages(solution)
    for client in solution.clients:
        note_executors([results[0][each.name] for each in client.context.system.executors], client)
    return results
