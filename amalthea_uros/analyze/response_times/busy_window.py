"""The busy window: the least fixed point of the demand that arrives in it.

Periodic interference is held as arrays of whole numbers, one row for each frame of a task: a frame of every n-th job is one with
n times the period and the distance, because ceil(ceil(x / p) / n) = ceil(x / (p n)). The loops over rows are numpy's.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.response_times.kernel import MAX_STEPS, demand_in, fixed_point
from amalthea_uros.analyze.response_times.supply import FULL, Supply
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.timing.event_models import Periodic, is_strictly_periodic
from amalthea_uros.timing.limits import LIMIT
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


@dataclass(slots=True)
class Rows:
    """Tasks with the same arrivals are one row with the sum of their costs; what is added later may not change earlier ones.

    Attributes
    ----------
    best : least costs, 0 where arrivals may stay away or jitter
    limited : whether any of the least distances matters
    """

    periods: Numbers
    jitters: Numbers
    distances: Numbers
    costs: Numbers
    best: Numbers
    limited: bool

    @classmethod
    def of(cls, keys: Iterable[tuple[int, int, int]]) -> Rows:
        """Rows of periods, jitters and distances, without costs so far."""
        columns = np.array(list(keys), dtype=np.int64).reshape(-1, 3)
        periods, jitters, distances = (np.ascontiguousarray(columns[:, index]) for index in range(3))
        return cls(periods, jitters, distances, np.zeros_like(periods), np.zeros_like(periods), bool(distances.any()))

    def with_more(self, row: int, worst: int, best: int) -> Rows:
        """Rows of which one costs more."""
        more = Rows(self.periods, self.jitters, self.distances, self.costs.copy(), self.best.copy(), self.limited)
        more.costs[row] += worst
        more.best[row] += best
        return more


def _rows(task: Task) -> list[tuple[tuple[int, int, int], int, int]]:
    """Period, jitter and distance, worst and best cost of each frame of a periodic task."""
    arrivals = task.arrivals
    if not isinstance(arrivals, Periodic):
        return []
    is_certain = not arrivals.jitter and is_strictly_periodic(arrivals)
    return [
        (
            # Beyond the limit there are no windows; to take arrivals for closer than they are is safe.
            (
                min(arrivals.period * frame.prescaler, LIMIT),
                arrivals.jitter,
                min(arrivals.min_interarrival * frame.prescaler, LIMIT),
            ),
            frame.worst,
            frame.best if is_certain else 0,
        )
        for frame in task.cost.frames
    ]


@dataclass(frozen=True, slots=True)
class Interference:
    """The demand of tasks in a window.

    Attributes
    ----------
    known, number : only the first ones of the tasks count
    rows, count : the periodic ones, of which only the first rows count
    others : tasks whose arrivals are not periodic
    rate, best_rate : about the demand per time in the long run, and the least that cannot be avoided
    supply : what serves them
    """

    known: Sequence[Task]
    number: int
    rows: Rows
    count: int
    others: tuple[Task, ...]
    rate: float
    best_rate: float
    supply: Supply = FULL

    @property
    def tasks(self) -> Sequence[Task]:
        """Those that demand."""
        return self.known[: self.number]

    @classmethod
    def of(cls, tasks: Sequence[Task], supply: Supply = FULL) -> Interference:
        """That of tasks."""
        *_, last = cls.of_first(tasks, supply)
        return last

    @classmethod
    def of_first(cls, tasks: Sequence[Task], supply: Supply = FULL) -> list[Interference]:
        """That of no task, of the first one, of the first two, and so on; they share what they have in common."""
        parts = [_rows(task) for task in tasks]
        numbers: dict[tuple[int, int, int], int] = {}
        for rows_of_task in parts:
            for key, _, _ in rows_of_task:
                numbers.setdefault(key, len(numbers))
        rows, count, rate, best_rate = Rows.of(numbers), 0, 0.0, 0.0
        others: tuple[Task, ...] = ()
        found = [cls(tasks, 0, rows, count, others, rate, best_rate, supply)]
        for number, (task, part) in enumerate(zip(tasks, parts, strict=True), start=1):
            for key, worst, best in part:
                row = numbers[key]
                if row < count:
                    rows = rows.with_more(row, worst, best)
                else:
                    rows.costs[row], rows.best[row], count = worst, best, row + 1
                best_rate += best / key[0]
            others = others if part else (*others, task)
            rate += about_rate(task)
            found.append(cls(tasks, number, rows, count, others, rate, best_rate, supply))
        return found

    def in_window(self, window: Time) -> Time:
        """The most demand that arrives in a window."""
        if window <= 0:
            return 0
        rows = self.rows
        periodic = demand_in(window, rows.periods, rows.jitters, rows.distances, rows.costs, self.count, rows.limited)
        return periodic + self._of_others(window)

    def _of_others(self, window: Time) -> Time:
        return sum(task.cost.max_demand(task.arrivals.eta_plus(window)) for task in self.others)

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
        for _ in range(MAX_STEPS):
            others = self._of_others(window)
            window = fixed_point(
                window, fixed + others, rows.periods, rows.jitters, rows.distances, rows.costs, self.count, rows.limited
            )
            if window > LIMIT:
                return None
            if not self.others or self._of_others(window) == others:
                return window
        return None

    def _supplied_window(self, fixed: Time, start: Time) -> Time | None:
        window = max(1, start)
        for _ in range(MAX_STEPS):
            reached = self.supply.time_for(fixed + self.in_window(window))
            if reached <= window:
                return window
            if reached > LIMIT:
                return None
            window = reached
        return None

    def overloads_with(self, task: Task) -> bool:
        """Whether these tasks and another one demand more than there is, exactly."""
        excess = self.rate + about_rate(task) - float(self.supply.rate)
        if abs(excess) > 1e-6:
            return excess > 0
        return sum((demand_rate(other) for other in self.tasks), demand_rate(task)) > self.supply.rate


def demand_rate(task: Task) -> Fraction:
    """The demand of a task per time in the long run, at worst."""
    return task.cost.mean_worst * task.arrivals.rate


def about_rate(task: Task) -> float:
    """The same, fast and not quite exact."""
    if isinstance(task.arrivals, Periodic):
        return sum([frame.worst / frame.prescaler for frame in task.cost.frames]) / task.arrivals.period
    return float(demand_rate(task))
