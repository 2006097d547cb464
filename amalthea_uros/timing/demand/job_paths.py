"""What a job demands in the long run with all that it triggers, by the paths through its branches.

What a path triggers belongs to it: of branches that exclude each other, a job takes one, and only that one triggers. So the worst case
is the greatest sum of own and triggered demand over all paths, not the sum of the greatest ones.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import reduce
from operator import add
from types import MappingProxyType

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Activity, Call, Loop, ProbabilitySwitch, Switch, inner_activities
from amalthea_uros.perf.conditions import holds
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.jobs.counters import ALWAYS
from amalthea_uros.timing.jobs.executed import bounds_of, count_of
from amalthea_uros.timing.jobs.positions import ActivityPosition


@dataclass(frozen=True, slots=True)
class JobDemand:
    """Demand for each job of a process in the long run, on one core.

    Attributes
    ----------
    certain : the worst one, as far as it is certain that it can occur: modes may exclude the rest for ever
    """

    best: Fraction = Fraction(0)
    mean: Fraction = Fraction(0)
    worst: Fraction = Fraction(0)
    certain: Fraction = Fraction(0)

    @classmethod
    def of(cls, demand: MultiframeDemand) -> JobDemand:
        """That of jobs that trigger nothing."""
        return cls(demand.mean_best, demand.mean, demand.mean_worst, demand.mean_occurring)

    def __add__(self, other: JobDemand) -> JobDemand:
        """Both."""
        return JobDemand(self.best + other.best, self.mean + other.mean, self.worst + other.worst, self.certain + other.certain)

    def times(self, best: Fraction | int, mean: Fraction | int, worst: Fraction | int, certain: Fraction | int) -> JobDemand:
        """Each part multiplied by a number of times."""
        return JobDemand(self.best * best, self.mean * mean, self.worst * worst, self.certain * certain)

    def every(self, factor: Fraction | int) -> JobDemand:
        """All parts multiplied by a number of times."""
        return self.times(factor, factor, factor, factor)


NOTHING = JobDemand()


def most_in_a_job(
    positions: Sequence[ActivityPosition], triggered: Mapping[int, int], modes: Mapping[str, str] = MappingProxyType({})
) -> int:
    """The greatest sum of some whole numbers over all paths of a job.

    Parameters
    ----------
    triggered : the numbers, by those of the positions, in order
    """
    weights = {number: JobDemand(worst=Fraction(weight)) for number, weight in triggered.items()}
    return int(JobPaths(positions, weights, lambda _: NOTHING, modes).demand().worst)


def total(parts: Iterable[JobDemand]) -> JobDemand:
    """The sum."""
    return reduce(add, parts, NOTHING)


@dataclass(frozen=True, slots=True)
class JobPaths:
    """The paths of the jobs of a process.

    Attributes
    ----------
    positions : of all activities of the process, in order
    triggered : what the activity at a position triggers, by its number
    own : the demand of an activity itself, with all within it
    """

    positions: Sequence[ActivityPosition]
    triggered: Mapping[int, JobDemand]
    own: Callable[[Activity], JobDemand]
    modes: Mapping[str, str]

    def demand(self) -> JobDemand:
        """That of the activities of a job with all that they trigger."""
        return self._sum(self._from_to(1, len(self.positions)), ALWAYS)

    def _sum(self, numbers: Iterable[int], reached: Counter | None) -> JobDemand:
        return total(self._at(number, reached) for number in numbers)

    def _from_to(self, first: int, last: int) -> list[int]:
        """The numbers of the activities of a list, without those within them."""
        found = []
        while first <= last:
            found.append(first)
            first = self.positions[first - 1].last + 1
        return found

    def _at(self, number: int, reached: Counter | None) -> JobDemand:
        """The demand of an activity.

        Parameters
        ----------
        reached : in which jobs; None if that is unknown
        """
        position = self.positions[number - 1]
        if not self._is_triggering(number, position.last):
            return self.own(position.activity)
        inside = self._from_to(number + 1, position.last)
        here = self.triggered.get(number, NOTHING)
        match position.activity:
            case Call():
                within = here + self._sum(inside, position.counter)
                return _called(within, position, position.activity, reached, self.modes)
            case ProbabilitySwitch() as switch:
                weights = [Fraction(branch.weight) for branch in switch.branches]
                return here + _one_of(self._branches(switch, inside, reached), weights, is_chance=True)
            case Switch() as switch:
                return here + self._by_mode(switch, self._branches(switch, inside, reached))
            case Loop(condition=condition):
                # How often it is repeated is unknown; the demand of its process is unknown then.
                never = holds(condition, self.modes) is False
                return here if never else here + self._sum(inside, reached).times(0, 1, 1, 0)
        return here + (self._sum(inside, reached) if inside else self.own(position.activity))

    def _is_triggering(self, first: int, last: int) -> bool:
        numbers = list(self.triggered)
        index = bisect_left(numbers, first)
        return index < len(numbers) and numbers[index] <= last

    def _branches(self, switch: ProbabilitySwitch | Switch, inside: Sequence[int], reached: Counter | None) -> list[JobDemand]:
        """The demand of each branch."""
        found, start = [], 0
        for activities in inner_activities(switch):
            found.append(self._sum(inside[start : start + len(activities)], reached))
            start += len(activities)
        return found

    def _by_mode(self, switch: Switch, found: Sequence[JobDemand]) -> JobDemand:
        possible = []
        for case, demand in zip(switch.cases, found, strict=False):
            value = holds(case.condition, self.modes)
            if value is not False:
                possible.append(demand)
            if value:
                break
        else:
            possible.append(found[-1])
        return _one_of(possible, [Fraction(1)] * len(possible), is_chance=False)


def _called(
    found: JobDemand, position: ActivityPosition, call: Call, reached: Counter | None, modes: Mapping[str, str]
) -> JobDemand:
    """The demand of a call, given that of one execution of its runnable."""
    if call.times is not None:
        found = _repeated(found, call)
    if call.counter is not None:
        found = _counted(found, position, call.counter, reached)
    values = {holds(condition, modes) for condition in position.conditions}
    if False in values:
        return NOTHING
    return found.times(0, 1, 1, 0) if None in values else found


def _counted(found: JobDemand, position: ActivityPosition, counter: Counter, reached: Counter | None) -> JobDemand:
    """The demand of a call that takes effect every n-th time only."""
    if counter.prescaler < 1:
        return found.times(0, 1, 1, 0)
    share = Fraction(1, counter.prescaler)
    if position.counter is not None and reached is not None:
        share = Fraction(reached.prescaler, position.counter.prescaler)
        return found.times(0 if position.counter.jitter else share, share, share, share)
    if position.runnable is None:
        # Only the jobs of the process count.
        return found.every(share)
    # The executions by others, which count, too, can be those without effect.
    return found.times(0, share, 1, 0)


def _repeated(found: JobDemand, call: Call) -> JobDemand:
    try:
        _, average, _ = count_of(call.times)
    except UnknownError:
        return NOTHING
    least, most = bounds_of(call.times)
    # Without a maximum, the demand of the process is unknown.
    return found.times(least, average, least if most is None else most, least if most is None else most)


def _one_of(found: Sequence[JobDemand], weights: Sequence[Fraction], *, is_chance: bool) -> JobDemand:
    """One of several branches: by chance, each one with a weight is taken some time; modes may exclude all but one."""
    if not found:
        return NOTHING
    if not any(weights):
        weights = [Fraction(1)] * len(found)
    mean = sum((each.mean * weight for each, weight in zip(found, weights, strict=True)), Fraction(0)) / sum(weights)
    likely = [each.certain for each, weight in zip(found, weights, strict=True) if weight]
    return JobDemand(
        best=min(each.best for each in found),
        mean=mean,
        worst=max(each.worst for each in found),
        certain=max(likely) if is_chance else min(likely),
    )
