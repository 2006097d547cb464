"""The values of a chain by each method that is valid for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros.analyze.chains import job_chains
from amalthea_uros.analyze.chains.bounds import becker, bi, davare, duerr, hamann, kloda
from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.analyze.chains.read_write_times import in_picoseconds
from amalthea_uros.analyze.chains.timed_stage import TimedStage
from amalthea_uros.analyze.results import Claim, Quantity, Value
from amalthea_uros.units import Time

_Make = Callable[[Quantity, "Time | float"], Value]

if TYPE_CHECKING:
    from amalthea_uros.analyze.chains.job_chains import JobChains

EXACT = "job chains over the hyperperiod"
BOUNDED = "job chains with earliest reads and latest writes"
SUMMED = "sum over controllers whose clocks are not synchronized"


@dataclass(frozen=True, slots=True)
class Methods:
    """The groups of stages of a route, by the controllers on which they are.

    Attributes
    ----------
    parts : the groups of each controller, in order
    unit : parts of a picosecond in which everything is counted
    is_certain : whether it is known what carries the effect, and when
    """

    parts: Sequence[Sequence[TimedStage]]
    unit: int
    is_certain: bool

    @property
    def why(self) -> str:
        """Why the tightest values are what they are."""
        everything = [timed for part in self.parts for timed in part]
        reason = next((timed.reason for timed in everything if timed.reason), "")
        if reason:
            return f"bounds: {reason}"
        if len(self.parts) > 1:
            return "bounds: the clocks of the controllers are not synchronized"
        if not self.is_certain:
            return "bounds: nothing carries the effect at some point"
        varying = next((timed.step.name for timed in everything if not timed.is_exact), None)
        if varying is not None:
            return f"bounds: execution times around {varying!r} vary, or it is not certain when it is served"
        return "exact: all releases are known, and execution times are constant or do not matter"

    @property
    def why_unbounded(self) -> str:
        """Why there is no bound of the reaction time; "" if there is one."""
        irregular = next((timed.step.name for part in self.parts for timed in part if not timed.step.is_regular), None)
        return f"nothing says how long {irregular!r} may stay away" if irregular is not None else ""

    def values(self) -> Iterator[Value]:
        """All of them."""
        yield from self._followed()
        steps = [timed.step for part in self.parts for timed in part]
        yield from self._of_periods(steps)
        if all(timed.is_logical for part in self.parts for timed in part):
            time = hamann.reaction_time(steps)
            yield from self._reactions(time, steps[0], "two periods for each step", hamann.SOURCE)
        if len(self.parts) == 1:
            yield from self._of_releases(steps)

    # By jobs

    def _followed(self) -> Iterator[Value]:
        found = [_follow(part, pessimistic=True) for part in self.parts]
        if len(found) == 1 and found[0] is not None:
            yield from self._of_jobs(found[0])
        elif None not in found:
            yield from self._summed([each for each in found if each is not None])

    def _of_jobs(self, followed: JobChains) -> Iterator[Value]:
        is_exact = self.is_certain and all(timed.is_exact for timed in self.parts[0])
        claim, method = (Claim.EXACT, EXACT) if is_exact else (Claim.BOUND, BOUNDED)

        def value(quantity: Quantity, time: Time | float) -> Value:
            exactly = Fraction(time) / self.unit
            whole = round(exactly) if quantity.is_mean else in_picoseconds(exactly, 1, quantity.is_upper)
            return Value(quantity=quantity, value=whole, claim=claim, method=method, source=job_chains.SOURCE)

        yield value(Quantity.MAX_REACTION_TIME, followed.reaction_time)
        yield value(Quantity.MAX_REDUCED_REACTION_TIME, int(followed.first_to_first.max()))
        yield value(Quantity.MAX_DATA_AGE, followed.data_age)
        yield value(Quantity.MAX_REDUCED_DATA_AGE, int(followed.last_to_last.max()))
        if not is_exact:
            yield from self._least(value)
            return
        yield value(Quantity.MAX_FIRST_TO_LAST, int(followed.inputs.first_to_last.max()))
        yield value(Quantity.MAX_LAST_TO_FIRST, int(followed.inputs.last_to_first.max()))
        yield value(Quantity.MIN_LAST_TO_FIRST, int(followed.inputs.last_to_first.min()))
        yield value(Quantity.MIN_FIRST_TO_FIRST, int(followed.first_to_first.min()))
        yield value(Quantity.MIN_LAST_TO_LAST, int(followed.last_to_last.min()))
        yield value(Quantity.MEAN_REACTION_TIME, followed.mean_reaction_time)
        yield value(Quantity.MEAN_FIRST_TO_FIRST, float(followed.first_to_first.mean()))
        yield value(Quantity.MEAN_LAST_TO_LAST, float(followed.last_to_last.mean()))

    def _least(self, value: _Make) -> Iterator[Value]:
        """Nothing is faster than the latest reads of the earliest writes."""
        followed = _follow(self.parts[0], pessimistic=False)
        if followed is not None:
            yield value(Quantity.MIN_FIRST_TO_FIRST, max(0, int(followed.first_to_first.min())))
            yield value(Quantity.MIN_LAST_TO_LAST, max(0, int(followed.last_to_last.min())))

    def _summed(self, found: Sequence[JobChains]) -> Iterator[Value]:
        """On the way to another clock anything may wait as long as on its own controller (theorem 5.8 of RTAS 2021)."""
        first, *others = found
        *before, last = found
        sums = {
            Quantity.MAX_REACTION_TIME: sum(each.reaction_time for each in found),
            Quantity.MAX_REDUCED_REACTION_TIME: int(first.first_to_first.max()) + sum(e.reaction_time for e in others),
            Quantity.MAX_DATA_AGE: sum(each.data_age for each in found),
            Quantity.MAX_REDUCED_DATA_AGE: sum(each.data_age for each in before) + int(last.last_to_last.max()),
        }
        for quantity, time in sums.items():
            yield self._bound(quantity, time, SUMMED, job_chains.SOURCE)

    # By periods and response times

    def _bound(self, quantity: Quantity, time: Time, method: str, source: str) -> Value:
        whole = in_picoseconds(time, self.unit, quantity.is_upper)
        return Value(quantity=quantity, value=whole, claim=Claim.BOUND, method=method, source=source)

    def _reactions(self, time: Time, first: ChainTask, method: str, source: str) -> Iterator[Value]:
        """A bound of the reaction time, and what follows from it: the data age is the same, and without the first wait."""
        yield self._bound(Quantity.MAX_REACTION_TIME, time, method, source)
        yield self._bound(
            Quantity.MAX_DATA_AGE, time, f"{method}; data age as reaction time", f"{source}; Günzel and others 2023"
        )
        yield self._bound(
            Quantity.MAX_REDUCED_REACTION_TIME, time - first.period, f"{method}, without the first period", source
        )

    def _of_periods(self, steps: Sequence[ChainTask]) -> Iterator[Value]:
        """Bounds that need no more than how often each step comes at least."""
        first, *others = steps
        method = "sum of periods and response times"
        if all(step.is_regular for step in steps):
            yield from self._reactions(davare.reaction_time(steps), first, method, davare.SOURCE)
        elif all(step.is_regular for step in others):
            time = davare.reaction_time(steps) - first.period
            yield self._bound(Quantity.MAX_REDUCED_REACTION_TIME, time, f"{method}, without the first period", davare.SOURCE)
        if not all(step.is_regular for step in steps[:-1]):
            return
        if all(step.response <= step.period for step in steps if step.is_regular):
            if steps[-1].is_regular:
                yield from self._reactions(duerr.reaction_time(steps), first, "sporadic chains", duerr.SOURCE)
            time = duerr.reduced_data_age(steps)
            yield self._bound(Quantity.MAX_REDUCED_DATA_AGE, time, "sporadic chains", duerr.SOURCE)

    def _of_releases(self, steps: Sequence[ChainTask]) -> Iterator[Value]:
        """Bounds for periodic tasks whose releases are known."""
        if any(step.offset is None or not step.is_regular or step.response > step.period for step in steps):
            return
        reaction = kloda.reaction_time(steps)
        if reaction is not None:
            yield from self._reactions(reaction, steps[0], "next releases", kloda.SOURCE)
        age = becker.reduced_data_age(steps)
        if age is not None:
            yield self._bound(Quantity.MAX_REDUCED_DATA_AGE, age, "reachable jobs", becker.SOURCE)
        if len({step.offset for step in steps}) == 1:
            age = bi.reduced_data_age(steps)
            yield self._bound(Quantity.MAX_REDUCED_DATA_AGE, age, "grid of releases", bi.SOURCE)


def _follow(part: Sequence[TimedStage], pessimistic: bool) -> JobChains | None:
    known = [timed.tracks for timed in part if timed.tracks is not None]
    tracks = [each.pessimistic if pessimistic else each.optimistic for each in known]
    if len(known) < len(part) or not all(len(track.releases) for track in tracks):
        return None
    return job_chains.build_job_chains(tracks, max(each.steady_state_start for each in known))
