"""The assignment of tasks to cores as an integer program, solved by CP-SAT with one worker, so that equal runs give equal answers."""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version
from itertools import pairwise
from math import lcm
from typing import Any

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.optimize.partition import Assignment, Partition

#: Limit of CP-SAT's own measure of work, which does not depend on the computer.
MAX_WORK = 60.0
MAX_CUTS = 2000


@dataclass(frozen=True, slots=True, kw_only=True)
class ProgramResult:
    """An answer of the solver.

    Attributes
    ----------
    assignment : None if none was found
    is_proved : whether it has the smallest possible largest load, or whether none exists
    how : solver, version and number of cuts
    """

    assignment: Assignment | None
    is_proved: bool
    how: str


def solve_program(partition: Partition, refused: Sequence[Assignment] = ()) -> ProgramResult | None:
    """The assignment with the smallest largest load in which all tasks fit; None if the extra `optimize` is not installed.

    Parameters
    ----------
    refused : assignments that are left out, with those that differ only in the names of like cores
    """
    try:
        from ortools.sat.python import cp_model
    except ImportError:
        return None
    program = _Program(partition, cp_model)
    for assignment in refused:
        program.refuse(assignment)
    cuts = 0
    while True:
        found, is_proved = program.solve(partition.problem.seed)
        how = f"integer program by CP-SAT of OR-tools {version('ortools')}, {counted(cuts, 'cut')}"
        if found is None:
            return ProgramResult(assignment=None, is_proved=is_proved, how=how)
        sets = {core: frozenset(task for task, place in found.items() if place == core) for core in partition.cores}
        late = [core for core in partition.cores if not partition.fits(core, sets[core])]
        if not late:
            return ProgramResult(assignment=found, is_proved=is_proved, how=how)
        if cuts >= MAX_CUTS:
            return ProgramResult(assignment=None, is_proved=False, how=how)
        for core in late:
            program.cut(core, partition.minimal(core, sets[core]))
            cuts += 1


class _Program:
    """Variables: whether a task is on a core; the largest load is minimised, loads are scaled to whole numbers."""

    def __init__(self, partition: Partition, cp_model: Any) -> None:
        self.partition, self.cp = partition, cp_model
        self.model = cp_model.CpModel()
        self.tasks = partition.tasks()
        self.on = {
            (task, core): self.model.new_bool_var(f"{task} on {core}")
            for task in self.tasks
            for core in partition.cores
            if core in partition.choices[task].options
        }
        for task in self.tasks:
            self.model.add_exactly_one(self.on[task, core] for core in partition.cores if (task, core) in self.on)
        self._minimise_largest_load()
        self._use_in_order()

    def _minimise_largest_load(self) -> None:
        partition = self.partition
        loads = [partition.load(core, task) for task, core in self.on] + [partition.base(core) for core in partition.cores]
        scale = lcm(*(load.denominator for load in loads))
        whole = [int(load * scale) for load in loads]
        largest = self.model.new_int_var(0, sum(whole), "largest load")
        for core in partition.cores:
            own = sum(int(partition.load(core, task) * scale) * on for (task, other), on in self.on.items() if other == core)
            self.model.add(own + int(partition.base(core) * scale) <= largest)
            self.model.add(own + int(partition.base(core) * scale) <= scale)
        self.model.minimize(largest)

    def _use_in_order(self) -> None:
        """A task is on a core only if one before it is on the previous like core."""
        for group in self.partition.like:
            for previous, core in pairwise(group):
                for number, task in enumerate(self.tasks):
                    if (task, core) in self.on:
                        earlier = [self.on[each, previous] for each in self.tasks[:number] if (each, previous) in self.on]
                        self.model.add_bool_or([*earlier, self.on[task, core].negated()])

    def cut(self, core: str, tasks: frozenset[str]) -> None:
        """Exclude that tasks are together on a core, or on one like it."""
        for group in self.partition.like:
            if core in group:
                for each in group:
                    self.model.add_bool_or(self.on[task, each].negated() for task in sorted(tasks))

    def refuse(self, assignment: Assignment) -> None:
        """Exclude one assignment, in which like cores are used in order."""
        self.model.add_bool_or(self.on[task, core].negated() for task, core in assignment.items())

    def solve(self, seed: int) -> tuple[dict[str, str] | None, bool]:
        """An assignment, and whether it is the best one; or none, and whether there is none."""
        solver = self.cp.CpSolver()
        solver.parameters.num_workers = 1
        solver.parameters.random_seed = seed
        solver.parameters.max_deterministic_time = MAX_WORK
        status = solver.solve(self.model)
        if status in (self.cp.OPTIMAL, self.cp.FEASIBLE):
            found = {task: core for (task, core), on in self.on.items() if solver.boolean_value(on)}
            return found, status == self.cp.OPTIMAL
        return None, status == self.cp.INFEASIBLE
