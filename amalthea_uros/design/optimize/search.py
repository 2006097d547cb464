"""The search that fits a problem: exact where that is possible, otherwise the best of so many designs."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import replace

from amalthea_uros._internal.plural import counted
from amalthea_uros.design.optimize.annealing import solve_by_annealing
from amalthea_uros.design.optimize.goals import CHANGES
from amalthea_uros.design.optimize.judged import INTERRUPTED, Effort, EndedError, Judged, Recorder, concluded
from amalthea_uros.design.optimize.mapping import solve_mapping
from amalthea_uros.design.optimize.offsets import solve_offsets
from amalthea_uros.design.optimize.priorities import solve_priorities
from amalthea_uros.design.optimize.problem import Conclusion, DesignEvaluation, Feasibility, Problem, SearchResult
from amalthea_uros.design.optimize.space import count_with, designs_with, most_changes

#: So many designs are named at a time; enough for the workers of a cluster.
AT_A_TIME = 512


def try_all(problem: Problem, is_complete: bool = False, most: int | None = None) -> SearchResult:
    """Try all designs with no change, with one, with two and so on, until some meet all limits.

    If the number of changes is not what counts most, or if all are wanted, designs with more changes are tried as well.

    Parameters
    ----------
    is_complete : whether all are wanted
    most : of the changed values, if not all designs are tried; without a design that meets all limits, nothing is proved then
    """
    judged = Judged(problem)
    found = judged.found.values()
    stops_early = problem.goals[0].name == CHANGES and not is_complete
    levels = most_changes(problem.space)
    level = 0
    for level in range(1 + (levels if most is None else min(most, levels))):
        judged.judge(designs_with(problem.space, level), AT_A_TIME)
        if stops_early and any(each.feasible is Feasibility.YES for each in found):
            return replace(judged.concluded(_proof(found, level, is_everything=level == levels)), is_exhaustive=True)
    return replace(judged.concluded(_proof(found, level, is_everything=True) if level == levels else ""), is_exhaustive=True)


def _proof(found: Collection[DesignEvaluation], level: int, is_everything: bool) -> str:
    """What was tried, in numbers that can be checked."""
    broken, excluded = sum(bool(each.broken_rule) for each in found), sum(each.is_excluded for each in found)
    parts = [f"{len(found) - broken - excluded} judged by the analysis"]
    parts += [f"{excluded} excluded by lower bounds"] if excluded else []
    parts += [f"{broken} not allowed"] if broken else []
    most = "" if is_everything else f" with at most {counted(level, 'changed value')}"
    return f"all {counted(len(found), 'design')}{most}: {', '.join(parts)}"


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
