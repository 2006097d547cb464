"""The Pareto front: designs of which none is better in every goal than another one."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.design.optimize.problem import Evaluation


def pareto_front(evaluations: Sequence[Evaluation]) -> tuple[Evaluation, ...]:
    """The designs that no other one dominates; of those with the same values the first.

    Parameters
    ----------
    evaluations : ordered by their values, so that no design is dominated by a later one
    """
    front: list[Evaluation] = []
    for each in evaluations:
        if None not in each.values and not any(_dominates(other, each) for other in front):
            front.append(each)
    return tuple(front)


def _dominates(one: Evaluation, other: Evaluation) -> bool:
    """Whether a design is nowhere worse than another one."""
    pairs = zip(one.values, other.values, strict=True)
    return all(a is not None and b is not None and a <= b for a, b in pairs)
