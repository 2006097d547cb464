"""The results of a system for all phases of what comes from outside: each phase is possible, so the worst one counts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, TypeVar

from amalthea_uros.analyze.results import (
    Analysis,
    ChainResult,
    Claim,
    ProcessResult,
    RequirementResult,
    Response,
    Results,
    Value,
    Verdict,
)
from amalthea_uros.analyze.solution import Solution

#: With more combinations of phases, or more jobs in all of them, any job can be the one that takes what comes from outside.
MAX_COMBINATIONS = 1000
MAX_JOBS = 1_000_000

#: The verdict over all phases is the first of these that occurs.
_WORST_FIRST = (Verdict.MISSED, Verdict.UNBOUNDED, Verdict.UNKNOWN, Verdict.MET)

T = TypeVar("T")


def is_too_much(solution: Solution, count: int) -> bool:
    """Whether solving as many phases as that, each like this one, takes too long."""
    return count * sum(response.jobs for response in solution.responses.values()) > MAX_JOBS


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
    return replace(
        first,
        solution=solution,
        worst_solutions=worst,
        processes=Results(processes),
        chains=Results(map(merged_chain, zip(*(analysis.chains for analysis in analyses), strict=True))),
        requirements=Results(_requirements(analyses)),
        assumptions=_each_once(analyses, lambda analysis: analysis.assumptions),
        findings=_each_once(analyses, lambda analysis: analysis.findings),
    )


def _each_once(analyses: Iterable[Analysis], of: Callable[[Analysis], Iterable[T]]) -> tuple[T, ...]:
    return tuple(dict.fromkeys(item for analysis in analyses for item in of(analysis)))


def _badness(result: ProcessResult) -> tuple[int, int]:
    """Greater for a worse response time; unknown is worse than unbounded."""
    if result.response is None:
        return 2, 0
    return (1, 0) if result.response.worst is None else (0, result.response.worst)


def _process(results: Sequence[ProcessResult]) -> ProcessResult:
    worst = max(results, key=_badness)
    responses = [result.response for result in results if result.response is not None]
    verdict = min((result.verdict for result in results), key=_WORST_FIRST.index)
    if worst.response is None:
        return replace(worst, verdict=verdict)
    return replace(worst, response=_response(worst.response, responses), verdict=verdict)


def _response(worst: Response, responses: Sequence[Response]) -> Response:
    is_exact = all(response.claim is Claim.EXACT for response in responses)
    return replace(
        worst,
        best=min(response.best for response in responses),
        claim=Claim.EXACT if is_exact else Claim.BOUND,
        method=f"{worst.method}, over all {len(responses)} phases",
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
        method=f"{worst.method}, over all {len(values)} phases",
    )


def _requirements(analyses: Sequence[Analysis]) -> Iterator[RequirementResult]:
    """The worst verdict on each limit; a limit that is unknown in one phase is also shown as unknown."""
    found: dict[tuple[str, str, str, bool], list[RequirementResult]] = {}
    for analysis in analyses:
        for result in analysis.requirements:
            found.setdefault((result.name, result.object, result.quantity, result.is_upper), []).append(result)
    for results in found.values():
        yield min(results, key=_rank)


def _rank(result: RequirementResult) -> tuple[int, int]:
    """Less for a worse verdict and value."""
    value = result.value or 0
    return _WORST_FIRST.index(result.verdict), -value if result.is_upper else value
