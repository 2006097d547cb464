"""How much two samples differ in distribution: equal means can hide different ones.

The distance is that of the two-sample test of Kolmogorov and Smirnov: the greatest difference between the shares of values that do not
exceed a time (N. Smirnov, Annals of Mathematical Statistics 19, 1948). Quantiles are values that occurred (nearest rank).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, log, sqrt
from typing import TYPE_CHECKING

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.units import Time

if TYPE_CHECKING:
    pass

#: How often a greater distance than the critical one occurs by chance, for independent samples of one distribution.
SIGNIFICANCE = 0.05
#: The shares of the quantiles that are compared.
QUANTILES = (Fraction(10, 100), Fraction(50, 100), Fraction(90, 100), Fraction(99, 100))


@dataclass(frozen=True, slots=True, kw_only=True)
class Distance:
    """The difference between the distributions of two samples.

    Attributes
    ----------
    value : the Kolmogorov-Smirnov distance, from 0 (equal) to 1 (no value in common)
    critical : for large independent samples of one distribution, it is greater in 5 % of the cases only
    counts : the numbers of values
    quantiles : share -> the quantiles of both
    """

    value: Fraction
    critical: float
    counts: tuple[int, int]
    quantiles: Mapping[Fraction, tuple[Time, Time]]

    @property
    def is_significant(self) -> bool:
        """Whether chance alone hardly explains it."""
        return self.value > self.critical


def distance(one: Numbers, other: Numbers) -> Distance:
    """The distance of two samples of times.

    Raises
    ------
    InvalidArgumentError : a sample has no values.
    """
    import numpy as np

    counts = len(one), len(other)
    if not all(counts):
        raise InvalidArgumentError("there are no values, so they have no distribution")
    ordered = np.sort(one), np.sort(other)
    # The distribution functions change at values only; whole numbers keep their difference exact.
    places = np.unique(np.concatenate(ordered))
    below = [np.searchsorted(values, places, side="right") for values in ordered]
    greatest = int(np.abs(below[0] * counts[1] - below[1] * counts[0]).max())
    return Distance(
        value=Fraction(greatest, counts[0] * counts[1]),
        critical=sqrt(-log(SIGNIFICANCE / 2) / 2 * (1 / counts[0] + 1 / counts[1])),
        counts=counts,
        quantiles={share: (_quantile(ordered[0], share), _quantile(ordered[1], share)) for share in QUANTILES},
    )


def _quantile(ordered: Numbers, share: Fraction) -> Time:
    return int(ordered[ceil(share * len(ordered)) - 1])
