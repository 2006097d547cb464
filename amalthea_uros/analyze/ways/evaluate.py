"""Evaluates all executors that loop, and all chains that cross them, wires or the agent."""

from __future__ import annotations

from amalthea_uros._internal.by_name import Results
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.ways.callbacks import CallbackHops
from amalthea_uros.analyze.ways.passages import PassageHops
from amalthea_uros.analyze.ways.results import Way
from amalthea_uros.analyze.ways.walk import Walk
from amalthea_uros.executors.bounds.evaluate import evaluate_executors
from amalthea_uros.executors.bounds.publications import sending_times
from amalthea_uros.executors.bounds.transmissions import arrival_jitter
from amalthea_uros.executors.results import ExecutorResult
from amalthea_uros.perf.constraints import LatencyConstraint
from amalthea_uros.timing.dataflow.routes import crosses


def evaluate_ways(solution: Solution) -> tuple[Results[ExecutorResult], Results[Way]]:
    """The results of all executors that loop, and the ways of all chains that cross them, wires or the agent; those with limits first.

    Parameters
    ----------
    solution : for unknown phases, in which any job can take what comes from outside
    """
    jitter, sending = arrival_jitter(solution), sending_times(solution)
    executors = Results(evaluate_executors(solution, sending=sending, extra_jitter=jitter))
    walk = Walk(PassageHops(ChainEvaluator(solution)), CallbackHops(executors, jitter), sending)
    system = solution.context.system
    limited = {each.chain for each in system.constraints.constraints if isinstance(each, LatencyConstraint)}
    chains = sorted(
        (chain for chain in system.events.chains if crosses(chain, solution.context.dataflow)),
        key=lambda chain: chain.name not in limited,
    )
    ways = Results(walk.way(chain) for chain in chains)
    for way in ways:
        _note(way, solution)
    return executors, ways


def _note(way: Way, solution: Solution) -> None:
    """Report a way without a bound, and its assumptions."""
    notes, chain = solution.context.notes, solution.context.system.chains[way.name]
    for sentence in way.assumptions:
        notes.assume(sentence)
    reason = way.reason or way.loss
    if reason:
        advice = f" {way.remedy}" if way.remedy else ""
        notes.warning("CHN009", f"the latency of {way.name!r} has no bound: {reason}.{advice}", chain)
