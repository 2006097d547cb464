"""Delays from the occurrences of one event, the source, to those of another one, the target.

The matchings of AMALTHEA are those of TADL2 (TIMMO-2-USE, deliverable D11): for a reaction, some target has to occur within the limits
after each source, and other targets are ignored; one to one, the i-th target belongs to the i-th source; for unique reactions, each
target has to be the only one of one source, and a source that has been missed is left out before the matching goes on.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from fractions import Fraction

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import limits_of
from amalthea_uros.perf.constraints import DelayConstraint, Matching
from amalthea_uros.simulate.metrics.extremes import WINDOW, Extremes, LimitedQuantity

_TOO_FAR = "sources and targets are too far apart to be observed"


@dataclass(slots=True)
class Delays(ABC):
    """What all matchings have in common.

    Attributes
    ----------
    base : time units in a picosecond
    first_violation : time of the first occurrence without a corresponding one; -1: there is none
    """

    constraint: DelayConstraint
    base: int
    extremes: Extremes = field(init=False)
    first_violation: int = -1

    def __post_init__(self) -> None:
        self.extremes = Extremes(self.base)

    @property
    def lower(self) -> int:
        """The lower limit; a target does not occur before its source."""
        return (self.constraint.lower or 0) * self.base

    @property
    def upper(self) -> int | None:
        """The upper limit."""
        return None if self.constraint.upper is None else self.constraint.upper * self.base

    @abstractmethod
    def add(self, times: Numbers, which: Numbers) -> None:
        """Take occurrences in, in the order of time: of the source (0) and the target (1)."""

    def quantities(self, end: int) -> Iterator[LimitedQuantity]:
        """What was observed up to the end of the run."""
        at = Fraction(self.first_violation, self.base) if self.first_violation >= 0 else None
        values = replace(self._values(end), violation=self._violation(), violated_at=at)
        yield from (LimitedQuantity(limit, values) for limit in limits_of(self.constraint))

    @abstractmethod
    def _values(self, end: int) -> ObservedValues:
        """The values, and what is missing of them."""

    def _violation(self) -> str:
        return ""

    def _violated(self, time: int) -> None:
        if self.first_violation < 0:
            self.first_violation = time


@dataclass(slots=True)
class Reactions(Delays):
    """From each source to the first target that does not come before the lower limit."""

    #: Sources without such a target so far.
    _waiting: Numbers = field(default_factory=lambda: np.empty(0, np.int64))

    def add(self, times: Numbers, which: Numbers) -> None:  # noqa: D102
        sources, targets = np.concatenate([self._waiting, times[which == 0]]), times[which == 1]
        found = np.searchsorted(targets, sources + self.lower)
        is_found = found < len(targets)
        self.extremes.add(targets[found[is_found]] - sources[is_found], sources[is_found])
        waiting = sources[~is_found]
        # Of the sources for which no target comes too early any more, the next one is that of all: the first and the last tell enough.
        over = int(np.searchsorted(waiting + self.lower, times[-1:], "right").sum())
        self._waiting = np.concatenate([waiting[:1], waiting[over - 1 :]]) if over > 2 else waiting

    def _values(self, end: int) -> ObservedValues:
        pending = end - int(self._waiting[0]) if len(self._waiting) else 0
        return self.extremes.limited("no target occurred after a source", pending)


@dataclass(slots=True)
class OneToOne(Delays):
    """From the i-th source to the i-th target."""

    #: Those of one event that have no corresponding one of the other so far.
    _sources: Numbers = field(default_factory=lambda: np.empty(0, np.int64))
    _targets: Numbers = field(default_factory=lambda: np.empty(0, np.int64))
    _is_over: bool = False

    def add(self, times: Numbers, which: Numbers) -> None:  # noqa: D102
        if self._is_over:
            return
        sources, targets = (
            np.concatenate([before, times[which == number]]) for number, before in enumerate((self._sources, self._targets))
        )
        count = min(len(sources), len(targets))
        self.extremes.add(targets[:count] - sources[:count], sources[:count])
        self._sources, self._targets = sources[count:], targets[count:]
        self._is_over = max(len(self._sources), len(self._targets)) > WINDOW
        early = np.flatnonzero(targets[:count] < sources[:count])
        if len(early) or len(self._targets):
            self._violated(int(targets[early[0] if len(early) else count]))

    def _values(self, end: int) -> ObservedValues:
        pending = end - int(self._sources[0]) if len(self._sources) else 0
        return self.extremes.limited(_TOO_FAR if self._is_over else "no target occurred", pending, not self._is_over)

    def _violation(self) -> str:
        """A target that occurs before its source, or without one, is never right."""
        return "" if self.first_violation < 0 else "a target occurs before the source that it belongs to"


@dataclass(slots=True)
class UniqueReactions(Delays):
    """From each source to the one target within the limits."""

    _sources: deque[int] = field(default_factory=deque)
    _missed: int = 0
    _stray: int = 0
    _is_complete: bool = True

    def add(self, times: Numbers, which: Numbers) -> None:  # noqa: D102
        matched: list[tuple[int, int]] = []
        order = np.lexsort((which, times))
        for time, number in zip(times[order].tolist(), which[order].tolist(), strict=True):
            self._drop_missed(time)
            if number == 0:
                self._sources.append(time)
                if len(self._sources) > WINDOW:
                    self._sources.popleft()
                    self._is_complete = False
            elif self._sources and self._sources[0] + self.lower <= time:
                source = self._sources.popleft()
                matched.append((time - source, source))
            else:
                self._stray += 1
                self._violated(time)
        found = np.array(matched, np.int64).reshape(-1, 2)
        self.extremes.add(found[:, 0], found[:, 1])

    def _drop_missed(self, time: int) -> None:
        """Leave out the sources that no target at a time, or later, can belong to."""
        while self.upper is not None and self._sources and self._sources[0] + self.upper < time:
            self._missed += 1
            self._violated(self._sources.popleft())

    def _values(self, end: int) -> ObservedValues:
        self._drop_missed(end)
        return self.extremes.limited("no target occurred" if self._is_complete else _TOO_FAR, is_complete=self._is_complete)

    def _violation(self) -> str:
        counts = {"without a target": self._missed, "without a source": self._stray}
        return ", ".join(f"{count:,} {what}" for what, count in counts.items() if count)


_CLASSES: dict[Matching, type[Delays]] = {
    Matching.REACTION: Reactions,
    Matching.ONE_TO_ONE: OneToOne,
    Matching.UNIQUE_REACTION: UniqueReactions,
}


def delays(constraint: DelayConstraint, base: int) -> Delays:
    """What observes a constraint."""
    return _CLASSES[constraint.matching](constraint, base)
