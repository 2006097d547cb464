"""Repetitions of an event, and their deviation from ideal points in time (TADL2: TIMMO-2-USE, deliverable D11)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.plural import counted
from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import limits_of
from amalthea_uros.perf.constraints import RepetitionConstraint
from amalthea_uros.simulate.metrics.extremes import Extremes, LimitedQuantity


@dataclass(slots=True)
class Repetitions:
    """The time from each occurrence to the one `span` later, and the jitter.

    The jitter is the least one with which there are ideal points such that each occurrence comes at most that long after its own:
    points at the distance of the period if one is stated, and otherwise points of which each is between the lower and the upper limit
    after the one `span` before it.

    Attributes
    ----------
    base : time units in a picosecond
    """

    constraint: RepetitionConstraint
    base: int
    extremes: Extremes = field(init=False)
    jitter: Extremes = field(init=False)
    #: The latest occurrences, and the number of all before them.
    _tail: Numbers = field(default_factory=lambda: np.empty(0, np.int64))
    _before: int = 0
    #: The least and the greatest deviation from the period so far.
    _late: tuple[int, int] | None = None
    #: By how much the latest distances exceed the upper limit, or fall below the lower one, for each of `span` lines of occurrences.
    _excess: dict[tuple[int, int], int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.extremes, self.jitter = Extremes(self.base), Extremes(self.base)

    @property
    def span(self) -> int:
        """The number of repetitions; AMALTHEA's default of 0 means 1."""
        return max(1, self.constraint.span)

    def add(self, times: Numbers, _which: Numbers) -> None:
        """Take occurrences in, in the order of time."""
        if len(times) == 0:
            return
        known = np.concatenate([self._tail, times])
        distances = known[self.span :] - known[: -self.span]
        self.extremes.add(distances, known[: len(distances)])
        if self.constraint.jitter is not None:
            self._deviate(times, distances, known)
        self._before += len(times)
        self._tail = known[-self.span :].copy()

    def _deviate(self, times: Numbers, distances: Numbers, known: Numbers) -> None:
        period, lower, upper = self.constraint.period, self.constraint.lower, self.constraint.upper
        if period is not None:
            self._deviate_from_period(times, period * self.base)
            return
        # The number of the occurrence at the end of each distance decides which line it belongs to.
        ends = known[len(known) - len(distances) :]
        first = self._before + len(times) - len(distances)
        for line in range(self.span):
            here = (np.arange(len(distances)) + first) % self.span == line
            if upper is not None:
                self._exceed((line, 1), distances[here] - upper * self.base, ends[here])
            self._exceed((line, -1), (lower or 0) * self.base - distances[here], ends[here])

    def _deviate_from_period(self, times: Numbers, period: int) -> None:
        late = times - (np.arange(len(times)) + self._before) * period
        earliest, latest = self._late or (int(late[0]), int(late[0]))
        lows = np.minimum(np.minimum.accumulate(late), earliest)
        highs = np.maximum(np.maximum.accumulate(late), latest)
        self.jitter.add(highs - lows, times)
        self._late = int(lows[-1]), int(highs[-1])

    def _exceed(self, line: tuple[int, int], excesses: Numbers, ends: Numbers) -> None:
        """The greatest sum of consecutive excesses up to each one; the distances of ideal points make up for smaller sums."""
        if len(excesses) == 0:
            return
        sums = self._excess.get(line, 0) + np.cumsum(excesses)
        greatest = sums - np.minimum(np.minimum.accumulate(sums), 0)
        self.jitter.add(greatest, ends)
        self._excess[line] = int(greatest[-1])

    def quantities(self, end: int) -> Iterator[LimitedQuantity]:
        """What was observed up to the end of the run."""
        count = self._before
        waited = end - int(self._tail[0]) if count >= self.span else 0
        reason = f"it occurred {counted(count, 'time')}"
        for limit in limits_of(self.constraint):
            values = self._jitter(reason) if limit.is_jitter else self.extremes.limited(reason, waited)
            yield LimitedQuantity(limit, values)

    def _jitter(self, reason: str) -> ObservedValues:
        if self.constraint.period is None and self.constraint.lower is None and self.constraint.upper is None:
            return ObservedValues(reason="neither a period nor limits state at which distance it ideally occurs")
        return self.jitter.limited(reason)
