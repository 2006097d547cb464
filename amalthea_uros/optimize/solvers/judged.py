"""The designs that a solver has judged, and what follows from them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice

from amalthea_uros.optimize.candidate import Candidate
from amalthea_uros.optimize.front import pareto_front
from amalthea_uros.optimize.problem import Conclusion, Evaluation, Feasibility, Problem, SearchResult
from amalthea_uros.optimize.ranking import ranked

#: Designs are judged in groups of this size, whatever judges them, so that a search ends after the same design everywhere.
BATCH = 32


@dataclass(slots=True)
class Judged:
    """The designs that were judged, each one once."""

    problem: Problem
    _found: dict[Candidate, Evaluation] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self._found)

    def __getitem__(self, candidate: Candidate) -> Evaluation:
        return self._found[candidate]

    def judge(self, candidates: Iterable[Candidate]) -> None:
        """Judge designs, in groups."""
        for batch in batches(dict.fromkeys(candidates)):
            new = [candidate for candidate in batch if candidate not in self._found]
            self._found |= dict(zip(new, self.problem.evaluate(new), strict=True))

    def concluded(self, proof: str, ended: str = "", excluded: int = 0) -> SearchResult:
        """The result of the search.

        Parameters
        ----------
        proof : why no other design is better or meets all limits; "" if that is not proved
        ended : why the search ended early
        excluded : number of designs that the proof excludes
        """
        every = [each for each in self._found.values() if not each.broken_rule]
        broken: dict[str, int] = {}
        for each in self._found.values():
            if each.broken_rule:
                broken[each.broken_rule] = broken.get(each.broken_rule, 0) + 1
        feasible = ranked(each for each in every if each.feasible is Feasibility.YES)
        undecided = sum(each.feasible is Feasibility.UNKNOWN for each in every)
        is_proved = bool(proof) and (bool(feasible) or not undecided)
        found = Conclusion.OPTIMAL if is_proved else Conclusion.BEST_FOUND
        missing = Conclusion.NONE if is_proved else Conclusion.NOT_FOUND
        return SearchResult(
            best=tuple(feasible),
            front=pareto_front(feasible),
            conclusion=found if feasible else missing,
            tried=len(every),
            excluded=excluded if is_proved else 0,
            broken=broken,
            undecided=undecided,
            proof=proof if is_proved else "",
            ended=ended,
        )


def batches(candidates: Iterable[Candidate]) -> Iterator[list[Candidate]]:
    """Groups of designs."""
    rest = iter(candidates)
    while batch := list(islice(rest, BATCH)):
        yield batch
