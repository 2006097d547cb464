"""The results of a system for all phases of what comes from outside: each phase is possible, so the worst one counts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, TypeVar

from amalthea_uros._internal.plural import counted
from amalthea_uros.analyze import metrics
from amalthea_uros.analyze.propagation import solve
from amalthea_uros.analyze.results import (
    Analysis,
    CallbackResult,
    ChainResult,
    Claim,
    ProcessResult,
    RequirementResult,
    Response,
    Results,
    Value,
)
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.analyze.summary import summarize
from amalthea_uros.analyze.verdicts import Verdict
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.phases import Occurrence, phase_count, phase_variants
from amalthea_uros.units import Time

#: With more combinations of phases, or more jobs in all of them, any job can be the one that takes what comes from outside.
MAX_COMBINATIONS = 1000
MAX_JOBS = 1_000_000

#: The verdict over all phases is the first of these that occurs.
_WORST_FIRST = (Verdict.MISSED, Verdict.UNBOUNDED, Verdict.UNKNOWN, Verdict.MET, None)

T = TypeVar("T")


def solutions_for_phases(solution: Solution, unknown: Sequence[Occurrence]) -> list[Solution]:
    """The solution for each combination of phases; none if there are too many."""
    count = phase_count(unknown)
    if count > MAX_COMBINATIONS:
        return []
    found: list[Solution] = []
    for variant in phase_variants(solution.context.system, unknown):
        found.append(solve(TimingContext.of(variant, solution.context.settings)))
        if count * sum(response.jobs for response in found[0].responses.values()) > MAX_JOBS:
            return []
    return found


def merged(analyses: Sequence[Analysis], solution: Solution) -> Analysis:
    """The analysis over all phases.

    Parameters
    ----------
    analyses : for each combination of phases
    solution : for unknown phases
    """
    first, *_ = analyses
    processes, worst = [], {}
    for each in zip(*(analysis.processes for analysis in analyses), strict=True):
        processes.append(_process(each))
        worst[each[0].name] = analyses[each.index(max(each, key=_badness))].solution
    requirements = Results(_requirements(analyses))
    return replace(
        first,
        solution=solution,
        worst_solutions=worst,
        processes=Results(processes),
        callbacks=Results(map(_callback, zip(*(analysis.callbacks for analysis in analyses), strict=True))),
        chains=Results(map(merged_chain, zip(*(analysis.chains for analysis in analyses), strict=True))),
        requirements=requirements,
        summary=summarize(first.processors, processes, requirements),
        assumptions=_each_once(analyses, lambda analysis: analysis.assumptions),
        findings=_each_once(analyses, lambda analysis: analysis.findings),
    )


def _each_once(analyses: Iterable[Analysis], of: Callable[[Analysis], Iterable[T]]) -> tuple[T, ...]:
    return tuple(dict.fromkeys(item for analysis in analyses for item in of(analysis)))


def _badness(result: ProcessResult | CallbackResult) -> tuple[int, int]:
    """Greater for a worse response time; unknown is worse than unbounded."""
    if result.response is None:
        return 2, 0
    return (1, 0) if result.response.worst is None else (0, result.response.worst)


def _process(results: Sequence[ProcessResult]) -> ProcessResult:
    worst = max(results, key=_badness)
    judged = min(results, key=lambda result: _WORST_FIRST.index(result.verdict))
    found = metrics.merged([result.metrics for result in results])
    worst = replace(worst, verdict=judged.verdict, failure=judged.failure, reason=judged.reason, metrics=found)
    responses = [result.response for result in results if result.response is not None]
    return worst if worst.response is None else replace(worst, response=_response(worst.response, responses))


def _callback(results: Sequence[CallbackResult]) -> CallbackResult:
    worst = max(results, key=_badness)
    worst = replace(worst, metrics=metrics.merged([result.metrics for result in results]))
    responses = [result.response for result in results if result.response is not None]
    return worst if worst.response is None else replace(worst, response=_response(worst.response, responses))


def _response(worst: Response, responses: Sequence[Response]) -> Response:
    is_exact = all(response.claim is Claim.EXACT for response in responses)
    return replace(
        worst,
        best=min(response.best for response in responses),
        claim=Claim.EXACT if is_exact else Claim.BOUND,
        method=f"{worst.method}, over all {counted(len(responses), 'phase')}",
    )


def merged_chain(results: Sequence[ChainResult]) -> ChainResult:
    """The values over all phases: the maximum, the minimum, and the mean of the means; none that is missing in some phase."""
    first, *_ = results
    bounded = next((result for result in results if any(value.claim is not Claim.EXACT for value in result.values)), first)
    return replace(
        first,
        values=_over_all([{value.quantity: value for value in result.values} for result in results]),
        all_values=_over_all([{(value.quantity, value.method): value for value in result.all_values} for result in results]),
        why=bounded.why,
        reason=next((result.reason for result in results if result.reason), ""),
    )


def _over_all(results: Sequence[Mapping[Any, Value]]) -> tuple[Value, ...]:
    """Values by what they have in common, over all phases."""
    common = [key for key in results[0] if all(key in result for result in results)]
    return tuple(_worst([result[key] for result in results]) for key in common)


def _worst(values: Sequence[Value]) -> Value:
    first, *_ = values
    quantity, times = first.quantity, [value.value for value in values]
    finite = [time for time in times if time is not None]
    if len(finite) < len(times):
        return values[times.index(None)]
    time = round(Fraction(sum(finite), len(finite))) if quantity.is_mean else (max if quantity.is_upper else min)(finite)
    worst = values[times.index(time)] if time in times else first
    is_exact = all(value.claim is Claim.EXACT for value in values)
    return replace(
        worst,
        value=time,
        claim=Claim.EXACT if is_exact else Claim.BOUND,
        method=f"{worst.method}, over all {counted(len(values), 'phase')}",
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
    worst = min(results, key=lambda result: _WORST_FIRST.index(result.verdict))
    extreme = max if worst.is_upper else min
    lower, upper = [result.lower for result in results], [result.upper for result in results]
    return replace(worst, lower=_extreme(lower, extreme), upper=_extreme(upper, extreme))


def _extreme(ends: Sequence[Time | None], extreme: Callable[[Sequence[Time]], Time]) -> Time | None:
    """The greatest or least of ends that are all known."""
    known = [end for end in ends if end is not None]
    return extreme(known) if len(known) == len(ends) else None
