"""Events that are to occur at equal distances: the period, and how far they are from its grid."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from math import ceil, floor
from typing import TYPE_CHECKING

from amalthea_uros._internal.records import dataclass
from amalthea_uros.compare.calibration.samples import Samples
from amalthea_uros.units import Time

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

#: Each step of the search for the drift leaves two thirds of the range.
_STEPS = 40
#: Two clocks of controllers and adapters differ by up to 100 parts in a million: 50 each.
CLOCK_ERROR = Fraction(100, 10**6)


@dataclass(frozen=True, slots=True)
class Grid:
    """Measured distances of events.

    Attributes
    ----------
    mean : of the distances
    error : by how much the true period can differ from the mean
    """

    mean: Fraction
    error: Fraction

    @classmethod
    def of(cls, samples: Samples) -> Grid:
        """The grid of measured distances: only the first and the last event decide about the mean, so their jitter is divided by n."""
        statistics = samples.statistics
        edges = Fraction(statistics.peak_to_peak + samples.step, statistics.count)
        return cls(statistics.mean, statistics.mean * CLOCK_ERROR + edges)

    def fits(self, period: Time) -> bool:
        """Whether the events can have this period."""
        return abs(self.mean - period) <= self.error

    def matching(self, periods: Iterable[Time]) -> Time | None:
        """The only one of some periods that the events can have; None if there is none, or several."""
        found = [period for period in periods if self.fits(period)]
        return found[0] if len(found) == 1 else None


def jitter_of(samples: Samples, period: Time) -> Time:
    """The least jitter with which events at measured distances have a period, rounded up to the resolution.

    Delays between 0 and J against a grid make neighbouring events T - J to T + J apart. The positions of all events against one grid
    show more: their spread. The period of that grid may differ by the error of the clocks.
    """
    import numpy as np

    statistics = samples.statistics
    jitter = max(period - statistics.min, statistics.max - period, 0)
    for each in samples.measured:
        if each.series.values is not None:
            distances = np.concatenate(([0], each.series.values))
            numbers = np.cumsum(np.rint(distances / period))
            jitter = max(
                jitter, floor(_least_spread(np.cumsum(distances) - numbers * period, numbers * float(period * CLOCK_ERROR)))
            )
    return ceil(Fraction(jitter, samples.step)) * samples.step


def _least_spread(positions: NDArray[np.float64], drift: NDArray[np.float64]) -> float:
    """The least spread of positions with a drift of -1 to 1 times the greatest one; the spread is a convex function of it."""
    import numpy as np

    def spread(share: float) -> float:
        return float(np.ptp(positions + share * drift))

    lower, upper = -1.0, 1.0
    for _ in range(_STEPS):
        third = (upper - lower) / 3
        if spread(lower + third) <= spread(upper - third):
            upper -= third
        else:
            lower += third
    return min(spread(lower), spread(upper), spread(0.0))
