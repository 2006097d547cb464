"""The order of designs, the same wherever and however they are judged."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros.design.optimize.problem import Evaluation

Key: TypeAlias = tuple[tuple[tuple[bool, Fraction], ...], int, tuple[str, ...]]


def ranked(evaluations: Iterable[Evaluation]) -> list[Evaluation]:
    """The designs, the best first: by the goals in their order, the number of changes, and in the end their text."""
    return sorted(evaluations, key=rank)


def rank(evaluation: Evaluation) -> Key:
    """What designs are ordered by; an unknown value is worse than any other."""
    values = tuple((value is None, value or Fraction(0)) for value in evaluation.values)
    return values, evaluation.changes, tuple(map(str, evaluation.candidate))
