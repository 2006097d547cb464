"""Constraints on events: what was observed of delays, repetitions and synchronizations (TADL2: TIMMO-2-USE, deliverable D11)."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.judge.evidence import ObservedValues
from amalthea_uros.judge.limits import limits_of
from amalthea_uros.perf.constraints import (
    ChainSynchronization,
    DelayConstraint,
    EventSynchronization,
    Matching,
    RepetitionConstraint,
)
from amalthea_uros.simulate.kernel.layout import NEVER
from amalthea_uros.simulate.metrics.extremes import WINDOW, ConstraintMetrics, Extremes, LimitedQuantity

_TOO_FAR = "sources and targets are too far apart to be observed"


@dataclass(slots=True)
class Delays(ConstraintMetrics):
    """Delays from the occurrences of one event, the source (0), to those of another one, the target (1).

    The matchings of AMALTHEA are those of TADL2: for a reaction, some target has to occur within the limits after each source, and
    other targets are ignored; one to one, the i-th target belongs to the i-th source; for unique reactions, each target has to be the
    only one of one source, and a source that has been missed is left out before the matching continues.

    Attributes
    ----------
    first_violation : time of the first occurrence without a corresponding one; -1: there is none
    """

    constraint: DelayConstraint
    first_violation: int = -1

    @property
    def lower(self) -> int:
        """The lower limit; a target does not occur before its source."""
        return (self.constraint.lower or 0) * self.base

    @property
    def upper(self) -> int | None:
        """The upper limit."""
        return None if self.constraint.upper is None else self.constraint.upper * self.base

    def quantities(self, end: int) -> Iterator[LimitedQuantity]:  # noqa: D102
        values = self._values(end)
        at = Fraction(self.first_violation, self.base) if self.first_violation >= 0 else None
        values = replace(values, violation=self._violation(), violated_at=at)
        yield from (LimitedQuantity(limit, values) for limit in limits_of(self.constraint))

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


@dataclass(slots=True)
class Repetitions(ConstraintMetrics):
    """The time from each occurrence to the one `span` later, and the jitter.

    The jitter is the least one with which there are ideal points such that each occurrence comes at most that long after its own:
    points at the distance of the period if one is stated, and otherwise points of which each is between the lower and the upper limit
    after the one `span` before it.
    """

    constraint: RepetitionConstraint
    jitter: Extremes = field(init=False)
    #: The latest occurrences, and the number of all before them.
    _tail: Numbers = field(default_factory=lambda: np.empty(0, np.int64))
    _before: int = 0
    #: The least and the greatest deviation from the period so far.
    _late: tuple[int, int] | None = None
    #: By how much the latest distances exceed the upper limit, or fall below the lower one, for each of `span` lines of occurrences.
    _excess: dict[tuple[int, int], int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        ConstraintMetrics.__post_init__(self)
        self.jitter = Extremes(self.base)

    @property
    def span(self) -> int:
        """The number of repetitions; AMALTHEA's default of 0 means 1."""
        return max(1, self.constraint.span)

    def add(self, times: Numbers, which: Numbers) -> None:  # noqa: D102
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

    def quantities(self, end: int) -> Iterator[LimitedQuantity]:  # noqa: D102
        for limit in limits_of(self.constraint):
            yield LimitedQuantity(limit, self._jitter() if limit.is_jitter else self._values(end))

    def _values(self, end: int) -> ObservedValues:
        waited = end - int(self._tail[0]) if self._before >= self.span else 0
        return self.extremes.limited(f"it occurred {counted(self._before, 'time')}", waited)

    def _jitter(self) -> ObservedValues:
        if self.constraint.period is None and self.constraint.lower is None and self.constraint.upper is None:
            return ObservedValues(reason="neither a period nor limits state at which distance it ideally occurs")
        return self.jitter.limited(f"it occurred {counted(self._before, 'time')}")


@dataclass(slots=True)
class Synchronization(ConstraintMetrics):
    """How far events that have to occur together are apart.

    AMALTHEA asks for windows of the width of a tolerance, such that each occurrence of each event is in a window, and each window has
    an occurrence of every event. If multiple occurrences are allowed, all windows are considered: what counts is, for each occurrence,
    the narrowest one that it is in. Otherwise only the subsequent occurrences are: a window begins at the first occurrence after the
    window before it, and ends when every event has occurred.

    Attributes
    ----------
    events : number of events
    """

    constraint: EventSynchronization | ChainSynchronization
    events: int = field(kw_only=True)


@dataclass(slots=True)
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


@dataclass(slots=True)
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
