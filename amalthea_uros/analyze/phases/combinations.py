"""The combinations of the phases of what comes from outside, and the solution for each of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from amalthea_uros.analyze.phases.cases import Cases, PhaseCases
from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.timing.activation.phases import ExternalInput, phase_combinations, phase_count, with_phases

#: With more combinations of phases, or more jobs in all of them, any job can be the one that takes what comes from outside.
MAX_COMBINATIONS = 1000


MAX_JOBS = 1_000_000


@dataclass(frozen=True, slots=True)
class Phases:
    """The combinations of phases of a system, each of which makes a solution of its own.

    Attributes
    ----------
    solution : for unknown phases
    first : for the first combination
    combinations : the first job that takes each occurrence
    cases : those of the combinations that make a difference
    """

    solution: Solution
    first: Solution
    combinations: Sequence[Mapping[ExternalInput, int]]
    cases: PhaseCases

    @classmethod
    def of(cls, solution: Solution, unknown: Sequence[ExternalInput]) -> Phases | None:
        """The combinations of some unknown phases; None if there are none or too many."""
        count = phase_count(unknown)
        if not unknown or count > MAX_COMBINATIONS:
            return None
        combinations = list(phase_combinations(unknown))
        first = _solution(solution, combinations[0])
        if count * sum(response.jobs for response in first.responses.values()) > MAX_JOBS:
            return None
        return cls(solution, first, combinations, PhaseCases(solution, first, combinations))

    def solutions(self, cases: Cases) -> Iterator[tuple[int, Solution]]:
        """The numbers of the combinations of some cases, and their solutions."""
        for number in cases:
            yield number, _solution(self.solution, self.combinations[number]) if number else self.first


def _solution(solution: Solution, combination: Mapping[ExternalInput, int]) -> Solution:
    context = solution.context
    return solve(timing_context(with_phases(context.system, combination), context.settings))
