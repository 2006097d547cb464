"""What is demanded: timing constraints on events and chains, and requirements on processes and runnables."""

from __future__ import annotations

from enum import StrEnum
from typing import TypeAlias

from amalthea_uros._internal.records import dataclass
from amalthea_uros.perf.named import Brief, Named
from amalthea_uros.units import Frequency, Time


class LatencyKind(StrEnum):
    """Forward from each stimulus (reaction), or back from each response (age)."""

    REACTION = "reaction"
    AGE = "age"


@dataclass(frozen=True, slots=True, kw_only=True)
class LatencyConstraint(Named):
    """Limits of the reaction time or the data age of a chain; None: no limit.

    Attributes
    ----------
    jitter : limit of the maximum minus the minimum
    """

    chain: str
    kind: LatencyKind = LatencyKind.REACTION
    minimum: Time | None = None
    maximum: Time | None = None
    jitter: Time | None = None


class Matching(StrEnum):
    """Which occurrence of the target belongs to one of the source."""

    REACTION = "reaction"
    ONE_TO_ONE = "one to one"
    UNIQUE_REACTION = "unique reaction"


@dataclass(frozen=True, slots=True, kw_only=True)
class DelayConstraint(Named):
    """Limits of the time from one event to another."""

    source: str
    target: str
    matching: Matching = Matching.REACTION
    lower: Time | None = None
    upper: Time | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RepetitionConstraint(Named):
    """Limits of the time that `span` repetitions of an event take, and of their jitter."""

    event: str
    span: int = 1
    lower: Time | None = None
    upper: Time | None = None
    jitter: Time | None = None
    period: Time | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class EventSynchronization(Named):
    """Events that have to occur together, within a tolerance."""

    events: tuple[str, ...]
    tolerance: Time
    every_occurrence: bool = False


class ChainEnd(StrEnum):
    """An end of a chain."""

    STIMULUS = "stimulus"
    RESPONSE = "response"


@dataclass(frozen=True, slots=True, kw_only=True)
class ChainSynchronization(Named):
    """Two chains that have to start or end together, within a tolerance."""

    chains: tuple[str, ...]
    tolerance: Time
    end: ChainEnd = ChainEnd.RESPONSE
    every_occurrence: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class DataAgeConstraint(Named):
    """How long what a runnable writes to a label is valid: as time after the write, or in activations of the writer.

    Attributes
    ----------
    earliest_cycle, latest_cycle : both are given, or none
    """

    runnable: str
    label: str
    earliest: Time | None = None
    latest: Time | None = None
    earliest_cycle: int | None = None
    latest_cycle: int | None = None


class Ordering(StrEnum):
    """Whether others may run in between a sequence of runnables, and where in the process it stands."""

    SUCCESSOR = "successor"
    IMMEDIATE_ANYWHERE = "immediate successor, anywhere"
    IMMEDIATE_AT_START = "immediate successor, at the start"
    IMMEDIATE_AT_END = "immediate successor, at the end"


@dataclass(frozen=True, slots=True, kw_only=True)
class OrderConstraint(Named):
    """Groups of runnables that have to run one after the other."""

    groups: tuple[tuple[str, ...], ...]
    ordering: Ordering = Ordering.SUCCESSOR
    processes: tuple[str, ...] = ()


class DataGroupKind(StrEnum):
    """Whether values belong together, or must not change while they are used."""

    COHERENCY = "coherency"
    STABILITY = "stability"


@dataclass(frozen=True, slots=True, kw_only=True)
class DataGroup(Named):
    """Labels that have to be kept consistent; names may repeat."""

    kind: DataGroupKind
    labels: tuple[str, ...] = ()


Constraint: TypeAlias = LatencyConstraint | DelayConstraint | RepetitionConstraint | EventSynchronization | ChainSynchronization


class RequirementSeverity(StrEnum):
    """How bad it is if a requirement is not met."""

    COSMETIC = "cosmetic"
    MINOR = "minor"
    MAJOR = "major"
    CRITICAL = "critical"


