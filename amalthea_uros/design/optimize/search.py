"""The search that fits a problem: exact where that is possible, otherwise the best of so many designs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from amalthea_uros.design.optimize.conclusion import concluded
from amalthea_uros.design.optimize.enumeration import count_with
from amalthea_uros.design.optimize.exhaustive import try_all
from amalthea_uros.design.optimize.goals import CHANGES
from amalthea_uros.design.optimize.problem import Conclusion, Problem, SearchResult
from amalthea_uros.design.optimize.recorder import INTERRUPTED, Effort, EndedError, Recorder
from amalthea_uros.design.optimize.solvers.annealing import solve_by_annealing
from amalthea_uros.design.optimize.solvers.mapping import solve_mapping
from amalthea_uros.design.optimize.solvers.offsets import solve_offsets
from amalthea_uros.design.optimize.solvers.priorities import solve_priorities

#: Each proves something about problems of its kind, and refuses others.
EXACT: tuple[Callable[[Problem], SearchResult | None], ...] = (solve_priorities, solve_mapping, solve_offsets)


def search(problem: Problem, effort: Effort) -> SearchResult:
    """The best designs, with as much proof as there is.

    A space with at most as many designs as may be judged is tried completely; if nothing is proved then, an exact solver may. In a
    larger one, the designs with few changes are tried if their number counts most; then an exact solver for the kind of problem; in the
    end a part of all designs is chosen at random.
    """
    recorder = Recorder(problem.evaluate, effort)
    recorded = replace(problem, evaluate=recorder)
    try:
        return _search(recorded, recorder)
    except EndedError as error:
        return concluded(recorder.found.values(), proof="", ended=str(error))
    except KeyboardInterrupt:
        return concluded(recorder.found.values(), proof="", ended=INTERRUPTED)


def _search(problem: Problem, recorder: Recorder) -> SearchResult:
    effort, size = recorder.effort, problem.space.size
    if size <= effort.designs:
        tried = try_all(problem, effort.is_complete)
        return tried if tried.conclusion is not Conclusion.NOT_FOUND else _proved(problem) or tried
    if problem.goals[0].name == CHANGES and not effort.is_complete:
        found = _with_few_changes(problem, effort.designs // 2)
        if found is not None and found.best:
            return found
    if (proved := _proved(problem)) is not None:
        return proved
    solve_by_annealing(problem, effort.designs - len(recorder.found))
    return concluded(recorder.found.values(), proof="", ended=f"{len(recorder.found):,} designs were chosen")


def _proved(problem: Problem) -> SearchResult | None:
    """What an exact solver proves; it knows more than the analysis of each design does, such as certain misses behind bounds."""
    for solve in EXACT:
        solved = solve(problem)
        if solved is not None and solved.conclusion in (Conclusion.OPTIMAL, Conclusion.NONE):
            return solved
    return None


def _with_few_changes(problem: Problem, designs: int) -> SearchResult | None:
    """The designs with the fewest changes that meet all limits; None if so many designs are not enough to find them."""
    rest = designs
    level = 0
    while (rest := rest - count_with(problem.space, level)) >= 0:
        level += 1
    return try_all(problem, most=level - 1) if level else None
