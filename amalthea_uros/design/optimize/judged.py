"""The designs that a search has judged, each one once, and what follows from them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from itertools import islice
from operator import le
from typing import TypeAlias

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.design.optimize.problem import Conclusion, DesignEvaluation, Evaluator, Feasibility, Problem, SearchResult
from amalthea_uros.design.optimize.space import Candidate

Key: TypeAlias = tuple[tuple[tuple[bool, Fraction], ...], int, tuple[str, ...]]


def rank(evaluation: DesignEvaluation) -> Key:
    """What designs are ordered by: the goals in their order, unknown values last, the number of changes, and in the end their text."""
    values = tuple((value is None, value or Fraction(0)) for value in evaluation.values)
    return values, evaluation.changes, tuple(map(str, evaluation.candidate))


def pareto_front(evaluations: Sequence[DesignEvaluation]) -> tuple[DesignEvaluation, ...]:
    """The designs that no other one dominates; of those with the same values the first.

    Parameters
    ----------
    evaluations : ordered by their values, so that no design is dominated by a later one
    """
    front: dict[tuple[Fraction, ...], DesignEvaluation] = {}
    for each in evaluations:
        values = tuple(value for value in each.values if value is not None)
        if len(values) == len(each.values) and not any(all(map(le, other, values)) for other in front):
            front[values] = each
    return tuple(front.values())


def concluded(evaluations: Iterable[DesignEvaluation], proof: str, ended: str = "", excluded: int = 0) -> SearchResult:
    """The result of a search.

    Parameters
    ----------
    proof : why no other design that is proved to meet all limits is better, or why all miss one; "" if that is not proved
    ended : why the search ended early
    excluded : number of designs that the proof excludes, beside those that lower bounds exclude
    """
    every = list(evaluations)
    judged = [each for each in every if not each.broken_rule and not each.is_excluded]
    feasible = sorted((each for each in judged if each.feasible is Feasibility.YES), key=rank)
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


INTERRUPTED = "interrupted"
#: All designs together may take so much work for each that may be judged, in jobs.
WORK_PER_DESIGN = 10_000


class EndedError(Exception):
    """A search has to end; the text says why."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How much is tried.

    Attributes
    ----------
    designs : at most so many are judged, and fewer if their analyses take more than `WORK_PER_DESIGN` on average
    is_complete : whether designs with more changes are judged although some with fewer changes meet all limits
    ended : asked after each design: why to end early, "" to go on
    progress : told how many designs have been judged
    """

    designs: int = 2000
    is_complete: bool = False
    ended: Callable[[], str] = lambda: ""
    progress: Callable[[int], None] = lambda _tried: None


@dataclass(slots=True)
class Recorder:
    """An evaluator that keeps what it finds."""

    evaluate: Evaluator
    effort: Effort
    found: dict[Candidate, DesignEvaluation] = field(default_factory=dict)
    work: int = 0

    def __call__(self, candidates: Sequence[Candidate]) -> list[DesignEvaluation]:
        """Judge designs.

        Raises
        ------
        EndedError : the search has to end before they are judged.
        """
        new = [candidate for candidate in dict.fromkeys(candidates) if candidate not in self.found]
        rest = self.effort.designs - len(self.found)
        self._check_ended(len(new))
        for number, evaluation in enumerate(self.evaluate(new[:rest]), start=1):
            self.found[evaluation.candidate] = evaluation
            self.work += evaluation.work
            self.effort.progress(len(self.found))
            self._check_ended(len(new) - number)
        if len(new) > rest:
            raise EndedError(f"the limit of {self.effort.designs:,} designs was reached")
        return [self.found[candidate] for candidate in candidates]

    def _check_ended(self, left: int) -> None:
        """Whether the search has to end before it judges the designs that are left."""
        if reason := self.effort.ended():
            raise EndedError(reason)
        if left and self.work >= self.effort.designs * WORK_PER_DESIGN:
            judged, allowed = counted(len(self.found), "design"), counted(self.effort.designs, "design")
            raise EndedError(f"judging {judged} took as much work as {allowed} may take")


#: Designs are judged in groups of this size, whatever judges them, so that a search ends after the same design everywhere.
BATCH = 32


@dataclass(slots=True)
class Judged:
    """The designs that were judged, each one once."""

    problem: Problem
    found: dict[Candidate, DesignEvaluation] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.found)

    def __getitem__(self, candidate: Candidate) -> DesignEvaluation:
        return self.found[candidate]

    def judge(self, candidates: Iterable[Candidate], at_a_time: int = BATCH) -> None:
        """Judge designs, in groups."""
        rest = iter(candidates)
        while batch := dict.fromkeys(islice(rest, at_a_time)):
            new = [candidate for candidate in batch if candidate not in self.found]
            self.found |= dict(zip(new, self.problem.evaluate(new), strict=True))

    def concluded(self, proof: str, ended: str = "", excluded: int = 0) -> SearchResult:
        """The result of the search; see `concluded`."""
        return concluded(self.found.values(), proof, ended, excluded)
