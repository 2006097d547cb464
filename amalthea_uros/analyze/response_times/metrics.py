"""The metrics of the jobs of processes: from the schedule of the core if it is known, otherwise bounds by the response times.

All metrics are differences of two times of a job that can only increase when execution times increase: with fixed releases and
without blocking, a job neither starts nor ends earlier because something executes for longer, nor does it wait for less time. The
schedules of all best and of all worst cases therefore bound both times, and with them the difference; what occurs in one of the two
schedules is attained. With constant execution times both schedules are the same, and everything is exact.

Minima and maxima count all jobs, also those before the schedule repeats. Means are those of a hyperperiod after that: the limits of the
means of ever longer runs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from operator import mul
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from amalthea_uros._internal.lazy_mapping import LazyMapping
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.core_schedule import CoreSchedule
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.analyze.results.processes import Metric, ProcessResult
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.response import Claim
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers

#: Times of all jobs in the schedule of all best cases, and in that of all worst cases.
Both: TypeAlias = tuple["Numbers", "Numbers"]

_ZERO = Metric(min=0, max=0, mean=Fraction(0), attained=(0, 0))


@dataclass(frozen=True, slots=True)
class JobInterval:
    """A time from one point to another in the jobs of a task, in the schedules of all best and of all worst cases.

    Attributes
    ----------
    starts, ends : (best, worst)
    least : it is never less
    """

    starts: Both
    ends: Both
    least: Numbers | None = None

    @property
    def lower(self) -> Numbers:
        """A lower bound for each job."""
        found: Numbers = self.ends[0] - self.starts[1]
        return found if self.least is None else np.maximum(found, self.least)

    @property
    def upper(self) -> Numbers:
        """An upper bound for each job."""
        return self.ends[1] - self.starts[0]

    @property
    def attained(self) -> Numbers:
        """Values that occur."""
        return np.concatenate([end - start for start, end in zip(self.starts, self.ends, strict=True)])

    def metric(self, repeating: int, time_base: int, is_attained: bool, can_settle: bool = False) -> Metric:
        """The metric of all jobs, in picoseconds: lower bounds are rounded down, upper bounds up.

        Parameters
        ----------
        repeating : number of the last jobs that repeat
        is_attained : whether all tasks can have their best cases together, and their worst cases
        can_settle : whether all worst cases after all best cases lead to the jobs that repeat
        """
        lower, upper, attained = self.lower, self.upper, self.attained
        mean = None
        if (lower[-repeating:] == upper[-repeating:]).all():
            # Python integers, because the sum can exceed 64 bits.
            mean = Fraction(sum(upper[-repeating:].tolist()), repeating * time_base)
        return Metric(
            min=int(lower.min()) // time_base,
            max=-(-int(upper.max()) // time_base),
            mean=mean,
            attained=(int(attained.min()) // time_base, -(-int(attained.max()) // time_base)) if is_attained else None,
            least_jitter=self._least_jitter(repeating, can_settle) // time_base if is_attained else 0,
        )

    def _least_jitter(self, repeating: int, can_settle: bool) -> int:
        """A difference that occurs for certain: in one of the schedules, or from all best cases to the repeated worst ones."""
        best, worst = (end - start for start, end in zip(self.starts, self.ends, strict=True))
        differences = [int(np.ptp(best)), int(np.ptp(worst))]
        if can_settle:
            differences.append(int(worst[-repeating:].max()) - int(best.min()))
        return max(differences)


@dataclass(slots=True)
class MetricEvaluator:
    """Finds the metrics of processes."""

    solution: Solution

    def of(self, process: ProcessResult) -> dict[JobMetric, Metric]:
        """The metrics of a process."""
        core = process.processor
        found = None if core is None else self.solution.schedule(core)
        if core is None or found is None or process.name not in found.tasks or self.solution.depends_on_losses(process.name):
            metrics = dict(self._bounds(process))
        else:
            metrics = _by_schedule(process, found, self.solution.context.time_base(process.name))
        return metrics | dict(_by_deadline(process, metrics.get(JobMetric.RESPONSE_TIME)))

    def lazily(self, process: ProcessResult) -> Mapping[JobMetric, Metric]:
        """The metrics of a process, computed when somebody looks at them."""
        return LazyMapping(lambda: self.of(process))

    def _waits(self, name: str) -> bool:
        """Whether a job can wait once it executes; under a priority ceiling it does not wait for a semaphore."""
        context = self.solution.context
        if name in context.waiting:
            return True
        semaphores = context.touching.protection[name].semaphores
        is_scheduled = name in context.scheduled and self.solution.is_analysable(name)
        return bool(semaphores & context.open_semaphores if is_scheduled else semaphores)

    def _bounds(self, process: ProcessResult) -> Iterator[tuple[JobMetric, Metric]]:
        """Bounds by execution times, response times and activations."""
        response, bcet = process.response, process.bcet
        if bcet is None:
            return
        # The net execution time includes waiting for semaphores, and polling for events.
        longest = process.wcet if not self._waits(process.name) else response.worst if response is not None else None
        yield JobMetric.NET_EXECUTION_TIME, Metric(min=bcet, max=longest)
        if process.min_interarrival is not None and process.name not in self.solution.losing:
            # Activations can be lost if it is unknown how long jobs are pending.
            longest_gap = None if response is None or response.worst is None else process.max_interarrival
            yield JobMetric.ACTIVATE_TO_ACTIVATE, Metric(min=process.min_interarrival, max=longest_gap)
        if response is None:
            return
        best, worst = response.best, response.worst
        if worst is None:
            yield JobMetric.RESPONSE_TIME, Metric(min=best, max=None)
            return
        is_exact = response.claim is Claim.EXACT and not self.solution.depends_on_losses(process.name)
        yield JobMetric.RESPONSE_TIME, Metric(min=best, max=worst, attained=(best, worst) if is_exact else None)
        # A job also executes for at least its best case, so that it cannot wait for longer than the rest of the response time.
        waiting = worst - bcet
        yield JobMetric.GROSS_EXECUTION_TIME, Metric(min=bcet, max=worst)
        for metric in (JobMetric.INITIAL_PENDING_TIME, JobMetric.READY_TIME, JobMetric.PREEMPTION_TIME):
            yield metric, Metric(min=0, max=waiting)
        yield JobMetric.WAITING_TIME, Metric(min=0, max=waiting) if self._waits(process.name) else _ZERO
        if process.name not in self.solution.losing:
            yield from _between_jobs(process, waiting, best, worst)


def _by_deadline(process: ProcessResult, response: Metric | None) -> Iterator[tuple[JobMetric, Metric]]:
    """The metrics that compare the response time with the deadline; for slack, by default the minimum time to the next activation."""
    if response is None or response.max is None or response.min is None:
        return
    mean, attained, deadline = response.mean, response.attained, process.deadline
    due = deadline if deadline is not None else process.min_interarrival
    if due is not None:
        yield (
            JobMetric.SLACK_TIME,
            Metric(
                min=due - response.max,
                max=due - response.min,
                mean=None if mean is None else due - mean,
                attained=None if attained is None else (due - attained[1], due - attained[0]),
                least_jitter=response.least_jitter,
            ),
        )
    if deadline is not None and not process.is_implicit:
        yield (
            JobMetric.LATENESS,
            Metric(
                min=response.min - deadline,
                max=response.max - deadline,
                mean=None if mean is None else mean - deadline,
                attained=None if attained is None else (attained[0] - deadline, attained[1] - deadline),
                least_jitter=response.least_jitter,
            ),
        )


def _between_jobs(process: ProcessResult, waiting: Time, best: Time, worst: Time) -> Iterator[tuple[JobMetric, Metric]]:
    """Times from one job to the next: the time between their activations, and the variation of their starts and ends."""
    shortest, longest = process.min_interarrival, process.max_interarrival
    if shortest is None:
        return
    variations = {
        JobMetric.START_TO_START: (max(0, shortest - waiting), waiting),
        JobMetric.END_TO_END: (max(0, shortest - (worst - best)), worst - best),
        JobMetric.END_TO_START: (shortest - worst, waiting - best),
    }
    for metric, (minimum, variation) in variations.items():
        yield metric, Metric(min=minimum, max=None if longest is None else longest + variation)


def _by_schedule(process: ProcessResult, found: CoreSchedule, time_base: int) -> dict[JobMetric, Metric]:
    """The metrics of a process by the schedules of its core."""
    period = found.tasks[process.name].period
    is_attained = process.response is not None and process.response.claim is Claim.EXACT
    spans = _spans(process.name, found)
    repeating = found.cycle // period
    settles = found.has_idle_time
    metrics = {name: span.metric(repeating, time_base, is_attained, settles) for name, span in spans.items()}
    means = _means(metrics, process, Fraction(period, time_base))
    return {
        name: metric if metric.mean is not None else replace(metric, mean=means.get(name)) for name, metric in metrics.items()
    }


def _means(metrics: Mapping[JobMetric, Metric], process: ProcessResult, period: Fraction) -> dict[JobMetric, Fraction]:
    """Means that follow from other means where execution times vary."""
    # The times between jobs add up to those between activations.
    means = dict.fromkeys((JobMetric.START_TO_START, JobMetric.END_TO_END), period)
    if process.acet is None:
        return means
    means[JobMetric.NET_EXECUTION_TIME] = process.acet
    preempted, pending = metrics[JobMetric.PREEMPTION_TIME].mean, metrics[JobMetric.INITIAL_PENDING_TIME].mean
    if preempted is None:
        return means
    means[JobMetric.RESPONSE_TIME] = response = preempted + process.acet
    if pending is not None:
        means[JobMetric.GROSS_EXECUTION_TIME] = response - pending
        means[JobMetric.END_TO_START] = period - (response - pending)
    return means


def _spans(name: str, found: CoreSchedule) -> dict[JobMetric, JobInterval]:
    """The metrics of the jobs of a process as times between two points."""
    jobs, task = (found.best[name], found.worst[name]), found.tasks[name]
    repeating = found.cycle // task.period

    def following(times: Both) -> Both:
        """The times of the next jobs; the schedule repeats after its last job."""
        return both(np.append(each[1:], each[-repeating] + found.cycle) for each in times)

    releases, begins, ends = (both(getattr(each, name) for each in jobs) for name in ("releases", "begins", "ends"))
    net = both(
        schedule.demands_of_jobs(task.demand, len(each.releases), demand_of)
        for each, demand_of in zip(jobs, (MultiframeDemand.best_of, MultiframeDemand.worst_of), strict=True)
    )
    idle = both(end - own for end, own in zip(ends, net, strict=True))
    nothing = both(np.zeros_like(each) for each in net)
    shortest = net[0]
    return {
        JobMetric.NET_EXECUTION_TIME: JobInterval(nothing, net),
        JobMetric.GROSS_EXECUTION_TIME: JobInterval(begins, ends, shortest),
        JobMetric.RESPONSE_TIME: JobInterval(releases, ends),
        JobMetric.INITIAL_PENDING_TIME: JobInterval(releases, begins),
        JobMetric.READY_TIME: JobInterval(begins, idle, nothing[0]),
        JobMetric.PREEMPTION_TIME: JobInterval(releases, idle),
        JobMetric.WAITING_TIME: JobInterval(nothing, nothing),
        JobMetric.ACTIVATE_TO_ACTIVATE: JobInterval(releases, following(releases)),
        JobMetric.START_TO_START: JobInterval(begins, following(begins), shortest),
        JobMetric.END_TO_END: JobInterval(ends, following(ends), np.append(shortest[1:], shortest[-repeating])),
        JobMetric.END_TO_START: JobInterval(ends, following(begins), nothing[0]),
    }


def both(times: Iterable[Numbers]) -> Both:
    """The times in both schedules."""
    best, worst = times
    return best, worst


def merged(variants: Sequence[Mapping[JobMetric, Metric]], counts: Sequence[int] | None = None) -> dict[JobMetric, Metric]:
    """The metrics of a process over several phases, any of which can be the one of the system; means are means over all phases.

    Parameters
    ----------
    counts : how many phases each of the variants stands for; None: one
    """
    if len(variants) == 1:
        return dict(variants[0])
    shared = [name for name in variants[0] if all(name in metrics for metrics in variants)]
    return {name: _merged([metrics[name] for metrics in variants], counts or [1] * len(variants)) for name in shared}


def _merged(metrics: Sequence[Metric], counts: Sequence[int]) -> Metric:
    minima, maxima, means = ([getattr(metric, name) for metric in metrics] for name in ("min", "max", "mean"))
    attained = [metric.attained for metric in metrics if metric.attained is not None]
    return Metric(
        min=None if None in minima else min(minima),
        max=None if None in maxima else max(maxima),
        mean=None if None in means else sum(map(mul, means, counts), Fraction(0)) / sum(counts),
        attained=(min(low for low, _ in attained), max(high for _, high in attained)) if attained else None,
        least_jitter=max(metric.least_jitter for metric in metrics),
    )
