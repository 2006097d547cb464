"""The busy window: the least fixed point of the demand that arrives in it.

Periodic interference is held as arrays of whole numbers, one row for each part of a task: a part that comes every n-th time is one with
n times the period and the distance, because ceil(ceil(x / p) / n) = ceil(x / (p n)). The loops over rows are numpy's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import accumulate
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.arrivals import NEVER, Periodic
from amalthea_uros.analyze.supply import FULL, Supply
from amalthea_uros.analyze.task import Task
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]

#: A busy window that is still growing after so many steps is taken to have no end.
MOST_STEPS = 100_000
#: Windows beyond it are as good as endless: 53 days.
LIMIT: Time = NEVER // 4


def fixed_point(
    window: int, fixed: int, periods: Numbers, jitters: Numbers, distances: Numbers, costs: Numbers, limited: bool
) -> int:
    """The least window that holds its own demand, from a lower bound on; more than LIMIT if there is none below it."""
    for _ in range(MOST_STEPS):
        demand = fixed + demand_in(window, periods, jitters, distances, costs, limited)
        if demand <= window:
            return window
        if demand > LIMIT:
            return demand
        window = demand
    return LIMIT + 1


def demand_in(window: int, periods: Numbers, jitters: Numbers, distances: Numbers, costs: Numbers, limited: bool) -> int:
    """The demand that arrives in a window; without least distances where `limited` is false."""
    count = (window + jitters + periods - 1) // periods
    if limited:
        near = (window + distances - 1) // np.maximum(distances, 1)
        count = np.where(distances > 0, np.minimum(count, near), count)
    return int((count * costs).sum())


@dataclass(frozen=True, slots=True)
class Rows:
    """The periodic parts of tasks.

    Attributes
    ----------
    best : least costs, 0 where arrivals may stay away or jitter
    """

    periods: Numbers
    jitters: Numbers
    distances: Numbers
    costs: Numbers
    best: Numbers
    limited: bool

    def first(self, count: int) -> Rows:
        """The first rows."""
        return Rows(
            self.periods[:count],
            self.jitters[:count],
            self.distances[:count],
            self.costs[:count],
            self.best[:count],
            self.limited,
        )


def _rows(task: Task) -> list[tuple[int, int, int, int, int]]:
    arrivals = task.arrivals
    if not isinstance(arrivals, Periodic):
        return []
    is_certain = not arrivals.jitter and not arrivals.sporadic
    return [
        (
            arrivals.period * part.prescaler,
            arrivals.jitter,
            arrivals.distance * part.prescaler,
            part.worst,
            part.best if is_certain else 0,
        )
        for part in task.cost.parts
    ]


@dataclass(frozen=True, slots=True)
class Interference:
    """The demand of tasks in a window.

    Attributes
    ----------
    others : tasks whose arrivals are not periodic
    rate : about the demand per time in the long run
    supply : what serves them
    """

    tasks: Sequence[Task]
    rows: Rows
    others: Sequence[Task]
    rate: float
    supply: Supply = FULL

    @classmethod
    def of(cls, tasks: Sequence[Task], supply: Supply = FULL) -> Interference:
        """That of tasks."""
        *_, last = cls.of_first(tasks, supply)
        return last

    @classmethod
    def of_first(cls, tasks: Sequence[Task], supply: Supply = FULL) -> list[Interference]:
        """That of no task, of the first one, of the first two, and so on; all of them share their rows."""
        rows = [_rows(task) for task in tasks]
        columns = np.array([row for part in rows for row in part], dtype=np.int64).reshape(-1, 5)
        whole = Rows(*(np.ascontiguousarray(columns[:, index]) for index in range(5)), bool(columns[:, 2].any()))  # type: ignore[arg-type, call-arg]
        ends = list(accumulate((len(part) for part in rows), initial=0))
        rates = list(accumulate((float(demand_rate(task)) for task in tasks), initial=0.0))
        others = [task for task in tasks if not isinstance(task.arrivals, Periodic)]
        counts = list(accumulate((not isinstance(task.arrivals, Periodic) for task in tasks), initial=0))
        return [
            cls(tasks[:index], whole.first(ends[index]), others[: counts[index]], rates[index], supply)
            for index in range(len(tasks) + 1)
        ]

    def in_window(self, window: Time) -> Time:
        """The most demand that arrives in a window."""
        if window <= 0:
            return 0
        rows = self.rows
        periodic = demand_in(window, rows.periods, rows.jitters, rows.distances, rows.costs, rows.limited)
        return periodic + self._of_others(window)

    def _of_others(self, window: Time) -> Time:
        return sum(task.cost.most(task.arrivals.most(window)) for task in self.others)

    def window(self, fixed: Time, start: Time) -> Time | None:
        """The least window that holds a fixed demand and the interference in it; None if it never ends.

        Parameters
        ----------
        start : a lower bound of the window
        """
        if self.supply is not FULL:
            return self._supplied_window(fixed, start)
        rows = self.rows
        window = max(1, fixed, start)
        for _ in range(MOST_STEPS):
            others = self._of_others(window)
            window = fixed_point(window, fixed + others, rows.periods, rows.jitters, rows.distances, rows.costs, rows.limited)
            if window > LIMIT:
                return None
            if self._of_others(window) == others:
                return window
        return None

    def _supplied_window(self, fixed: Time, start: Time) -> Time | None:
        window = max(1, start)
        for _ in range(MOST_STEPS):
            reached = self.supply.time_for(fixed + self.in_window(window))
            if reached <= window:
                return window
            if reached > LIMIT:
                return None
            window = reached
        return None

    def overloads_with(self, task: Task) -> bool:
        """Whether these tasks and another one demand more than there is, exactly."""
        about, supplied = self.rate + float(demand_rate(task)), self.supply.rate
        if abs(about - float(supplied)) > 1e-6:
            return about > supplied
        return sum((demand_rate(other) for other in self.tasks), demand_rate(task)) > supplied


def demand_rate(task: Task) -> Fraction:
    """The demand of a task per time in the long run, at worst."""
    return task.cost.mean_worst * task.arrivals.rate