class TimeMetric(StrEnum):
    """A time that every job has."""

    RESPONSE_TIME = "response time"
    NET_EXECUTION_TIME = "net execution time"
    GROSS_EXECUTION_TIME = "gross execution time"
    CORE_EXECUTION_TIME = "core execution time"
    RUNNING_TIME = "running time"
    READY_TIME = "ready time"
    WAITING_TIME = "waiting time"
    POLLING_TIME = "polling time"
    PARKING_TIME = "parking time"
    START_DELAY = "start delay"
    LATENESS = "lateness"
    ACTIVATE_TO_ACTIVATE = "activate to activate"
    START_TO_START = "start to start"
    END_TO_END = "end to end"
    END_TO_START = "end to start"
    MEMORY_ACCESS_TIME = "memory access time"
    OS_OVERHEAD = "OS overhead"


class CountMetric(StrEnum):
    """A number of occurrences."""

    ACTIVATIONS = "activations"
    PREEMPTIONS = "preemptions"
    BOUNDED_MIGRATIONS = "bounded migrations"
    FULL_MIGRATIONS = "full migrations"
    LOST_ACTIVATIONS = "lost activations"
    CACHE_HITS = "cache hits"
    CACHE_MISSES = "cache misses"


class LoadMetric(StrEnum):
    """A share of a core's capacity."""

    LOAD = "load"
    RUNNING = "running"
    READY = "ready"
    WAITING = "waiting"
    PARKING = "parking"
    POLLING = "polling"
    BUFFERING = "buffering"


class RatioMetric(StrEnum):
    """A ratio."""

    NORMALIZED_RESPONSE_TIME = "normalized response time"
    NORMALIZED_LATENESS = "normalized lateness"
    CORE_EXECUTION_TIME = "relative core execution time"
    MEMORY_ACCESS_TIME = "relative memory access time"
    OS_OVERHEAD = "relative OS overhead"
    CACHE_HITS = "cache hit ratio"
    CACHE_MISSES = "cache miss ratio"


class FrequencyMetric(StrEnum):
    """Occurrences per time."""

    CACHE_HITS = "cache hit frequency"
    CACHE_MISSES = "cache miss frequency"


class Bound(StrEnum):
    """Whether a metric must not exceed or not fall below a value."""

    UPPER = "upper"
    LOWER = "lower"


@dataclass(frozen=True, slots=True, kw_only=True)
class TimeLimit:
    """A limit of a time."""

    metric: TimeMetric
    value: Time
    bound: Bound = Bound.UPPER


@dataclass(frozen=True, slots=True, kw_only=True)
class JitterLimit:
    """An upper limit of the jitter of a time: of a time from job to job the deviation from the period, of others maximum - minimum."""

    metric: TimeMetric
    value: Time

    @property
    def bound(self) -> Bound:
        """It is a maximum."""
        return Bound.UPPER


@dataclass(frozen=True, slots=True, kw_only=True)
class CountLimit:
    """A limit of a number."""

    metric: CountMetric
    value: int
    bound: Bound = Bound.UPPER


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadLimit:
    """A limit of a share of a core's capacity."""

    metric: LoadMetric
    value: float
    bound: Bound = Bound.UPPER
    core: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RatioLimit:
    """A limit of a ratio."""

    metric: RatioMetric
    value: float
    bound: Bound = Bound.UPPER


@dataclass(frozen=True, slots=True, kw_only=True)
class FrequencyLimit:
    """A limit of a number per time."""

    metric: FrequencyMetric
    value: Frequency
    bound: Bound = Bound.UPPER


Limit: TypeAlias = TimeLimit | JitterLimit | CountLimit | LoadLimit | RatioLimit | FrequencyLimit


@dataclass(frozen=True, slots=True, kw_only=True)
class Requirement(Named):
    """A limit that every job of a process, or every execution of a runnable, has to keep; names may repeat.

    Attributes
    ----------
    process, runnable : one of them is given
    """

    limit: Limit
    process: str | None = None
    runnable: str | None = None
    severity: RequirementSeverity | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Constraints(Brief):
    """All that is demanded of a system."""

    constraints: tuple[Constraint, ...] = ()
    data_ages: tuple[DataAgeConstraint, ...] = ()
    orders: tuple[OrderConstraint, ...] = ()
    requirements: tuple[Requirement, ...] = ()
    data_groups: tuple[DataGroup, ...] = ()
