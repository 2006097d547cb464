"""The busy window: the least fixed point of the demand that is activated in it.

Periodic interference is stored as integer arrays, with one row for each frame of a task: a frame of every n-th job has n times the
period and the minimum distance, because ceil(ceil(x / p) / n) = ceil(x / (p n)). Loops over rows are vectorised.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.response_times.kernel import MAX_STEPS, demand_in, least_fixed_point
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask, Supply
from amalthea_uros.timing.basics.time_base import LIMIT
from amalthea_uros.timing.event_models.models import PeriodicEvents, is_strictly_periodic
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


#: Greater sums could wrap.
MAX_SUM = 2.0**62
#: Approximate rates that differ by less are compared exactly.
_DOUBT = 1e-6


@dataclass(slots=True)
class Rows:
    """Periodic frames; those with the same activations are one row with the sum of their demands.

    Interferences share rows, so that an added demand makes a copy.

    Attributes
    ----------
    best : best-case demands, 0 for tasks with jitter or without a maximum time between activations
    limited : whether there is any minimum distance
    """

    periods: Numbers
    jitters: Numbers
    distances: Numbers
    demands: Numbers
    best: Numbers
    limited: bool

    @classmethod
    def of(cls, keys: Iterable[tuple[int, int, int]]) -> Rows:
        """Rows of periods, jitters and distances, with zero demand."""
        columns = np.array(list(keys), dtype=np.int64).reshape(-1, 3)
        periods, jitters, distances = (np.ascontiguousarray(columns[:, index]) for index in range(3))
        return cls(periods, jitters, distances, np.zeros_like(periods), np.zeros_like(periods), bool(distances.any()))

    def with_more(self, row: int, worst: int, best: int) -> Rows:
        """The rows with more demand in one of them."""
        more = Rows(self.periods, self.jitters, self.distances, self.demands.copy(), self.best.copy(), self.limited)
        # What wraps is not used: see `Interference.is_countable`.
        with np.errstate(over="ignore"):
            more.demands[row] += worst
            more.best[row] += best
        return more


def _rows(task: AnalysedTask) -> list[tuple[tuple[int, int, int], int, int]]:
    """((period, jitter, distance), worst-case demand, best-case demand) of each frame of a periodic task."""
    events = task.events
    if not isinstance(events, PeriodicEvents):
        return []
    is_certain = not events.jitter and is_strictly_periodic(events)
    return [
        (
            # No window exceeds the limit; assuming shorter distances is safe.
            (
                min(events.period * frame.prescaler, LIMIT),
                min(events.jitter + events.period * frame.jitter, LIMIT),
                min(events.min_interarrival * max(1, frame.prescaler - frame.jitter), LIMIT),
            ),
            frame.worst,
            frame.best if is_certain and not frame.jitter else 0,
        )
        for frame in task.demand.frames
    ]


@dataclass(frozen=True, slots=True)
class Interference:
    """The demand of tasks in a window.

    Attributes
    ----------
    all_tasks, task_count : only the first `task_count` tasks are included
    rows, row_count : the periodic ones, of which only the first `row_count` rows are included
    others : tasks with other event models
    rate, best_rate : approximate long-run demand per time, and the unavoidable part of it
    greatest : approximate demand of the rows in the longest window
    supply : of the core or server
    """

    all_tasks: Sequence[AnalysedTask]
    task_count: int
    rows: Rows
    row_count: int
    others: tuple[AnalysedTask, ...]
    rate: float
    best_rate: float
    greatest: float = 0.0
    supply: Supply = FULL

    @property
    def tasks(self) -> Sequence[AnalysedTask]:
        """The interfering tasks."""
        return self.all_tasks[: self.task_count]

    @classmethod
    def of(cls, tasks: Sequence[AnalysedTask], supply: Supply = FULL) -> Interference:
        """The interference of tasks."""
        *_, last = cls.of_first(tasks, supply)
        return last

    @classmethod
    def of_first(cls, tasks: Sequence[AnalysedTask], supply: Supply = FULL) -> list[Interference]:
        """The interference of no task, of the first one, of the first two, and so on; they share their rows."""
        parts = [_rows(task) for task in tasks]
        numbers: dict[tuple[int, int, int], int] = {}
        for rows_of_task in parts:
            for key, _, _ in rows_of_task:
                numbers.setdefault(key, len(numbers))
        rows, count, rate, best_rate, greatest = Rows.of(numbers), 0, 0.0, 0.0, 0.0
        others: tuple[AnalysedTask, ...] = ()
        found = [cls(tasks, 0, rows, count, others, rate, best_rate, greatest, supply)]
        for number, (task, part) in enumerate(zip(tasks, parts, strict=True), start=1):
            for key, worst, best in part:
                row = numbers[key]
                # With a greater demand, the rows are not used: see `is_countable`.
                kept = min(worst, LIMIT), min(best, LIMIT)
                if row < count:
                    rows = rows.with_more(row, *kept)
                else:
                    (rows.demands[row], rows.best[row]), count = kept, row + 1
                best_rate += best / key[0]
                greatest += worst * ((2 * LIMIT + key[1]) / key[0] + 1)
            others = others if part else (*others, task)
            rate += task.approximate_demand_rate
            found.append(cls(tasks, number, rows, count, others, rate, best_rate, greatest, supply))
        return found

    @property
    def is_countable(self) -> bool:
        """Whether sums over the rows fit into 64 bits; otherwise one job of each row, or their load, exceeds any window."""
        return self.greatest < MAX_SUM

    def in_window(self, window: Time) -> Time:
        """Maximum demand that is activated in a window."""
        if window <= 0:
            return 0
        if not self.is_countable:
            return sum(task.demand.max_demand(task.events.eta_plus(window)) for task in self.tasks)
        rows = self.rows
        periodic = demand_in(window, rows.periods, rows.jitters, rows.distances, rows.demands, self.row_count, rows.limited)
        return periodic + self._of_others(window)

    def _of_others(self, window: Time) -> Time:
        return sum(task.demand.max_demand(task.events.eta_plus(window)) for task in self.others)

    def window(self, fixed: Time, start: Time, horizon: Time = LIMIT) -> Time | None:
        """The shortest window that serves a fixed demand and the interference in it; None if it never ends.

        Parameters
        ----------
        start : a lower bound of the window
        horizon : longer windows are of no use, and may be None, too
        """
        if not self.is_countable:
            return None
        if self.supply is not FULL:
            return self._supplied_window(fixed, start)
        if self._never_ends(fixed):
            return None
        rows = self.rows
        window = max(1, fixed, start)
        for _ in range(MAX_STEPS):
            others = self._of_others(window)
            if fixed + others > LIMIT:
                return None
            window = least_fixed_point(
                window, fixed + others, rows.periods, rows.jitters, rows.distances, rows.demands, self.row_count, rows.limited
            )
            if window > min(LIMIT, horizon):
                return None
            if not self.others or self._of_others(window) == others:
                return window
        return None

    def _never_ends(self, fixed: Time) -> bool:
        """Whether more is always demanded than served: what is activated in a window is at least its length times the rate.

        Without this, a window of a core with a load of exactly 1 would be searched for up to the limit, in steps of the fixed demand.
        """
        if self.rate < 1 - _DOUBT:
            return False
        rate = sum((task.demand_rate for task in self.tasks), Fraction(0))
        return rate > 1 or (rate == 1 and fixed > 0)

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

    def overloads_with(self, task: AnalysedTask) -> bool:
        """Whether these tasks and another one demand more than the supply, exactly."""
        excess = self.rate + task.approximate_demand_rate - float(self.supply.rate)
        if abs(excess) > _DOUBT:
            return excess > 0
        return sum((other.demand_rate for other in self.tasks), task.demand_rate) > self.supply.rate
