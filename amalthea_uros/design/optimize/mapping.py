"""Exact mapping: the assignment of tasks to cores with the smallest largest load, or with the fewest changes.

Small problems are solved by branch and bound, tasks with the largest load first; a branch ends where the tasks of a core do not fit
together, or where it cannot become better. Larger ones are solved by an integer program (extra `optimize`) that knows only loads: each
set of tasks that the analysis refutes, made as small as possible, is added to it as a cut until the solution fits. Cores that differ
only in their names are used in the order of their names.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.design.optimize.integer_program import solve_program
from amalthea_uros.design.optimize.judged import Judged
from amalthea_uros.design.optimize.partition import Assignment, Partition
from amalthea_uros.design.optimize.problem import Feasibility, Problem, SearchResult

#: Problems with at most so many assignments are solved by branch and bound.
MAX_ASSIGNMENTS = 300_000
#: Of equally good assignments, at most so many are judged.
MAX_EQUAL = 200
#: Times that another solution is tried after the full analysis has refused one.
MAX_ROUNDS = 50

LOAD, CHANGES = "load", "changes"


def solve_mapping(problem: Problem) -> SearchResult | None:
    """The best mapping by its largest load or its number of changes; None if something else may change or counts."""
    if problem.goals[0].name not in (LOAD, CHANGES):
        return None
    partition = Partition.of(problem)
    if partition is None:
        return None
    judged = Judged(problem)
    if problem.space.size <= MAX_ASSIGNMENTS:
        return _by_branch_and_bound(partition, judged)
    return _by_program(partition, judged) if problem.goals[0].name == LOAD else None


def _by_branch_and_bound(partition: Partition, judged: Judged) -> SearchResult:
    refused: list[Assignment] = []
    for _ in range(MAX_ROUNDS):
        search = BranchAndBound(partition, judged.problem.goals[0].name, refused)
        equal = search.best()
        judged.judge(map(partition.candidate, equal))
        is_any_feasible = any(judged[partition.candidate(each)].feasible is Feasibility.YES for each in equal)
        if is_any_feasible or not equal:
            how = f"branch and bound, {counted(search.visited, 'partial assignment')}"
            return _result(partition, judged, how, partition.is_certain and not search.is_cut)
        # Deadlines are met, but something else is not, such as a limit of a chain.
        refused += equal
    return judged.concluded("", ended=f"{len(judged)} designs were judged")


def _by_program(partition: Partition, judged: Judged) -> SearchResult | None:
    refused: list[Assignment] = []
    for _ in range(MAX_ROUNDS):
        found = solve_program(partition, refused)
        if found is None:
            return None
        if found.assignment is None:
            return _result(partition, judged, found.how, found.is_proved and partition.is_certain)
        design = partition.candidate(found.assignment)
        judged.judge([design])
        if judged[design].feasible is Feasibility.YES:
            # Other goals may be better in another assignment with the same load.
            is_only_load = len(judged.problem.goals) == 1
            return _result(partition, judged, found.how, found.is_proved and partition.is_certain and is_only_load)
        refused.append(found.assignment)
    return judged.concluded("", ended=f"{len(judged)} designs were judged")


def _result(partition: Partition, judged: Judged, how: str, is_proved: bool) -> SearchResult:
    size = judged.problem.space.size
    sets = counted(partition.judged_sets, "set")
    proof = f"{how}; {sets} of tasks of a core were analysed, of {size:,} assignments" if is_proved else ""
    return judged.concluded(proof, excluded=size - len(judged))


@dataclass(slots=True)
class BranchAndBound:
    """The best assignments in which all tasks fit.

    Attributes
    ----------
    goal : what is to be small
    refused : assignments that are left out
    visited : number of partial assignments that were looked at
    is_cut : whether not all of the equally good assignments are given
    """

    partition: Partition
    goal: str
    refused: Sequence[Assignment] = ()
    visited: int = 0
    is_cut: bool = False
    _value: Fraction | None = None
    _best: list[Assignment] = field(default_factory=list)

    def best(self) -> list[Assignment]:
        """All assignments with the smallest value, but for the names of like cores."""
        partition = self.partition
        sets = {core: frozenset[str]() for core in partition.cores}
        if all(partition.fits(core, frozenset()) for core in partition.cores if partition.fixed[core]):
            self._extend(partition.tasks(), sets, partition.least if self.goal == LOAD else Fraction(0))
        return self._best

    def _extend(self, tasks: Sequence[str], sets: dict[str, frozenset[str]], value: Fraction) -> None:
        self.visited += 1
        if not tasks:
            assignment = {task: core for core, own in sets.items() for task in sorted(own)}
            if assignment not in self.refused:
                self._add(assignment, value)
            return
        task, *rest = tasks
        for core in self._cores(task, sets):
            extended = sets[core] | {task}
            larger = (
                max(value, self._load(core, extended))
                if self.goal == LOAD
                else value + (self.partition.choices[task].options[0] != core)
            )
            if (self._value is None or larger <= self._value) and self.partition.fits(core, extended):
                self._extend(rest, {**sets, core: extended}, larger)

    def _add(self, assignment: Assignment, value: Fraction) -> None:
        if self._value is None or value < self._value:
            self._value, self._best, self.is_cut = value, [], False
        if len(self._best) < MAX_EQUAL:
            self._best.append(assignment)
        else:
            self.is_cut = True

    def _cores(self, task: str, sets: dict[str, frozenset[str]]) -> Iterator[str]:
        """The cores on offer; of like ones that are empty only the first, unless their names count."""
        offered = self.partition.choices[task].options
        for group in self.partition.like if self.goal == LOAD else [[core] for core in self.partition.cores]:
            empty = [core for core in group if not sets[core]]
            yield from (core for core in group if core in offered and core not in empty[1:])

    def _load(self, core: str, tasks: frozenset[str]) -> Fraction:
        return self.partition.base(core) + sum((self.partition.load(core, task) for task in tasks), Fraction(0))
