"""Judges each design once, and keeps the results, so that a search can end at any time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from amalthea_uros.design.optimize.candidate import Candidate
from amalthea_uros.design.optimize.problem import Evaluation, Evaluator

INTERRUPTED = "interrupted"


class EndedError(Exception):
    """A search has to end; the text says why."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How much is tried.

    Attributes
    ----------
    designs : at most so many are judged
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
    found: dict[Candidate, Evaluation] = field(default_factory=dict)

    def __call__(self, candidates: Sequence[Candidate]) -> list[Evaluation]:
        """Judge designs.

        Raises
        ------
        EndedError : the search has to end before they are judged.
        """
        new = [candidate for candidate in dict.fromkeys(candidates) if candidate not in self.found]
        rest = self.effort.designs - len(self.found)
        self._check_ended()
        for evaluation in self.evaluate(new[:rest]):
            self.found[evaluation.candidate] = evaluation
            self.effort.progress(len(self.found))
            self._check_ended()
        if len(new) > rest:
            raise EndedError(f"the limit of {self.effort.designs:,} designs was reached")
        return [self.found[candidate] for candidate in candidates]

    def _check_ended(self) -> None:
        if reason := self.effort.ended():
            raise EndedError(reason)
