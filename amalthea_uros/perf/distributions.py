"""How a value varies: execution demand in ticks, jitter in picoseconds, occurrences per step."""

from __future__ import annotations

from enum import StrEnum
from typing import Generic, TypeAlias, TypeVar

from amalthea_uros._internal.records import dataclass

#: What is distributed: int for ticks and times, float for rates.
N = TypeVar("N", int, float)


class Sampling(StrEnum):
    """Where between two boundaries the values lie, as far as it is known."""

    DEFAULT = "default"
    BEST_CASE = "best case"
    WORST_CASE = "worst case"
    AVERAGE_CASE = "average case"
    CORNER_CASE = "corner case"
    UNIFORM = "uniform"


@dataclass(frozen=True, slots=True)
class Constant(Generic[N]):
    """Always the same value."""

    value: N


@dataclass(frozen=True, slots=True, kw_only=True)
class Boundaries(Generic[N]):
    """Somewhere between two values."""

    lower: N
    upper: N
    sampling: Sampling = Sampling.DEFAULT


@dataclass(frozen=True, slots=True, kw_only=True)
class Bounds(Generic[N]):
    """Between two values that are stated, of a distribution of which a parameter is not."""

    lower: N
    upper: N


@dataclass(frozen=True, slots=True, kw_only=True)
class Statistics(Generic[N]):
    """Between two values with a known mean; the shape is not known."""

    lower: N
    average: float
    upper: N


@dataclass(frozen=True, slots=True, kw_only=True)
class Uniform(Generic[N]):
    """Anywhere between two values with the same probability."""

    lower: N
    upper: N


@dataclass(frozen=True, slots=True, kw_only=True)
class Gauss(Generic[N]):
    """Normal distribution, truncated to bounds where there are any (None: unbounded).

    Attributes
    ----------
    mean, deviation : those of the distribution before truncation
    """

    mean: float
    deviation: float
    lower: N | None = None
    upper: N | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Weibull(Generic[N]):
    """Weibull distribution from `lower` on, given by estimators.

    Attributes
    ----------
    exceeding : probability, in per mille, that a value would lie above `upper`; values are limited to `upper`
    """

    lower: N
    average: float
    upper: N
    exceeding: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Beta(Generic[N]):
    """Beta distribution, scaled to two values."""

    alpha: float
    beta: float
    lower: N
    upper: N


@dataclass(frozen=True, slots=True, kw_only=True)
class Bucket(Generic[N]):
    """Values in an interval and how often they were seen."""

    lower: N
    upper: N
    occurrences: int


@dataclass(frozen=True, slots=True)
class Histogram(Generic[N]):
    """Values as they were measured; intervals may overlap and leave gaps."""

    buckets: tuple[Bucket[N], ...]


Distribution: TypeAlias = (
    Constant[N] | Boundaries[N] | Bounds[N] | Statistics[N] | Uniform[N] | Gauss[N] | Weibull[N] | Beta[N] | Histogram[N]
)


def lowest(distribution: Distribution[N]) -> N | None:
    """The least value; None if there is no bound."""
    match distribution:
        case Constant(value):
            return value
        case Histogram(buckets):
            return min((bucket.lower for bucket in buckets), default=None)
        case _:
            return distribution.lower


def highest(distribution: Distribution[N]) -> N | None:
    """The greatest value; None if there is no bound."""
    match distribution:
        case Constant(value):
            return value
        case Histogram(buckets):
            return max((bucket.upper for bucket in buckets), default=None)
        case _:
            return distribution.upper
