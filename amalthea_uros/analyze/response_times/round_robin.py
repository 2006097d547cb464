"""Response times of tasks of equal priority under round robin.

After R. Racu, L. Li, R. Henia, A. Hamann and R. Ernst, "Improved response time analysis of tasks scheduled under preemptive
round-robin", CODES+ISSS 2007: before each slice of a task, every other task of its priority gets at most one slice, and in total
no more than its demand. Three things are taken into account beyond that. A job need not go on in the slice of the job before it. The
others can have jobs pending when the task is activated, so that their demand is that of the busy window of all of them; each of these
jobs, as many as the activation limit allows, may wait for a slice of its own, since it is not standardised whether jobs or tasks take
turns. Neither is it whether a slice that was preempted starts anew, so that each preemption may prolong a slice of another task.

If only the slices are known, each task gets one in a cycle of all of them, and one that it leaves unused may be lost, as in time
division. Then the others are taken to use all of their slices, so that nothing else has to be known of them.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.fixed_priority import max_jobs, of_completions, unbounded
from amalthea_uros.analyze.response_times.kernel import MAX_STEPS
from amalthea_uros.analyze.response_times.task import FULL, AnalysedTask
from amalthea_uros.timing.basics.time_base import LIMIT, Ticks
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.event_models.models import PeriodicEvents
from amalthea_uros.timing.response import Response
from amalthea_uros.units import Time

METHOD = "busy window, round robin"
SLICES = "busy window, time slices"
SOURCE = "Racu, Li, Henia, Hamann, Ernst 2007"


def response_time(task: AnalysedTask, others: Sequence[AnalysedTask], higher: Interference, blocking: Time = 0) -> Response:
    """The response time of a task among others of its priority.

    Parameters
    ----------
    higher : tasks of higher priority
    """
    if _overloads(task, others, higher):
        return unbounded(task.demand.best, Interference.of([*higher.tasks, *others], higher.supply), task, METHOD, SOURCE)
    window = _Window.of(task, others, higher, blocking)
    completions: list[Time] = []
    end = 0
    # A window that ends with its first job is bounded, even if others need not end.
    for job in range(1, max_jobs(task) if window.is_bounded else 2):
        end = window.end(job, end)
        if end > LIMIT:
            break
        completions.append(end)
        if task.is_alone or end <= task.events.delta_min(job + 1):
            return of_completions(task, completions, blocking, METHOD, SOURCE)
    reason = "its busy window does not end: the tasks need all of the core"
    return Response(worst=None, best=task.demand.best, method=METHOD, source=SOURCE, reason=reason)


def in_slices(task: AnalysedTask, others: Sequence[AnalysedTask], higher: Interference, blocking: Time = 0) -> Response:
    """The response time if the others may use all of their slices, or leave them unused without anybody else using them."""
    if higher.tasks:
        reason = "what precedes it may take a part of its time slices"
        return Response(worst=None, best=task.demand.best, method=SLICES, source=SOURCE, reason=reason)
    response = response_time(task, [_with_all_slices(other) for other in others], higher, blocking)
    if response.worst is None:
        response = replace(response, is_overload=False, reason="the time slices of the others leave it too little time")
    return replace(response, method=SLICES)


def _with_all_slices(task: AnalysedTask) -> AnalysedTask:
    """A task that always has a job pending."""
    return replace(task, demand=MultiframeDemand.constant(Ticks(task.slice)), events=PeriodicEvents(task.slice))


def _overloads(task: AnalysedTask, others: Sequence[AnalysedTask], higher: Interference) -> bool:
    """Whether a task gets less than its demand; slices limit what other tasks of its priority take."""
    own = task.demand_rate
    between = sum((min(own * other.slice / task.slice, other.demand_rate) for other in others), own)
    return sum((each.demand_rate for each in higher.tasks), between) > higher.supply.rate


@dataclass(frozen=True, slots=True)
class _Window:
    """The busy window of a task.

    Attributes
    ----------
    demands : the demand of each other task in the busy window of all of them; None: that does not end
    pending : the maximum number of jobs of each other task that can wait at the same time
    """

    task: AnalysedTask
    others: Sequence[AnalysedTask]
    higher: Interference
    blocking: Time
    demands: Sequence[Time] | None
    pending: Sequence[int]

    @classmethod
    def of(cls, task: AnalysedTask, others: Sequence[AnalysedTask], higher: Interference, blocking: Time) -> _Window:
        """The busy window of a task, given that of all tasks of its priority."""
        together = Interference.of([*higher.tasks, *others], higher.supply)
        length = None
        if not together.overloads_with(task):
            length = Interference.of([*higher.tasks, *others, task], higher.supply).window(blocking, 1)
        pending = [other.activation_limit for other in others]
        if length is None:
            return cls(task, others, higher, blocking, None, pending)
        jobs = [other.events.eta_plus(length) for other in others]
        demands = [other.demand.max_demand(number) for other, number in zip(others, jobs, strict=True)]
        return cls(task, others, higher, blocking, demands, list(map(min, pending, jobs)))

    @property
    def is_bounded(self) -> bool:
        """Whether it ends for certain."""
        if self.demands is not None:
            return True
        if self.higher.supply is not FULL:
            return False
        task = self.task
        slices = [jobs * other.slice for other, jobs in zip(self.others, self.pending, strict=True)]
        per_job = task.demand.mean_worst + (task.demand.mean_worst + task.slice - 1) / task.slice * sum(slices)
        longest = max(other.slice for other in self.others)
        above = sum((other.demand_rate + other.events.rate * longest for other in self.higher.tasks), Fraction(0))
        return task.events.rate * per_job + above < 1

    def end(self, job: int, start: Time) -> Time:
        """The latest end of a job of the window, which is not before `start`; more than `LIMIT` if it does not end."""
        own = self.task.demand.max_demand(job)
        # At most so many slices: sum of ceil(c / slice) over the jobs.
        slices = (own + job * (self.task.slice - 1)) // self.task.slice
        end = start
        for _ in range(MAX_STEPS):
            between = self._between(slices, end)
            reached = None if between is None else self.higher.window(self.blocking + own + between, end)
            if reached is None:
                break
            if reached == end:
                return end
            end = reached
        return LIMIT + 1

    def _between(self, slices: int, window: Time) -> Time | None:
        """What the other tasks execute before the last slice of the task; None if nothing bounds it."""
        everything = None if self.demands is None else sum(self.demands)
        if self.higher.supply is not FULL:
            # The end of a budget interrupts a slice, too.
            return everything
        most = [slices * jobs * other.slice for other, jobs in zip(self.others, self.pending, strict=True)]
        if self.demands is not None:
            most = list(map(min, most, self.demands))
        preemptions = sum(task.events.eta_plus(window) for task in self.higher.tasks)
        prolonged = preemptions * max(other.slice for other in self.others)
        total = sum(most) + prolonged
        return total if everything is None else min(total, everything)
