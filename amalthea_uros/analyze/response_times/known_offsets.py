"""Response times of processes with known releases among others that block or are sporadic.

After J. C. Palencia and M. González Harbour, "Schedulability analysis for tasks with static and dynamic offsets", RTSS 1998: instead of
one busy window in which all processes are released together, each busy window that the offsets allow is examined. It starts with a
release of a process of the level, because a later start with the same releases ends later. Activations without known releases come
as early as possible. If all releases of the level are known, a process below it can block only if one of its jobs can be pending at
that start; the bounds of response times show which ones, so that the tighter bounds of one round are used in the next.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import lcm

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.response_times.blocking import Blocking
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.timing.activation.releases import known_releases
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.derived import rescaled
from amalthea_uros.timing.event_models.models import EventModel
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.timing.scheduling.scheduled import EqualPriority, ScheduledProcess, is_preemptive
from amalthea_uros.units import Time

METHOD = "busy windows at known releases"
SOURCE = "Palencia, González Harbour 1998"
#: Cores with more busy windows in a hyperperiod keep the bounds for simultaneous releases.
MAX_WINDOWS = 3000
#: Rounds after which bounds are no longer tightened.
MAX_ROUNDS = 4


def tightened(core: str, solution: Solution) -> Mapping[str, Response]:
    """The bounds on a core that known releases tighten, in picoseconds."""
    here = [item for item in solution.context.served(core, None) if isinstance(item, ScheduledProcess)]
    known = {item.name: item for item in here if _is_known(item, solution)}
    if len(known) < 2 or len(here) < len(solution.context.served(core, None)) or solution.context.decisions:
        return {}
    if solution.context.has_loops_or_waits(core) or not solution.is_closed(core):
        return {}
    windows = _OffsetWindows.of(core, solution, here, known)
    return windows.tightened() if windows is not None else {}


def _is_known(item: ScheduledProcess, solution: Solution) -> bool:
    response = solution.responses.get(item.name)
    return (
        response is not None
        and response.worst is not None
        and known_releases(item.process, solution.context.system) is not None
    )


@dataclass(frozen=True, slots=True)
class _Releases:
    """The releases of a process at offset + k * period, and its demand.

    Attributes
    ----------
    events : if releases are unknown
    """

    demand: MultiframeDemand
    period: Time = 0
    offset: Time = 0
    events: EventModel | None = None

    def in_window(self, start: Time, length: Time) -> Time:
        """Maximum demand that is released in a window."""
        if self.events is not None:
            return self.demand.max_demand(self.events.eta_plus(length))
        return self.demand.max_demand(self.before(start + length) - self.before(start))

    def before(self, time: Time) -> int:
        """Number of releases before a time, relative to a fixed one."""
        return -(-(time - self.offset) // self.period)

    def from_(self, start: Time, until: Time) -> range:
        """The releases in an interval."""
        return range(self.offset + self.before(start) * self.period, until, self.period)


@dataclass(slots=True)
class _OffsetWindows:
    """The busy windows of a core.

    Attributes
    ----------
    bounds : on the response times, which become tighter
    """

    core: str
    solution: Solution
    blocking: Blocking
    here: Sequence[ScheduledProcess]
    known: Mapping[str, ScheduledProcess]
    releases: Mapping[str, _Releases]
    hyperperiod: Time
    bounds: dict[str, Time]

    @classmethod
    def of(
        cls, core: str, solution: Solution, here: Sequence[ScheduledProcess], known: Mapping[str, ScheduledProcess]
    ) -> _OffsetWindows | None:
        """The windows; None if there are too many, or if something on the core is unknown."""
        context = solution.context
        if not all(solution.is_analysable(item.name) for item in here):
            return None
        time_base = context.demand_model.time_base(core)
        releases: dict[str, _Releases] = {}
        for item in here:
            stimulus = known_releases(item.process, context.system)
            demand = context.demands[item.name]
            if stimulus is None:
                releases[item.name] = _Releases(demand, events=rescaled(solution.event_models[item.name], time_base))
            else:
                releases[item.name] = _Releases(demand, stimulus.period * time_base, stimulus.offset * time_base)
        hyperperiod = lcm(*(releases[name].period for name in known))
        if len(known) * sum(hyperperiod // releases[name].period for name in known) > MAX_WINDOWS:
            return None
        blocking = Blocking.of(here, solution)
        # Offsets must differ, or blocking must be impossible at some releases.
        if not blocking.is_possible and len({releases[name].offset % releases[name].period for name in known}) < 2:
            return None
        found = cls(core, solution, blocking, here, known, releases, hyperperiod, {})
        for item in here:
            response = solution.responses.get(item.name)
            if response is not None and response.worst is not None:
                found.bounds[item.name] = response.worst * time_base
        return found

    def tightened(self) -> Mapping[str, Response]:
        """The tighter responses."""
        found: dict[str, Response] = {}
        time_base = self.solution.context.demand_model.time_base(self.core)
        for _ in range(MAX_ROUNDS):
            before = dict(self.bounds)
            for item in reversed(self.here):
                if item.name in self.known and (worst := self._worst(item)) is not None and worst.time < self.bounds[item.name]:
                    self.bounds[item.name] = worst.time
                    found[item.name] = worst.response(self.solution.responses[item.name], time_base)
            if self.bounds == before:
                break
        return found

    def _worst(self, item: ScheduledProcess) -> _Worst | None:
        """The worst case over all busy windows; None if a method for its level does not apply."""
        level = self.blocking.level(item)
        together = [other for other in self.here if other.rank == item.rank]
        if len(together) > 1 and not level.is_flat and item.equal_priority is not EqualPriority.FIFO:
            return None
        above = [other for other in self.here if other.rank >= level.rank]
        window = _LevelWindow(
            own=self.releases[item.name],
            others=[self.releases[other.name] for other in above if other is not item],
            interrupting=[
                self.releases[other.name] for other in above if other is not item and self.blocking.preempts(other, item)
            ],
            last_region=0 if is_preemptive(item) or level.is_flat else self.blocking.last_region(item),
            limit=2 * self.hyperperiod + self.bounds[item.name],
        )
        below = list(self.blocking.stretches_below(level))
        longest = max((length for _, length in below), default=0)
        # If others of the level can come at any time, they can wait for the blocking process before the start, and pile up.
        is_start_known = all(other.name in self.known for other in above)
        found: _Worst | None = None
        starting = [self.releases[other.name] for other in above if other.name in self.known]
        for start in sorted({start for releases in starting for start in releases.from_(0, self.hyperperiod)}):
            remaining = (self._remaining(other, start, length) for other, length in below)
            for worst in window.jobs_from(start, max(remaining, default=0) if is_start_known else longest):
                if worst is None:
                    return None
                if found is None or worst.time > found.time:
                    found = worst
        return found

    def _remaining(self, other: ScheduledProcess, start: Time, length: Time) -> Time:
        releases, bound = self.releases[other.name], self.bounds.get(other.name)
        if other.name not in self.known or bound is None or not length:
            return length
        latest = releases.offset + (releases.before(start) - 1) * releases.period
        return min(length, max(0, latest + bound - start))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Worst:
    """A job in a busy window: response time, its parts, and the length of the window until its end."""

    time: Time
    own: Time
    blocking: Time
    window: Time

    def response(self, bound: Response, time_base: int) -> Response:
        """The bound for simultaneous releases, tightened."""

        def up(time: Time) -> Time:
            return -(-time // time_base)

        worst, own, blocking, earlier = up(self.time), up(self.own), up(self.blocking), up(self.window - self.time)
        terms = {
            "own": own,
            "interference": worst + earlier - own - blocking,
            "blocking": blocking,
            "earlier arrival": -earlier,
        }
        return replace(bound, worst=worst, method=METHOD, source=SOURCE, claim=Claim.BOUND, window=up(self.window), terms=terms)


@dataclass(frozen=True, slots=True, kw_only=True)
class _LevelWindow:
    """Busy windows of a process.

    Attributes
    ----------
    others : that interfere
    interrupting : those of them that also preempt its last region
    limit : windows that are longer are given up
    """

    own: _Releases
    others: Sequence[_Releases]
    interrupting: Sequence[_Releases]
    last_region: Time
    limit: Time

    def jobs_from(self, start: Time, blocking: Time) -> Iterator[_Worst | None]:
        """The jobs of the process in the busy window with a start; None if it is too long."""
        length = self._fixed_point(start, blocking, [*self.others, self.own], max(1, blocking))
        if length is None:
            yield None
            return
        window = 0
        for count, release in enumerate(self.own.from_(start, start + length), start=1):
            own, earlier = self.own.demand.max_demand(count), self.own.demand.max_demand(count - 1)
            # With counters, the earlier jobs can be the longer ones: the last region is what these do not take.
            last = max(0, own - earlier - (self.own.demand.worst - self.last_region)) if self.last_region else 0
            end = self._end(start, blocking + own, max(window, release - start), last)
            if end is None:
                yield None
                return
            window = end
            yield _Worst(time=start + end - release, own=own, blocking=blocking, window=end)

    def _end(self, start: Time, fixed: Time, lower: Time, last: Time) -> Time | None:
        """The end of a job with a last region, with the demand of all jobs up to it and the blocking."""
        if not last:
            return self._fixed_point(start, fixed, self.others, max(1, lower))
        # The last region starts when nobody else is pending, not even at the same moment.
        before = self._fixed_point(start, fixed - last, self.others, lower, granularity=1)
        if before is None:
            return None
        served = self._demand(start, before + 1, self.interrupting)
        end = before + last
        while True:
            reached = before + last + max(0, self._demand(start, end, self.interrupting) - served)
            if reached <= end:
                return end
            if reached > self.limit:
                return None
            end = reached

    def _fixed_point(
        self, start: Time, fixed: Time, releases: Sequence[_Releases], lower: Time, granularity: Time = 0
    ) -> Time | None:
        """The shortest window that serves a fixed demand and what is released in it."""
        length = max(lower, fixed)
        while length <= self.limit:
            reached = fixed + self._demand(start, length + granularity, releases)
            if reached <= length:
                return length
            length = reached
        return None

    def _demand(self, start: Time, length: Time, releases: Sequence[_Releases]) -> Time:
        return sum(each.in_window(start, length) for each in releases)
