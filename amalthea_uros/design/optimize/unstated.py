"""Designs that no description states: they are no part of what may be proposed."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.design.optimize.judged import pareto_front
from amalthea_uros.design.optimize.problem import Conclusion, DesignEvaluation, Evaluator, Feasibility, SearchResult
from amalthea_uros.design.optimize.space import Candidate

#: The rule that such designs break.
UNSTATED = "the description cannot state it"


@dataclass(frozen=True, slots=True)
class StatedOnly:
    """An evaluator for which some designs are not allowed; each other one is judged once, whatever number of searches ask for it."""

    evaluate: Evaluator
    unstated: frozenset[Candidate] = frozenset()
    known: dict[Candidate, DesignEvaluation] = field(default_factory=dict)

    def __call__(self, candidates: Sequence[Candidate]) -> Iterable[DesignEvaluation]:
        """Judge designs."""
        new = [each for each in candidates if each not in self.known and each not in self.unstated]
        judged = iter(self.evaluate(new))
        for candidate in candidates:
            if candidate in self.unstated:
                yield DesignEvaluation(candidate=candidate, feasible=Feasibility.NO, broken_rule=UNSTATED)
                continue
            if candidate not in self.known:
                self.known[candidate] = next(judged)
            yield self.known[candidate]

    def without(self, more: Collection[DesignEvaluation]) -> StatedOnly:
        """The same without more designs."""
        return replace(self, unstated=self.unstated | {each.candidate for each in more})


def without_unstated(search: SearchResult, unstated: Sequence[DesignEvaluation]) -> SearchResult:
    """The result of a search without designs that no description states.

    Where all designs were judged one by one, the best one of the others is the best one that can be stated. Other proofs rest on
    designs that are left out now.
    """
    best = tuple(each for each in search.best if each not in unstated)
    is_proved = search.conclusion is Conclusion.OPTIMAL and search.is_exhaustive and bool(best)
    reason = f"{counted(len(unstated), 'design')} of the system cannot be stated in the description"
    return replace(
        search,
        best=best,
        front=pareto_front(best),
        tried=search.tried - len(unstated),
        broken={**search.broken, UNSTATED: search.broken.get(UNSTATED, 0) + len(unstated)},
        conclusion=Conclusion.OPTIMAL if is_proved else Conclusion.BEST_FOUND if best else Conclusion.NOT_FOUND,
        proof=f"{search.proof}, of which the description cannot state {len(unstated)}" if is_proved else "",
        ended=search.ended if is_proved else "; ".join(filter(None, (search.ended, reason))),
    )


def proved_for_stated(search: SearchResult, unstated: Collection[Candidate]) -> SearchResult:
    """A result of a search that knows which designs cannot be stated: only what was judged one by one proves something."""
    if not unstated or search.is_exhaustive or search.conclusion not in (Conclusion.OPTIMAL, Conclusion.NONE):
        return search
    weaker = Conclusion.BEST_FOUND if search.best else Conclusion.NOT_FOUND
    return replace(search, conclusion=weaker, proof="", ended="some designs cannot be stated in the description")
