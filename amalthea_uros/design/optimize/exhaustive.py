"""Search by trying all designs, those with the fewest changes first."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

from amalthea_uros._internal.plural import counted
from amalthea_uros.design.optimize.candidate import Candidate
from amalthea_uros.design.optimize.conclusion import concluded
from amalthea_uros.design.optimize.enumeration import designs_with, most_changes
from amalthea_uros.design.optimize.goals import CHANGES
from amalthea_uros.design.optimize.problem import Evaluation, Feasibility, Problem, SearchResult

#: So many designs are named at a time; enough for the workers of a cluster.
BATCH = 512


def try_all(problem: Problem, is_complete: bool = False, most: int | None = None) -> SearchResult:
    """Try all designs with no change, with one, with two and so on, until some meet all limits.

    If the number of changes is not what counts most, or if all are wanted, designs with more changes are tried as well.

    Parameters
    ----------
    is_complete : whether all are wanted
    most : of the changed values, if not all designs are tried; without a design that meets all limits, nothing is proved then
    """
    found: list[Evaluation] = []
    stops_early = problem.goals[0].name == CHANGES and not is_complete
    levels = most_changes(problem.space)
    level = 0
    for level in range(1 + (levels if most is None else min(most, levels))):
        for batch in _batches(designs_with(problem.space, level)):
            found += problem.evaluate(batch)
        if stops_early and any(each.feasible is Feasibility.YES for each in found):
            return concluded(found, _proof(found, level, is_everything=level == levels))
    return concluded(found, _proof(found, level, is_everything=True) if level == levels else "")


def _batches(designs: Iterator[Candidate]) -> Iterator[list[Candidate]]:
    while batch := list(islice(designs, BATCH)):
        yield batch


def _proof(found: list[Evaluation], level: int, is_everything: bool) -> str:
    """What was tried, in numbers that can be checked."""
    broken, excluded = sum(bool(each.broken_rule) for each in found), sum(each.is_excluded for each in found)
    parts = [f"{len(found) - broken - excluded} judged by the analysis"]
    parts += [f"{excluded} excluded by lower bounds"] if excluded else []
    parts += [f"{broken} not allowed"] if broken else []
    most = "" if is_everything else f" with at most {counted(level, 'changed value')}"
    return f"all {counted(len(found), 'design')}{most}: {', '.join(parts)}"
