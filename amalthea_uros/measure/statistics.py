"""Statistics of measured times.

Percentiles are values that occurred (nearest rank); the standard deviation is that of the values themselves, not an estimate for
others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil, sqrt
from typing import TYPE_CHECKING

from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import Time

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: The percentiles that are computed where all values are known.
PERCENTILES = (Fraction(1, 2), Fraction(9, 10), Fraction(95, 100), Fraction(99, 100), Fraction(999, 1000))


@dataclass(frozen=True, slots=True, kw_only=True)
class Statistics:
    """Statistics of some values, in picoseconds.

    Attributes
    ----------
    count : number of values, at least 1
    variance : mean squared deviation from the mean (divided by n), in square picoseconds; None if it is not known
    percentiles : share of the values -> least value that so many do not exceed; only where there are more than 1 / (1 - share) values
    """

    count: int
    min: Time
    mean: Fraction
    max: Time
    variance: Fraction | None
    percentiles: Mapping[Fraction, Time] = field(default_factory=dict)

    @property
    def std(self) -> float | None:
        """The standard deviation, divided by n, not n - 1."""
        return None if self.variance is None else sqrt(self.variance)

    @property
    def peak_to_peak(self) -> Time:
        """The jitter as difference between maximum and minimum."""
        return self.max - self.min


def statistics_of(values: NDArray[np.int64]) -> Statistics:
    """The statistics of values in picoseconds.

    Raises
    ------
    InvalidArgumentError : there are none.
    """
    import numpy as np

    if not len(values):
        raise InvalidArgumentError("there are no values, so they have no statistics")
    from amalthea_uros._internal.exact_sums import sums, sums_of_squares

    ordered = np.sort(values)
    count, first = len(ordered), int(ordered[0])
    deviations = (ordered - first)[None, :]
    (total,), (squares,) = sums(deviations), sums_of_squares(deviations)
    percentiles = {
        share: int(ordered[ceil(share * count) - 1])
        for share in PERCENTILES
        if share == Fraction(1, 2) or count * (1 - share) > 1
    }
    return Statistics(
        count=count,
        min=first,
        mean=first + Fraction(total, count),
        max=int(ordered[-1]),
        variance=Fraction(squares * count - total * total, count * count),
        percentiles=percentiles,
    )


def statistics_or_none(values: NDArray[np.int64]) -> Statistics | None:
    """The statistics of values in picoseconds, None if there are none."""
    return statistics_of(values) if len(values) else None


def merged(parts: Sequence[Statistics]) -> Statistics:
    """The statistics of all values of some parts, exactly; percentiles do not merge, and the variance only if all are known.

    Parameters
    ----------
    parts : at least one
    """
    count = sum(part.count for part in parts)
    mean = sum((part.mean * part.count for part in parts), Fraction(0)) / count
    variance: Fraction | None = Fraction(0)
    for part in parts:
        if part.variance is None or variance is None:
            variance = None
        else:
            variance += (part.variance + (part.mean - mean) ** 2) * part.count / count
    return Statistics(
        count=count,
        min=min(part.min for part in parts),
        mean=mean,
        max=max(part.max for part in parts),
        variance=variance,
    )


def shifted(statistics: Statistics, by: Time) -> Statistics:
    """The statistics of the values with a time added to each."""
    return Statistics(
        count=statistics.count,
        min=statistics.min + by,
        mean=statistics.mean + by,
        max=statistics.max + by,
        variance=statistics.variance,
        percentiles={share: value + by for share, value in statistics.percentiles.items()},
    )
