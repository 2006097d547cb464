"""The latencies of a route through a chain, by each method that is valid for it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.chains import bounds, job_chains
from amalthea_uros.analyze.chains.bounds import ChainTask, total
from amalthea_uros.analyze.chains.read_write_times import TimedStage
from amalthea_uros.analyze.results.chains import LatencyQuantity, LatencyValue
from amalthea_uros.errors import UnknownError
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time

_Make = Callable[[LatencyQuantity, "Time | float"], LatencyValue]

if TYPE_CHECKING:
    from amalthea_uros.analyze.chains.job_chains import JobBudget, JobChains

EXACT = "job chains over the hyperperiod"
BOUNDED = "job chains with earliest reads and latest writes"
SUMMED = "sum over controllers whose clocks are not synchronized"


#: A minimum and the maximum of the same times.
_RANGES = (
    (LatencyQuantity.MIN_FIRST_TO_FIRST, LatencyQuantity.MAX_REDUCED_REACTION_TIME),
    (LatencyQuantity.MIN_LAST_TO_LAST, LatencyQuantity.MAX_REDUCED_DATA_AGE),
)


@dataclass(frozen=True, slots=True)
class RouteLatencies:
    """The latencies of a route whose stages are grouped by controller.

    Attributes
    ----------
    parts : the stages on each controller, in order
    unit : time units per picosecond
    is_certain : whether all events are connected by links of known time
    budget : for the job chains of all routes
    """

    parts: Sequence[Sequence[TimedStage]]
    unit: int
    is_certain: bool
    budget: JobBudget

    def why(self, values: Iterable[LatencyValue]) -> str:
        """Why the tightest of the values are exact, or only bounds."""
        everything = [timed for part in self.parts for timed in part]
        reason = next((timed.reason for timed in everything if timed.reason), "")
        if reason:
            return f"bounds: {reason}"
        if len(self.parts) > 1:
            return "bounds: the clocks of the controllers are not synchronized"
        if not self.is_certain:
            return "bounds: the time at which an event of the chain causes the next one is unknown"
        if not any(value.source == job_chains.SOURCE for value in values):
            if self.parts[-1][-1].responds_before_read:
                return "bounds: the event at the end comes before its job reads, so that it can come before the stimulus"
            return f"bounds: {job_chains.TOO_MANY_JOBS}"
        varying = next((timed.task.name for timed in everything if not timed.is_exact), None)
        if varying is not None:
            return f"bounds: the read and write times of {varying!r} can vary"
        if not any(value.claim is Claim.EXACT for value in values):
            return "bounds: a job reads at the instant at which another one writes, and their order is not specified"
        return "exact: all release times are known, and execution times are constant or have no effect"

    @property
    def why_unbounded(self) -> str:
        """Why there is no bound of the reaction time; "" if there is one."""
        return next((timed.why_irregular for part in self.parts for timed in part if timed.why_irregular), "")

    def values(self) -> Iterator[LatencyValue]:
        """The values of all methods.

        Raises
        ------
        UnknownError : a maximum is negative or below a minimum, so that a response can come before its stimulus.
        """
        found = self._for_all_stimuli(list(self._values()))
        for minimum, maximum in _RANGES:
            lowest = max((value.value or 0 for value in found if value.quantity is minimum), default=0)
            highest = min((value.value or 0 for value in found if value.quantity is maximum), default=lowest)
            if not 0 <= lowest <= highest:
                raise UnknownError("a response of the chain can come before its stimulus, which is not evaluated")
        yield from found

    def _for_all_stimuli(self, found: Sequence[LatencyValue]) -> list[LatencyValue]:
        """The values, also for stimuli of which a counter of a trigger lets none have an effect: the next ones are answered first."""
        wait = self.parts[0][0].stimulus_wait
        if wait == 0:
            return list(found)
        kept = [
            value
            for value in found
            if not value.quantity.is_mean and value.quantity is not LatencyQuantity.MAX_REDUCED_REACTION_TIME
        ]
        if wait is None:
            return kept
        longer = in_picoseconds(wait, self.unit, is_upper=True)
        reduced = [value for value in found if value.quantity is LatencyQuantity.MAX_REDUCED_REACTION_TIME]
        return [*kept, *(replace(value, value=(value.value or 0) + longer, claim=Claim.BOUND) for value in reduced)]

    def _values(self) -> Iterator[LatencyValue]:
        is_answered_later = self._can_respond_before_stimulus()
        if not is_answered_later:
            yield from self._of_job_chains()
        tasks = [timed.task for part in self.parts for timed in part]
        yield from self._of_periods(tasks)
        if all(timed.is_logical for part in self.parts for timed in part):
            time = total(bounds.hamann(tasks)) + _wait_at_start(tasks)
            yield from self._reactions(time, tasks, "two periods for each step", bounds.HAMANN)
        if len(self.parts) == 1 and all(timed.is_visible_at_once for timed in self.parts[0]) and not is_answered_later:
            yield from self._of_releases(tasks)

    def _can_respond_before_stimulus(self) -> bool:
        """Whether the job that reads can have responded before the stimulus, so that only the response of a later job answers it.

        Bounds by periods cover that later job, those by the reads and writes of jobs do not.
        """
        if not self.parts[-1][-1].responds_before_read:
            return False
        earliest = self._job_chains(self.parts[0], pessimistic=False) if len(self.parts) == 1 else None
        if earliest is None:
            return True
        times = earliest.from_start(is_exact=True).first_to_first
        return not times.size or int(times.min()) < 0

    # By job chains

    def _of_job_chains(self) -> Iterator[LatencyValue]:
        found = [self._job_chains(part, pessimistic=True) for part in self.parts]
        if len(found) == 1 and found[0] is not None:
            yield from self._of_single_clock(found[0])
        elif None not in found:
            yield from self._summed([each for each in found if each is not None])

    def _of_single_clock(self, chains: JobChains) -> Iterator[LatencyValue]:
        is_exact = self._is_exact(chains)
        claim, method = (Claim.EXACT, EXACT) if is_exact else (Claim.BOUND, BOUNDED)

        def value(quantity: LatencyQuantity, time: Time | float) -> LatencyValue:
            upwards = quantity.is_upper
            whole = round(Fraction(time) / self.unit) if quantity.is_mean else in_picoseconds(int(time), self.unit, upwards)
            return LatencyValue(quantity=quantity, value=whole, claim=claim, method=method, source=job_chains.SOURCE)

        # Maxima and minima are those of all jobs from the start of the system on, means those of the jobs that repeat.
        every = chains.from_start(is_exact)
        yield value(LatencyQuantity.MAX_REACTION_TIME, every.reaction_time)
        yield value(LatencyQuantity.MAX_REDUCED_REACTION_TIME, int(every.first_to_first.max()))
        yield value(LatencyQuantity.MAX_DATA_AGE, every.data_age)
        yield value(LatencyQuantity.MAX_REDUCED_DATA_AGE, int(every.last_to_last.max()))
        if not is_exact:
            yield from self._minima(value)
            return
        yield value(LatencyQuantity.MAX_FIRST_TO_LAST, int(chains.inputs.first_to_last.max()))
        yield value(LatencyQuantity.MAX_LAST_TO_FIRST, int(chains.inputs.last_to_first.max()))
        yield value(LatencyQuantity.MIN_LAST_TO_FIRST, int(chains.inputs.last_to_first.min()))
        yield value(LatencyQuantity.MIN_FIRST_TO_FIRST, int(every.first_to_first.min()))
        yield value(LatencyQuantity.MIN_LAST_TO_LAST, int(every.last_to_last.min()))
        yield value(LatencyQuantity.MEAN_REACTION_TIME, chains.mean_reaction_time)
        yield value(LatencyQuantity.MEAN_FIRST_TO_FIRST, float(chains.first_to_first.mean()))
        yield value(LatencyQuantity.MEAN_LAST_TO_LAST, float(chains.last_to_last.mean()))

    def _is_exact(self, chains: JobChains) -> bool:
        """Whether jobs read and write at these times, and no order of two accesses at one instant changes anything."""
        part = self.parts[0]
        if not self.is_certain or not all(timed.is_exact for timed in part):
            return False
        if all(timed.is_visible_at_once for timed in part):
            return True
        others = self._job_chains(part, pessimistic=False)
        return others is not None and chains.has_times_of(others)

    def _minima(self, value: _Make) -> Iterator[LatencyValue]:
        """Lower bounds by latest reads and earliest writes."""
        chains = self._job_chains(self.parts[0], pessimistic=False)
        if chains is None:
            return
        every = chains.from_start(is_exact=True)
        for quantity, times in (
            (LatencyQuantity.MIN_FIRST_TO_FIRST, every.first_to_first),
            (LatencyQuantity.MIN_LAST_TO_LAST, every.last_to_last),
        ):
            # With a long time between reading and writing, no job of the cycle has to pass anything on.
            if times.size:
                yield value(quantity, max(0, int(times.min())))

    def _job_chains(self, part: Sequence[TimedStage], pessimistic: bool) -> JobChains | None:
        times = [timed.read_write for timed in part if timed.read_write is not None]
        chain = [each.pessimistic if pessimistic else each.optimistic for each in times]
        if len(times) < len(part) or not all(len(task.releases) for task in chain):
            return None
        return self.budget.build(chain, max(each.steady_state_start for each in times))

    def _summed(self, found: Sequence[JobChains]) -> Iterator[LatencyValue]:
        """The sum over controllers without a common clock (theorem 5.8 of RTAS 2021)."""
        every = [each.from_start(is_exact=False) for each in found]
        first, *others = every
        *before, last = every
        sums = {
            LatencyQuantity.MAX_REACTION_TIME: sum(each.reaction_time for each in every),
            LatencyQuantity.MAX_REDUCED_REACTION_TIME: int(first.first_to_first.max()) + sum(e.reaction_time for e in others),
            LatencyQuantity.MAX_DATA_AGE: sum(each.data_age for each in every),
            LatencyQuantity.MAX_REDUCED_DATA_AGE: sum(each.data_age for each in before) + int(last.last_to_last.max()),
        }
        for quantity, time in sums.items():
            yield self._bound(quantity, time, SUMMED, job_chains.SOURCE)

    # By periods and response times

    def _bound(self, quantity: LatencyQuantity, time: Time, method: str, source: str) -> LatencyValue:
        whole = in_picoseconds(int(time), self.unit, quantity.is_upper)
        return LatencyValue(quantity=quantity, value=whole, claim=Claim.BOUND, method=method, source=source)

    def _reactions(self, time: Time, tasks: Sequence[ChainTask], method: str, source: str) -> Iterator[LatencyValue]:
        """A bound of the reaction time, and the bounds of data age and reduced reaction time that follow from it."""
        first = tasks[0]
        yield self._bound(LatencyQuantity.MAX_REACTION_TIME, time, method, source)
        yield self._bound(
            LatencyQuantity.MAX_DATA_AGE, time, f"{method}; data age as reaction time", f"{source}; Günzel and others 2023"
        )
        yield self._bound(
            LatencyQuantity.MAX_REDUCED_REACTION_TIME, time - first.period, f"{method}, without the first period", source
        )

    def _of_periods(self, tasks: Sequence[ChainTask]) -> Iterator[LatencyValue]:
        """Bounds that need only maximum times between activations, and response times."""
        first, *others = tasks
        at_start = _wait_at_start(tasks)
        method = "sum of periods and response times"
        if all(task.is_regular for task in tasks):
            yield from self._reactions(total(bounds.davare(tasks)) + at_start, tasks, method, bounds.DAVARE)
        elif all(task.is_regular for task in others) and self.parts[0][0].is_certain:
            time = total(bounds.davare(tasks)) + at_start - first.period
            yield self._bound(
                LatencyQuantity.MAX_REDUCED_REACTION_TIME, time, f"{method}, without the first period", bounds.DAVARE
            )
        if not all(task.is_regular for task in tasks[:-1]):
            return
        if all(task.response <= task.period for task in tasks if task.is_regular):
            if tasks[-1].is_regular:
                yield from self._reactions(total(bounds.duerr(tasks)) + at_start, tasks, "sporadic chains", bounds.DUERR)
            time = total(bounds.duerr_data_age(tasks))
            yield self._bound(LatencyQuantity.MAX_REDUCED_DATA_AGE, time, "sporadic chains", bounds.DUERR)

    def _of_releases(self, tasks: Sequence[ChainTask]) -> Iterator[LatencyValue]:
        """Bounds for periodic tasks with known releases."""
        if any(task.offset is None or not task.is_regular or task.response > task.period for task in tasks):
            return
        reaction = bounds.kloda(tasks)
        if reaction is not None:
            # Otherwise the tasks would have been released in the whole periods before their first jobs.
            missing = sum(task.first_release // task.period * task.period for task in tasks[1:])
            yield from self._reactions(total(reaction) + missing, tasks, "next releases", bounds.KLODA)
        age = bounds.becker(tasks)
        if age is not None:
            yield self._bound(LatencyQuantity.MAX_REDUCED_DATA_AGE, total(age), "reachable jobs", bounds.BECKER)
        if bounds.on_grids(tasks):
            grid = total(bounds.bi(tasks))
            yield self._bound(LatencyQuantity.MAX_REDUCED_DATA_AGE, grid, "grid of releases", bounds.BI)


def _wait_at_start(tasks: Sequence[ChainTask]) -> Time:
    """How much longer than its period data can wait for each task of a chain, because its first job comes late."""
    return sum(max(0, task.first_release - task.period) for task in tasks[1:])


def in_picoseconds(value: Fraction | Time, unit: int, is_upper: bool) -> Time:
    """A time in whole picoseconds; upper bounds are rounded up, lower bounds down."""
    return -int(-value // unit) if is_upper else int(value // unit)
