"""How far events that have to occur together are apart.

AMALTHEA asks for windows of the width of a tolerance, such that each occurrence of each event is in a window, and each window has an
occurrence of every event. If multiple occurrences are allowed, all windows are considered: what counts is, for each occurrence, the
narrowest one that it is in. Otherwise only the subsequent occurrences are: a window begins at the first occurrence after the window
before it, and ends when every event has occurred.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import limits_of
from amalthea_uros.perf.constraints import ChainSynchronization, EventSynchronization
from amalthea_uros.simulate.kernel.layout import NEVER
from amalthea_uros.simulate.metrics.extremes import WINDOW, Extremes, LimitedQuantity


@dataclass(slots=True, kw_only=True)
class Synchronization(ABC):
    """What both readings have in common.

    Attributes
    ----------
    events : number of events
    base : time units in a picosecond
    """

    constraint: EventSynchronization | ChainSynchronization
    events: int
    base: int
    extremes: Extremes = field(init=False)

    def __post_init__(self) -> None:
        self.extremes = Extremes(self.base)

    @abstractmethod
    def add(self, times: Numbers, which: Numbers) -> None:
        """Take occurrences in, in the order of time; each is of one of the events."""

    def quantities(self, end: int) -> Iterator[LimitedQuantity]:
        """What was observed up to the end of the run."""
        values = self._values(end)
        yield from (LimitedQuantity(limit, values) for limit in limits_of(self.constraint))

    @abstractmethod
    def _values(self, end: int) -> ObservedValues:
        """The values, and what is missing of them."""


@dataclass(slots=True, kw_only=True)
class SubsequentOccurrences(Synchronization):
    """From the first occurrence after a window to the one that completes the next."""

    _start: int = -1
    _seen: set[int] = field(default_factory=set)

    def add(self, times: Numbers, which: Numbers) -> None:  # noqa: D102
        found: list[tuple[int, int]] = []
        for time, event in zip(times.tolist(), which.tolist(), strict=True):
            if not self._seen:
                self._start = time
            self._seen.add(event)
            if len(self._seen) == self.events:
                found.append((time - self._start, self._start))
                self._seen.clear()
        windows = np.array(found, np.int64).reshape(-1, 2)
        self.extremes.add(windows[:, 0], windows[:, 1])

    def _values(self, end: int) -> ObservedValues:
        return self.extremes.limited("not every event occurred", end - self._start if self._seen else 0)


@dataclass(slots=True, kw_only=True)
class AllOccurrences(Synchronization):
    """For each occurrence the width of the narrowest window with an occurrence of every event that it is in."""

    #: Occurrences of which the narrowest window can still come, and the latest occurrence of each event before them.
    _times: Numbers = field(default_factory=lambda: np.empty(0, np.int64))
    _which: Numbers = field(default_factory=lambda: np.empty(0, np.int64))
    _latest: Numbers = field(default_factory=lambda: np.empty(0, np.int64))
    _is_complete: bool = True

    def add(self, times: Numbers, which: Numbers) -> None:  # noqa: D102
        self._times, self._which = np.concatenate([self._times, times]), np.concatenate([self._which, which])
        widths, decided = self._narrowest()
        self.extremes.add(widths[:decided], self._times[:decided])
        self._drop(decided)
        if len(self._times) > WINDOW:
            self._is_complete = False
            self._drop(len(self._times) - WINDOW)

    def _narrowest(self) -> tuple[Numbers, int]:
        """The narrowest window so far of each occurrence, and of how many no later one can be narrower."""
        times, count = self._times, len(self._times)
        if count == 0:
            return times, 0
        begins = self._begins()
        widths = np.where(begins >= 0, times - begins, NEVER)
        # From here on the windows of an occurrence begin at it, and the first one is the narrowest of those.
        last = np.searchsorted(begins, times)
        own = np.where(last < count, times[np.minimum(last, count - 1)] - times, NEVER)
        index = np.arange(count)
        pairs = np.column_stack((index, np.minimum(last, count))).ravel()
        before = np.minimum.reduceat(np.append(widths, NEVER), pairs)[::2]
        narrowest = np.minimum(np.where(last > index, before, NEVER), own)
        return narrowest, int(np.count_nonzero(last < count))

    def _begins(self) -> Numbers:
        """Where the narrowest window begins that ends at each occurrence; -1: there is none."""
        begins = np.full(len(self._times), NEVER)
        for event in range(self.events):
            found = np.where(self._which == event, self._times, -1)
            if len(self._latest):
                found[0] = max(found[0], self._latest[event])
            begins = np.minimum(begins, np.maximum.accumulate(found))
        return begins

    def _drop(self, count: int) -> None:
        latest = np.full(self.events, -1) if len(self._latest) == 0 else self._latest
        for event in range(self.events):
            here = self._times[:count][self._which[:count] == event]
            if len(here):
                latest[event] = here[-1]
        self._latest, self._times, self._which = latest, self._times[count:], self._which[count:]

    def _values(self, end: int) -> ObservedValues:
        """Windows that end after the end of the run are as long at least as what has passed of them."""
        widths, _ = self._narrowest()
        pending = int(np.minimum(widths, end - self._times).max()) if len(self._times) else 0
        reason = "not every event occurred" if self._is_complete else "events are too far apart to be observed"
        return self.extremes.limited(reason, pending, self._is_complete)
