"""What was observed in one run of cores, processes, chains, runnables, labels and requirements.

Values are exact: picoseconds as fractions, because a clock tick need not be a whole number of them. Reports and tables round them
to the nearest picosecond.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from amalthea_uros._internal.by_name import Results
from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.shown import Shown
from amalthea_uros.judge.limits import JudgedDeadline
from amalthea_uros.judge.margins import margin_of
from amalthea_uros.judge.verdict import ObservedLimit, ObservedVerdict
from amalthea_uros.perf.executors import HandleKind
from amalthea_uros.timing.basics.quantities import ChainQuantity, JobMetric
from amalthea_uros.units import Time

#: The metrics of processes of which histograms are kept; of chains, all quantities have one.
WITH_HISTOGRAM = (JobMetric.NET_EXECUTION_TIME, JobMetric.RESPONSE_TIME)


@dataclass(frozen=True, slots=True, kw_only=True)
class ObservedOccurrence:
    """Where something was observed.

    Attributes
    ----------
    instance : number of the job or of the stimulus, from 0
    time : of the activation of the job, or of the stimulus; picoseconds from the start of the run
    """

    instance: int
    time: Fraction


@dataclass(frozen=True, slots=True, kw_only=True)
class TimeHistogram:
    """Numbers of values in bins of equal width, in picoseconds; a value at an edge is in the bin that starts there."""

    start: Fraction
    width: Fraction
    counts: tuple[int, ...]

    @property
    def edges(self) -> tuple[Fraction, ...]:
        """The edges of the bins, one more than there are bins."""
        return tuple(self.start + number * self.width for number in range(len(self.counts) + 1))


@dataclass(frozen=True, slots=True, kw_only=True)
class MetricObservation:
    """The values of a time in a run, in picoseconds.

    Attributes
    ----------
    count : number of values, at least 1
    std : standard deviation of these values (divided by n, not n - 1), in floating point
    at_min, at_max : the first occurrences of minimum and maximum
    histogram : None for times of which none is kept
    """

    count: int
    min: Fraction
    mean: Fraction
    max: Fraction
    std: float
    at_min: ObservedOccurrence
    at_max: ObservedOccurrence
    histogram: TimeHistogram | None = field(default=None, repr=False)

    @property
    def jitter(self) -> Fraction:
        """The difference between maximum and minimum."""
        return self.max - self.min

    @property
    def total(self) -> Fraction:
        """The sum of all values."""
        return self.mean * self.count

    def beyond(self, limit: Time) -> MetricObservation:
        """By how much the values exceed a limit; negative if they do not."""
        return MetricObservation(
            count=self.count,
            min=self.min - limit,
            mean=self.mean - limit,
            max=self.max - limit,
            std=self.std,
            at_min=self.at_min,
            at_max=self.at_max,
        )

    def up_to(self, limit: Time) -> MetricObservation:
        """What is left up to a limit; negative if the values exceed it."""
        return MetricObservation(
            count=self.count,
            min=limit - self.max,
            mean=limit - self.mean,
            max=limit - self.min,
            std=self.std,
            at_min=self.at_max,
            at_max=self.at_min,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class CountObservation:
    """How often something happened to the jobs of a process: to all of them, and at least and at most to one of them."""

    total: int
    min: int
    max: int


@dataclass(frozen=True, slots=True, kw_only=True)
class CoreObservation(Shown):
    """A core.

    Attributes
    ----------
    load : the part of the duration in which it executed something or polled, from 0 to 1
    """

    name: str
    load: Fraction


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessObservation(JudgedDeadline, Shown):
    """A task or interrupt service routine.

    Attributes
    ----------
    core : None if it can run on several ones
    priority : None if it is unknown, or has no meaning for the scheduler
    jobs : number of jobs that ended
    load : the part of the duration in which it executed or polled, from 0 to 1
    metrics : of the jobs that ended; those without any value are absent
    lost_activations : beyond the activation limit
    unfinished : number of jobs that had not ended at the end of the run
    longest_unfinished : time from the activation of the first of them to the end of the run
    deadline : the stated one, or else the period; None for activations without a period
    is_implicit : whether the deadline is the period
    verdict : None if there is no deadline, and no activation was lost
    reason : what is wrong, or why nothing was observed
    """

    name: str
    is_isr: bool
    core: str | None
    priority: int | None
    jobs: int
    load: Fraction
    metrics: Mapping[JobMetric, MetricObservation] = field(repr=False)
    preemptions: CountObservation
    migrations: CountObservation
    lost_activations: int = 0
    unfinished: int = 0
    longest_unfinished: Fraction = Fraction(0)
    deadline: Time | None = None
    is_implicit: bool = False
    verdict: ObservedVerdict | None = None
    reason: str = ""

    @property
    def response_time(self) -> MetricObservation | None:
        """The response time; None if no job ended."""
        return self.metrics.get(JobMetric.RESPONSE_TIME)

    @property
    def is_time(self) -> bool:
        """Whether the margin is a time, as that of a requirement can be."""
        return True

    # As a limit that was judged.

    @property
    def limit(self) -> Fraction | None:
        """The deadline."""
        return None if self.deadline is None else Fraction(self.deadline)

    @property
    def value(self) -> Fraction | None:
        """The longest response time."""
        return None if self.response_time is None else self.response_time.max

    @property
    def margin(self) -> Fraction | None:
        """Distance of the longest response time from the deadline; negative if it is later."""
        return margin_of(self.value, self.limit, is_upper=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class RouteObservation:
    """A path through a chain.

    Attributes
    ----------
    text : the events and the links between them
    quantities : those without any value are absent
    stimuli, responses : numbers of occurrences
    unanswered : number of stimuli to which there was no response up to the end of the run
    longest_unanswered : time from the first of them to the end of the run, or less if it is too long ago
    not_evaluated : number of stimuli and responses too far apart to be kept: values of them are missing
    """

    text: str
    quantities: Mapping[ChainQuantity, MetricObservation] = field(repr=False)
    stimuli: int
    responses: int
    unanswered: int = 0
    longest_unanswered: Fraction = Fraction(0)
    not_evaluated: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainObservation(Shown):
    """A chain.

    Attributes
    ----------
    quantities : over all values of all routes, so that the worst route counts; those without any value are absent
    routes : the paths through the chain
    reason : why something was not observed
    """

    name: str
    quantities: Mapping[ChainQuantity, MetricObservation] = field(repr=False)
    routes: tuple[RouteObservation, ...]
    reason: str = ""

    @property
    def observations(self) -> int:
        """The number of stimuli to which there was a response, on all routes."""
        found = self.quantities.get(ChainQuantity.REDUCED_REACTION_TIME)
        return 0 if found is None else found.count

    @property
    def unanswered(self) -> int:
        """The number of stimuli to which there was no response up to the end of the run, on all routes."""
        return sum(route.unanswered for route in self.routes)

    @property
    def longest_unanswered(self) -> Fraction:
        """The longest time for which a stimulus had been without a response at the end of the run."""
        return max((route.longest_unanswered for route in self.routes), default=Fraction(0))

    @property
    def not_evaluated(self) -> int:
        """The number of stimuli and responses of which values are missing, on all routes."""
        return sum(route.not_evaluated for route in self.routes)


@dataclass(frozen=True, slots=True, kw_only=True)
class RunnableObservation(Shown):
    """A runnable that a requirement limits, in all processes that call it.

    Attributes
    ----------
    executions : number of executions that ended
    metrics : of each execution, from its start to its end; response time and initial pending time begin at the activation of the job
    """

    name: str
    executions: int
    metrics: Mapping[JobMetric, MetricObservation] = field(repr=False)
    preemptions: CountObservation
    migrations: CountObservation


@dataclass(frozen=True, slots=True, kw_only=True)
class HandleObservation(Shown):
    """A handle of an executor that loops.

    Attributes
    ----------
    runnable : the callback
    calls : number of calls that ended, for a message or when a timer was due
    metrics : of each of them; activated when the message had arrived, or when the timer was due
    lost : messages that were overwritten or dropped, or periods of a timer that were left out
    """

    name: str
    kind: HandleKind
    runnable: str
    calls: int
    metrics: Mapping[JobMetric, MetricObservation] = field(repr=False)
    preemptions: CountObservation
    migrations: CountObservation
    lost: int = 0

    @property
    def response_time(self) -> MetricObservation | None:
        """From when a message has arrived, or a timer is due, to the end of the callback; None if no call ended."""
        return self.metrics.get(JobMetric.RESPONSE_TIME)

    @property
    def lateness(self) -> MetricObservation | None:
        """From when a timer is due to the start of its callback; None for others."""
        return self.metrics.get(JobMetric.INITIAL_PENDING_TIME) if self.kind is HandleKind.TIMER else None


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutorObservation(Shown):
    """An executor that loops; its iterations are jobs of its task.

    Attributes
    ----------
    iterations : number of iterations that ended
    timeouts : number of publications that were not acknowledged in time
    refusals : number of publications that were not sent, as all buffers had messages that were not acknowledged
    handles : in the order in which they are called
    """

    name: str
    iterations: int
    timeouts: int
    handles: Results[HandleObservation]
    refusals: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class LossObservation(Shown):
    """A message on a wire that loses messages.

    Attributes
    ----------
    sent : how often it was on the wire
    lost : how often it was lost there, or a part of it
    sent_again : how often it was sent again, as it was not acknowledged
    """

    name: str
    wire: str
    sent: int
    lost: int
    sent_again: int


@dataclass(frozen=True, slots=True, kw_only=True)
class LabelObservation(Shown):
    """The accesses to a label.

    Attributes
    ----------
    reads, writes : numbers of executed accesses
    unwritten_reads : number of reads before anybody had written
    overwritten : number of values that another value replaced before anybody had read them
    age : at each other read: the time since the value was written that is read; None if there is none
    """

    name: str
    reads: int
    writes: int
    unwritten_reads: int
    overwritten: int
    age: MetricObservation | None = field(default=None, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class RequirementObservation(ObservedLimit, Shown):
    """The verdict on a requirement or a constraint.

    Attributes
    ----------
    at : when the value, or what is wrong, was first observed, in picoseconds; None if that is not one time
    """

    at: Fraction | None = None
