"""What follows from the designs that were judged."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from amalthea_uros.design.optimize.front import pareto_front
from amalthea_uros.design.optimize.problem import Conclusion, Evaluation, Feasibility, SearchResult
from amalthea_uros.design.optimize.ranking import ranked


def concluded(evaluations: Iterable[Evaluation], proof: str, ended: str = "", excluded: int = 0) -> SearchResult:
    """The result of a search.

    Parameters
    ----------
    proof : why no other design that is proved to meet all limits is better, or why all miss one; "" if that is not proved
    ended : why the search ended early
    excluded : number of designs that the proof excludes, beside those that lower bounds exclude
    """
    every = list(evaluations)
    judged = [each for each in every if not each.broken_rule and not each.is_excluded]
    feasible = ranked(each for each in judged if each.feasible is Feasibility.YES)
    undecided = sum(each.feasible is Feasibility.UNKNOWN for each in judged)
    is_proved = bool(proof) and not ended and (bool(feasible) or not undecided)
    found = Conclusion.OPTIMAL if is_proved else Conclusion.BEST_FOUND
    missing = Conclusion.NONE if is_proved else Conclusion.NOT_FOUND
    return SearchResult(
        best=tuple(feasible),
        front=pareto_front(feasible),
        conclusion=found if feasible else missing,
        tried=len(judged),
        excluded=(excluded if is_proved else 0) + sum(each.is_excluded for each in every),
        broken=dict(Counter(each.broken_rule for each in every if each.broken_rule)),
        undecided=undecided,
        proof=proof if is_proved else "",
        ended=ended,
    )
