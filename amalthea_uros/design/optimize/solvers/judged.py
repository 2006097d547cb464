"""The designs that a solver has judged, and what follows from them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice

from amalthea_uros.design.optimize.candidate import Candidate
from amalthea_uros.design.optimize.conclusion import concluded
from amalthea_uros.design.optimize.problem import Evaluation, Problem, SearchResult

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
        return concluded(self._found.values(), proof, ended, excluded)


def batches(candidates: Iterable[Candidate]) -> Iterator[list[Candidate]]:
    """Groups of designs."""
    rest = iter(candidates)
    while batch := list(islice(rest, BATCH)):
        yield batch
