"""The results of cores, processes and callbacks, and the metrics of their jobs."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.shown import Shown
from amalthea_uros.analyze.results.needs import ExecutionOnCores
from amalthea_uros.judge.evidence import Ends
from amalthea_uros.judge.limits import JudgedDeadline, SystemLimit
from amalthea_uros.judge.margins import margin_of
from amalthea_uros.judge.verdict import Failure, Judgement, Verdict
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.response import Claim, Response
from amalthea_uros.units import Frequency, Time, time_text


@dataclass(frozen=True, slots=True, kw_only=True)
class Metric:
    """A metric of all jobs, in picoseconds.

    Attributes
    ----------
    min, max : no job has less or more; None if there is no finite bound
    mean : in the long run; None if it depends on more than bounds of execution times
    attained : the least and the greatest value of which it is known that they occur; None if that is known of none
    least_jitter : a difference of two values of which it is known that they can occur in the same run
    """

    min: Time | None
    max: Time | None
    mean: Fraction | None = None
    attained: tuple[Time, Time] | None = None
    least_jitter: Time = 0

    @property
    def claim(self) -> Claim:
        """Exact if both minimum and maximum occur."""
        return Claim.EXACT if self.attained is not None and self.attained == (self.min, self.max) else Claim.BOUND

    @property
    def jitter(self) -> Time | None:
        """The difference between maximum and minimum."""
        return None if self.min is None or self.max is None else self.max - self.min


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessorResult(Shown):
    """A core: its clock, and its load in the best, mean and worst case (1 is full); None if it is unknown.

    Attributes
    ----------
    at_least : the part of the worst-case load that is certain: what is unknown and what modes may exclude are no part of it
    """

    name: str
    frequency: Frequency | None
    best: Fraction | None
    mean: Fraction | None
    worst: Fraction | None
    at_least: Fraction

    @property
    def is_overloaded(self) -> bool:
        """Whether more work is activated than the core can execute, whatever the unknown part of the load is."""
        return self.at_least > 1


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessResult(JudgedDeadline, Shown):
    """A task or interrupt service routine.

    Attributes
    ----------
    processor, priority, wcet : also shown if the response time is unknown, as far as the model states them
    least_wcet : an execution time that some job can take for certain; less than `wcet` if counters keep calls apart
    response : None if it is unknown, for the `reason`
    deadline : the stated one, or else the period; None for activations without a period
    is_implicit : whether the deadline is the period
    verdict : None if there is no deadline, and no activation is lost
    failure : what is wrong if the verdict is missed or unbounded
    reason : why something is unknown, or what is wrong
    min_interarrival, max_interarrival : time from one activation to the next; None if it is unknown
    metrics : from the schedule if it is known, otherwise bounds; metrics without any bound are absent
    share : of its core in the worst case, in the long run, 1 is full; None if its demand or its activations are unknown
    needs : what it needs on each kind of core, if it has no execution time because no single core with a known clock is stated
    """

    name: str
    is_isr: bool
    processor: str | None
    priority: int | None
    preemption: str
    bcet: Time | None
    acet: Fraction | None
    wcet: Time | None
    response: Response | None
    deadline: Time | None
    verdict: Verdict | None
    least_wcet: Time | None = None
    is_implicit: bool = False
    failure: Failure | None = None
    reason: str = ""
    min_interarrival: Time | None = None
    max_interarrival: Time | None = None
    metrics: Mapping[JobMetric, Metric] = field(default_factory=dict)
    share: Fraction | None = None
    needs: tuple[ExecutionOnCores, ...] = ()

    def __repr__(self) -> str:
        worst = "unknown" if self.response is None else bound_text(self.response.worst)
        verdict = f", {self.failure or self.verdict}" if self.verdict else ""
        return f"<ProcessResult {self.name}: response time {worst}, deadline {bound_text(self.deadline)}{verdict}>"

    @property
    def wcrt(self) -> Time | None:
        """The worst-case response time; None if it is unknown or has no finite bound."""
        return None if self.response is None else self.response.worst

    @property
    def bcrt(self) -> Time | None:
        """The best-case response time; None if it is unknown."""
        return None if self.response is None else self.response.best

    @property
    def worst_response(self) -> Ends:
        """Between which ends the worst-case response time lies: the longest job takes at least its execution time."""
        response = self.response
        if response is None:
            return Ends()
        if response.worst is not None and response.claim is Claim.EXACT:
            return Ends.exactly(response.worst)
        return Ends(max(response.best, self.least_wcet or 0), response.worst)

    # As a limit that was judged.

    @property
    def limit(self) -> Time | None:
        """The deadline."""
        return self.deadline

    @property
    def value(self) -> Time | None:
        """The worst-case response time."""
        return self.wcrt

    @property
    def margin(self) -> Time | None:
        """Distance of the worst-case response time from the deadline; negative if it is later."""
        return margin_of(self.wcrt, self.deadline, is_upper=True)

    @property
    def overloaded_core(self) -> str | None:
        """The core that has more work than it can execute, if that is what is wrong."""
        return self.processor if self.failure is Failure.OVERLOAD else None

    @property
    def stated(self) -> None:
        """The deadline follows from the process itself."""
        return


@dataclass(frozen=True, slots=True, kw_only=True)
class CallbackResult(Shown):
    """A callback that a process calls, or another runnable with a requirement.

    Attributes
    ----------
    response : from the activation of the job to the end of the call, in the jobs that call it; None if it is unknown, for the `reason`
    deadline : the limit of its response time, or else the minimum time between two calls; None if it is unknown
    metrics : as far as they are known
    """

    name: str
    process: str
    response: Response | None
    deadline: Time | None
    reason: str = ""
    metrics: Mapping[JobMetric, Metric] = field(default_factory=dict)


def bound_text(value: Time | None) -> str:
    """A time for people; "unknown" if there is none."""
    return "unknown" if value is None else time_text(value)


@dataclass(frozen=True, slots=True, kw_only=True)
class RequirementResult(Shown):
    """The verdict on a requirement or a constraint; the margin is not negative if it is met.

    Attributes
    ----------
    limit : None if it is not a limit of a time
    lower, upper : between these the limited maximum or minimum lies; equal if it is exact, None if that end is unknown
    spread : minimum and maximum, of which a jitter is the difference; None for what is no such jitter, or unknown
    reason : why the verdict is unknown
    stated : the limit in the system
    """

    name: str
    object: str
    quantity: str
    is_upper: bool
    limit: Time | None
    verdict: Verdict
    lower: Time | None = None
    upper: Time | None = None
    spread: tuple[Time, Time] | None = None
    reason: str = ""
    stated: SystemLimit | None = field(default=None, repr=False, compare=False)

    @classmethod
    def of(cls, limit: SystemLimit, found: Judgement) -> RequirementResult:
        """The result for a limit that was judged."""
        return cls(
            name=limit.name,
            object=limit.object,
            quantity=limit.quantity,
            is_upper=limit.is_upper,
            limit=limit.time,
            lower=found.ends.lower,
            upper=found.ends.upper,
            spread=found.spread,
            verdict=found.verdict,
            reason=found.reason,
            stated=limit,
        )

    @property
    def value(self) -> Time | None:
        """The safe end: an upper bound of a maximum, a lower bound of a minimum."""
        return self.upper if self.is_upper else self.lower

    @property
    def margin(self) -> Time | None:
        """Distance of the value from the limit; negative if the limit is missed."""
        return margin_of(self.value, self.limit, self.is_upper)

    @property
    def overloaded_core(self) -> None:
        """That of a process."""
        return
