"""The results of a system for all phases of what comes from outside: each phase is possible, so the worst one counts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from operator import mul
from typing import Any, TypeVar

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.lazy_mapping import LazyMapping
from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze.chains.evaluator import ChainEvaluator
from amalthea_uros.analyze.phases.cases import MAX_JOBS, PhaseCases, work_of
from amalthea_uros.analyze.response_times import metrics
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.results.chains import ChainResult, LatencyValue
from amalthea_uros.analyze.results.processes import CallbackResult, ProcessResult, RequirementResult
from amalthea_uros.judge.evidence import Ends
from amalthea_uros.judge.limits import SystemLimit
from amalthea_uros.judge.verdict import WORST_FIRST, prove
from amalthea_uros.perf.events import EventChain
from amalthea_uros.timing.basics.quantities import jitter_of
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Time

#: The metrics of more phases are merged at once, because the schedules of all of them would be kept.
_MOST_KEPT = 100
#: Of all chains that are evaluated for their own phases, because those of the whole system are too many.
_MAX_WORK_OF_CHAINS = 3 * MAX_JOBS

T = TypeVar("T")
R = TypeVar("R", ProcessResult, CallbackResult)


def merged(analyses: Mapping[int, Analysis], cases: PhaseCases, solution: Solution) -> Analysis:
    """The analysis over all phases.

    Parameters
    ----------
    analyses : by the number of the combination of phases; at least one of each case
    solution : for unknown phases
    """
    first = analyses[0]
    worst: dict[str, Solution] = {}
    processes = []
    for name, of_process in cases.of_processes.items():
        results = {number: analyses[number].processes[name] for number in of_process}
        worst[name] = analyses[max(results, key=lambda number: _badness(results[number]))].solution
        processes.append(_process(list(results.values()), list(of_process.values())))
    callbacks = []
    for index, callback in enumerate(first.callbacks):
        of_process = cases.of_processes[callback.process]
        callbacks.append(_job_results([analyses[number].callbacks[index] for number in of_process], list(of_process.values())))
    chains = []
    for index, of_chain in enumerate(cases.of_chains):
        chains.append(_merged_chain([analyses[number].chains[index] for number in of_chain], list(of_chain.values())))
    return replace(
        first,
        solution=solution,
        worst_solutions=worst,
        processes=Results(processes),
        callbacks=Results(callbacks),
        chains=Results(chains),
        requirements=Results(_requirements(list(analyses.values()))),
        assumptions=_each_once(analyses.values(), lambda analysis: analysis.assumptions),
        findings=_each_once(analyses.values(), lambda analysis: analysis.findings),
        work=sum(analysis.work for analysis in analyses.values()),
    )


def _each_once(analyses: Iterable[Analysis], of: Callable[[Analysis], Iterable[T]]) -> tuple[T, ...]:
    return tuple(dict.fromkeys(item for analysis in analyses for item in of(analysis)))


def _badness(result: ProcessResult | CallbackResult) -> tuple[int, int]:
    """Greater for a worse response time; unknown is worse than unbounded."""
    if result.response is None:
        return 2, 0
    return (1, 0) if result.response.worst is None else (0, result.response.worst)


def _process(results: Sequence[ProcessResult], counts: Sequence[int]) -> ProcessResult:
    judged = min(results, key=lambda result: WORST_FIRST.index(result.verdict))
    return replace(_job_results(results, counts), verdict=judged.verdict, failure=judged.failure, reason=judged.reason)


def _job_results(results: Sequence[R], counts: Sequence[int]) -> R:
    """The result with the worst response time, and the metrics of all phases."""
    worst = max(results, key=_badness)
    of_all_phases = LazyMapping(lambda: metrics.merged([result.metrics for result in results], counts))
    if len(results) > _MOST_KEPT:
        len(of_all_phases)
    worst = replace(worst, metrics=of_all_phases)
    return worst if worst.response is None else replace(worst, response=_response(worst.response, results, counts))


def _response(worst: Response, results: Sequence[ProcessResult | CallbackResult], counts: Sequence[int]) -> Response:
    # The worst one is known, and with it all others.
    responses = [result.response for result in results if result.response is not None]
    is_exact = all(response.claim is Claim.EXACT for response in responses)
    return replace(
        worst,
        best=min(response.best for response in responses),
        claim=Claim.EXACT if is_exact else Claim.BOUND,
        method=_over_all(worst.method, counts),
    )


def _over_all(method: str, counts: Sequence[int]) -> str:
    return f"{method}, over all {counted(sum(counts), 'phase')}"


def over_all_phases(chain: EventChain, evaluation: ChainEvaluator) -> ChainResult:
    """The result of a chain, over all unknown phases of the jobs that it passes if these are not too many."""
    cases = PhaseCases.of(evaluation.solution, evaluation.occurrences(chain))
    if cases is None:
        return evaluation.chain(chain)
    of_chain, budget = cases.of_chain(chain), evaluation.budget
    work = len(of_chain) * work_of(cases.first, chains=1)
    if work > min(MAX_JOBS, _MAX_WORK_OF_CHAINS - budget.work):
        return evaluation.chain(chain)
    budget.work += work
    results = []
    for _, solution in cases.solutions(of_chain):
        results.append(ChainEvaluator(solution, budget).chain(chain))
        evaluation.context.notes.include(solution.context.notes)
    return _merged_chain(results, list(of_chain.values()))


def _merged_chain(results: Sequence[ChainResult], counts: Sequence[int]) -> ChainResult:
    """The values over all phases: the maximum, the minimum, and the mean of the means; none that is missing in some phase.

    Parameters
    ----------
    counts : how many phases each of the results stands for
    """
    first, *_ = results
    bounded = next((result for result in results if any(value.claim is not Claim.EXACT for value in result.values)), first)
    return replace(
        first,
        values=_values([{value.quantity: value for value in result.values} for result in results], counts),
        all_values=_values(
            [{(value.quantity, value.method): value for value in result.all_values} for result in results], counts
        ),
        why=bounded.why,
        reason=next((result.reason for result in results if result.reason), ""),
    )


def _values(results: Sequence[Mapping[Any, LatencyValue]], counts: Sequence[int]) -> tuple[LatencyValue, ...]:
    """Values by what they have in common, over all phases."""
    common = [key for key in results[0] if all(key in result for result in results)]
    return tuple(_worst([result[key] for result in results], counts) for key in common)


def _worst(values: Sequence[LatencyValue], counts: Sequence[int]) -> LatencyValue:
    first, *_ = values
    quantity, times = first.quantity, [value.value for value in values]
    finite = [time for time in times if time is not None]
    if len(finite) < len(times):
        return values[times.index(None)]
    mean = round(Fraction(sum(map(mul, finite, counts)), sum(counts)))
    time = mean if quantity.is_mean else (max if quantity.is_upper else min)(finite)
    worst = values[times.index(time)] if time in times else first
    is_exact = all(value.claim is Claim.EXACT for value in values)
    return replace(
        worst,
        value=time,
        claim=Claim.EXACT if is_exact else Claim.BOUND,
        method=_over_all(worst.method, counts),
    )


def _requirements(analyses: Sequence[Analysis]) -> Iterator[RequirementResult]:
    """The worst verdict on each limit, and the ends over all phases."""
    found: dict[tuple[Any, ...], list[RequirementResult]] = {}
    for analysis in analyses:
        count: Counter[tuple[Any, ...]] = Counter()
        for result in analysis.requirements:
            key = (result.name, result.object, result.quantity, result.is_upper)
            count[key] += 1
            # Several limits can look alike; a limit that is unknown in one phase can be missing in another.
            found.setdefault((*key, count[key]), []).append(result)
    yield from map(_requirement, found.values())


def _requirement(results: Sequence[RequirementResult]) -> RequirementResult:
    worst = min(results, key=lambda result: WORST_FIRST.index(result.verdict))
    extreme = max if worst.is_upper else min
    lower, upper = [result.lower for result in results], [result.upper for result in results]
    found = replace(worst, lower=_extreme(lower, extreme), upper=_extreme(upper, extreme))
    spreads = [result.spread for result in results]
    if found.stated is None or None in spreads or found.limit is None:
        return found
    return _jitter(found, found.stated, list(filter(None, spreads)))


def _jitter(found: RequirementResult, limit: SystemLimit, spreads: Sequence[tuple[Time, Time]]) -> RequirementResult:
    """A jitter from the least minimum to the greatest maximum of all phases: nobody states that a phase never drifts."""
    spread = min(low for low, _ in spreads), max(high for _, high in spreads)
    return RequirementResult.of(limit, replace(prove(limit, Ends(found.lower, jitter_of(*spread))), spread=spread))


def _extreme(ends: Sequence[Time | None], extreme: Callable[[Sequence[Time]], Time]) -> Time | None:
    """The greatest or least of ends that are all known."""
    known = [end for end in ends if end is not None]
    return extreme(known) if len(known) == len(ends) else None
