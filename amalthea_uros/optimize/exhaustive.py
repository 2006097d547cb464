"""Search by trying all designs, those with the fewest changes first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import islice

from amalthea_uros._internal.plural import counted
from amalthea_uros.optimize.candidate import Candidate
from amalthea_uros.optimize.enumeration import count_with, designs_with, most_changes
from amalthea_uros.optimize.front import pareto_front
from amalthea_uros.optimize.goals import CHANGES
from amalthea_uros.optimize.problem import Conclusion, Evaluation, Feasibility, Problem, SearchResult
from amalthea_uros.optimize.ranking import ranked

#: Designs are judged in groups of this size, whatever judges them, so that a search ends after the same design everywhere.
BATCH = 32


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How much is tried.

    Attributes
    ----------
    designs : at most so many are judged
    is_complete : whether designs with more changes are judged although some with fewer changes meet all limits
    ended : asked between groups of designs: why to end early, "" to go on
    progress : told how many designs have been judged, and how many there are
    """

    designs: int = 2000
    is_complete: bool = False
    ended: Callable[[], str] = lambda: ""
    progress: Callable[[int, int], None] = lambda _tried, _of: None


@dataclass(slots=True)
class _Progress:
    """What was found so far."""

    judged: list[Evaluation] = field(default_factory=list)
    excluded: int = 0
    broken: Counter[str] = field(default_factory=Counter)
    ended: str = ""

    def add(self, evaluation: Evaluation) -> None:
        if evaluation.broken_rule:
            self.broken[evaluation.broken_rule] += 1
        elif evaluation.is_excluded:
            self.excluded += 1
        else:
            self.judged.append(evaluation)

    @property
    def seen(self) -> int:
        """The number of designs about which something is known."""
        return len(self.judged) + self.excluded + self.broken.total()

    @property
    def is_found(self) -> bool:
        return any(each.feasible is Feasibility.YES for each in self.judged)


def try_all(problem: Problem, effort: Effort) -> SearchResult:
    """Try all designs with no change, with one, with two and so on, until some meet all limits.

    If the number of changes is not what counts most, or if all are wanted, designs with more changes are tried as well.
    """
    found = _Progress()
    stops_early = problem.goals[0].name == CHANGES and not effort.is_complete
    levels = most_changes(problem.space)
    level = 0
    for level in range(levels + 1):
        _try_level(problem, level, effort, found)
        if found.ended or (stops_early and found.is_found):
            break
    return _result(problem, found, level, is_everything=not found.ended and level == levels)


def _try_level(problem: Problem, level: int, effort: Effort, found: _Progress) -> None:
    """Try the designs with so many changes."""
    total = sum(count_with(problem.space, each) for each in range(level + 1))
    for batch in _batches(designs_with(problem.space, level)):
        rest = effort.designs - len(found.judged)
        found.ended = effort.ended() or ("" if rest > 0 else f"{effort.designs} designs were judged")
        if found.ended:
            return
        try:
            for evaluation in problem.evaluate(batch[:rest]):
                found.add(evaluation)
        except KeyboardInterrupt:
            found.ended = "interrupted"
            return
        effort.progress(found.seen, total)
        if len(batch) > rest:
            found.ended = f"{effort.designs} designs were judged"
            return


def _batches(designs: Iterator[Candidate]) -> Iterator[list[Candidate]]:
    while batch := list(islice(designs, BATCH)):
        yield batch


def _result(problem: Problem, found: _Progress, level: int, is_everything: bool) -> SearchResult:
    feasible = ranked(each for each in found.judged if each.feasible is Feasibility.YES)
    undecided = sum(each.feasible is Feasibility.UNKNOWN for each in found.judged)
    count = len(found.judged)
    parts = [f"{count} judged by the analysis"]
    parts += [f"{found.excluded} excluded by lower bounds"] if found.excluded else []
    parts += [f"{found.broken.total()} not allowed"] if found.broken else []
    designs = (
        f"{found.seen} designs ({', '.join(parts)})" if len(parts) > 1 else f"{counted(count, 'design')} judged by the analysis"
    )
    conclusion, proof = Conclusion.NOT_FOUND, ""
    if found.ended or undecided:
        conclusion = Conclusion.BEST_FOUND if feasible else Conclusion.NOT_FOUND
    elif feasible:
        conclusion = Conclusion.OPTIMAL
        proof = f"all {designs}" if is_everything else f"all {designs} with at most {counted(level, 'changed value')}"
    else:
        conclusion, proof = Conclusion.NONE, f"all {designs}"
    return SearchResult(
        best=tuple(feasible),
        front=pareto_front(feasible),
        conclusion=conclusion,
        tried=count,
        excluded=found.excluded,
        broken=dict(found.broken),
        undecided=undecided,
        proof=proof,
        ended=found.ended,
    )
