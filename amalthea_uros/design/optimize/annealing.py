"""Search by simulated annealing, for spaces that are too large for a proof.

S. Kirkpatrick, C. D. Gelatt and M. P. Vecchi, "Optimization by simulated annealing", Science 220, 1983. Several walkers go through the
space at the same time, each with random numbers of its own that follow from the seed and its number. In each round every walker names
one neighbour of its design, and all of them are judged together: the result does not depend on how many computers judge them. Designs
that miss limits are compared by the time by which they miss them.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import exp
from random import Random

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.optimize.judged import BATCH, Judged
from amalthea_uros.design.optimize.problem import DesignEvaluation, Feasibility, Problem, SearchResult
from amalthea_uros.design.optimize.space import UNCHANGED, Candidate, Space, candidate

#: The difference of costs that is accepted with a probability of 1/e at the start.
TEMPERATURE = 0.1
#: Of the first goals; the next ones only count in the order of the results.
WEIGHTS = (0.9, 0.09, 0.009)
#: After so many rounds without a better design of its own, a walker starts again.
PATIENCE = 25
#: Rounds in which nothing new was proposed, after which the search ends.
IDLE_ROUNDS = 100


@dataclass(frozen=True, slots=True)
class Design:
    """A point of the space.

    Attributes
    ----------
    options : the number of the option of each choice
    orders : the tasks of each order, the most important first
    """

    options: tuple[int, ...]
    orders: tuple[tuple[str, ...], ...]

    @classmethod
    def present(cls, space: Space) -> Design:
        """The design as it is."""
        return cls((0,) * len(space.choices), tuple(order.tasks for order in space.orders))

    def candidate(self, space: Space) -> Candidate:
        """The design as changes."""
        changes = [
            Change(choice.object, choice.key, choice.options[option])
            for choice, option in zip(space.choices, self.options, strict=True)
            if option
        ]
        present: dict[str, str] = {}
        for order, tasks in zip(space.orders, self.orders, strict=True):
            present |= {change.target: change.value for change in order.changes(order.tasks)}
            changes += order.changes(tasks)
        return candidate(changes, present)

    def neighbour(self, space: Space, random: Random) -> Design:
        """A design that differs in one choice, or in the places of two tasks."""
        choices = [number for number, choice in enumerate(space.choices) if len(choice.options) > 1]
        orders = [number for number, tasks in enumerate(self.orders) if len(tasks) > 1]
        # An order decides as much as the choices of all its tasks would.
        weights = [1] * len(choices) + [len(self.orders[number]) for number in orders]
        position = random.choices(range(len(weights)), weights)[0]
        if position >= len(choices):
            return self._swapped(orders[position - len(choices)], random)
        number = choices[position]
        other = random.randrange(len(space.choices[number].options) - 1)
        option = other + (other >= self.options[number])
        return replace(self, options=(*self.options[:number], option, *self.options[number + 1 :]))

    def _swapped(self, number: int, random: Random) -> Design:
        """Two tasks of an order exchanged, more often neighbours than others."""
        tasks = list(self.orders[number])
        first = random.randrange(len(tasks) - 1)
        second = first + 1 if random.random() < 0.5 else random.choice([n for n in range(len(tasks)) if n != first])
        tasks[first], tasks[second] = tasks[second], tasks[first]
        return replace(self, orders=(*self.orders[:number], tuple(tasks), *self.orders[number + 1 :]))


@dataclass(slots=True)
class _Walker:
    """One way through the space.

    Attributes
    ----------
    idle : rounds without a design that is better than all others on its way
    """

    random: Random
    design: Design
    cost: float
    best: float
    idle: int = 0

    def step(self, design: Design, cost: float, temperature: float) -> None:
        """Go to a neighbour if it is better, or by chance."""
        if cost <= self.cost or (temperature > 0 and self.random.random() < exp((self.cost - cost) / temperature)):
            self.design, self.cost = design, cost
        self.idle = 0 if cost < self.best else self.idle + 1
        self.best = min(self.best, cost)


def solve_by_annealing(problem: Problem, designs: int = 2000) -> SearchResult:
    """The best of so many designs of a larger space."""
    space, judged = _sorted(problem.space), Judged(problem)
    judged.judge([UNCHANGED])
    scale = sum(each or 0 for each in judged[UNCHANGED].violations.values()) or 1
    start = Design.present(space)
    units = tuple(1e9 if goal.unit == "ps" else 1.0 for goal in problem.goals)
    first = _cost(judged[UNCHANGED], scale, units)
    walkers = [_Walker(Random(f"{problem.seed}/{number}"), start, first, first) for number in range(BATCH)]
    best, lowest, idle = start, first, 0
    while len(judged) < designs and idle < IDLE_ROUNDS:
        before = len(judged)
        proposed = [walker.design.neighbour(space, walker.random) for walker in walkers[: designs - before]]
        judged.judge(design.candidate(space) for design in proposed)
        temperature = TEMPERATURE * (1 - len(judged) / designs)
        for walker, design in zip(walkers, proposed, strict=False):
            walker.step(design, _cost(judged[design.candidate(space)], scale, units), temperature)
            if walker.cost < lowest:
                best, lowest = walker.design, walker.cost
        for number, walker in enumerate(walkers):
            if walker.idle >= PATIENCE:
                walker.design, walker.cost = (best, lowest) if number % 2 else (start, first)
                walker.best, walker.idle = walker.cost, 0
        idle = 0 if len(judged) > before else idle + 1
    return judged.concluded("", ended=f"{len(judged)} designs were judged")


def _sorted(space: Space) -> Space:
    """The space in an order that does not depend on that of a file."""
    return Space(
        choices=tuple(sorted(space.choices, key=lambda choice: choice.target)),
        orders=tuple(sorted(space.orders, key=lambda order: order.scheduler)),
    )


def _cost(evaluation: DesignEvaluation, scale: int, units: Sequence[float]) -> float:
    """Feasible designs by their values, between 0 and 1; others above, by the time by which they miss limits.

    Parameters
    ----------
    scale : by how much the present design misses limits
    units : of the values, of about their size
    """
    if evaluation.feasible is Feasibility.YES:
        values = zip(WEIGHTS, evaluation.values, units, strict=False)
        # Each value as a share between 0 and 1.
        return sum(
            weight * (1 if value is None else max(0.0, float(value) / (float(value) + unit))) for weight, value, unit in values
        )
    if evaluation.broken_rule or evaluation.reason:
        return 4
    late = sum(each or 0 for each in evaluation.violations.values())
    unknown = sum(each is None for each in evaluation.violations.values())
    return 1 + late / (late + scale) + unknown / (unknown + 1)
