"""Streams of whole numbers that a simulation draws from, one for each place of the model that draws.

How many values are taken at a time does not change them. In the modes that do not sample, a stream is constant.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import ceil, floor, isfinite

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.distributions import Bounds, Distribution, Gauss, highest, lowest
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.sampling.variates import GREATEST, NO_PARAMETERS, Variate, check, variate
from amalthea_uros.simulate.sampling.words import RandomSource, scaled
from amalthea_uros.timing.demand.means import mean


@dataclass(frozen=True, slots=True)
class ValueStream:
    """Whole numbers one after another.

    Attributes
    ----------
    lowest, highest : between which all values are
    take : gives the next values, as many as it is asked for
    """

    lowest: int
    highest: int
    take: Callable[[int], Numbers]

    @property
    def constant(self) -> int | None:
        """The only value; None if there are several."""
        return self.lowest if self.lowest == self.highest else None


def constant(value: int) -> ValueStream:
    """Always the same value."""
    return ValueStream(value, value, lambda count: np.full(count, value, np.int64))


def sampled(variate: Variate, source: RandomSource) -> ValueStream:
    """Values of a distribution."""
    return ValueStream(variate.lowest, variate.highest, lambda count: variate.of(source.words(count)))


def converted(stream: ValueStream, factor: Fraction) -> ValueStream:
    """Values of another stream that are not negative, multiplied by a factor and rounded to the nearest whole number."""
    whole, rest = divmod(factor, 1)

    def take(count: int) -> Numbers:
        values = stream.take(count)
        products = values * np.int64(whole)
        if rest:
            # Twice the product plus 1, halved.
            twice = scaled(values.view(np.uint64) << np.uint64(1), floor(rest * 2**64))
            products += ((twice + np.uint64(1)) >> np.uint64(1)).view(np.int64)
        return products

    return ValueStream(floor(stream.lowest * factor), ceil(stream.highest * factor), take)


def values(distribution: Distribution[int], mode: SimulationMode, source: RandomSource) -> ValueStream:
    """Values of a distribution; in the other modes the greatest (worst), the least (best) or the mean, rounded.

    Raises
    ------
    UnknownError : the parameters of the distribution contradict each other, or it does not have the value of the mode.
    """
    if mode is not SimulationMode.SAMPLED:
        check(distribution)
        return constant(round(_value(distribution, mode)))
    drawn = variate(distribution)
    return constant(drawn.lowest) if drawn.lowest == drawn.highest else sampled(drawn, source)


def durations(distribution: Distribution[int], per_unit: Fraction, mode: SimulationMode, source: RandomSource) -> ValueStream:
    """Execution times: ticks, converted to time units.

    They are rounded to the nearest time unit; up in the worst case, and down in the best. A normal distribution without a minimum
    is truncated at 0.

    Parameters
    ----------
    per_unit : time units of a tick

    Raises
    ------
    UnknownError : as for `values`; a number of ticks is negative, or the time exceeds the supported range.
    """
    ticks = _truncated_at_0(distribution)
    stream = values(ticks, mode, source)
    if stream.lowest < 0:
        raise UnknownError("a number of ticks is negative")
    if stream.highest * per_unit > GREATEST:
        raise UnknownError("an execution time exceeds the supported range")
    if stream.constant is not None:
        exact = (stream.constant if mode is SimulationMode.SAMPLED else _value(ticks, mode)) * per_unit
        return constant({SimulationMode.WORST: ceil, SimulationMode.BEST: floor}.get(mode, round)(exact))
    return stream if per_unit == 1 else converted(stream, per_unit)


def choices(weights: Sequence[float | Fraction], mode: SimulationMode, source: RandomSource) -> ValueStream:
    """Indices with a probability in proportion to the weights; if not sampled, the first of the most probable ones.

    Raises
    ------
    UnknownError : a weight is negative or not finite, or all are 0.
    """
    if not all(isfinite(weight) and weight >= 0 for weight in weights):
        raise UnknownError("the probability of a branch is negative or not finite")
    exact = [Fraction(weight) for weight in weights]
    total = sum(exact)
    if not total:
        raise UnknownError("all branches have the probability 0")
    possible = [index for index, weight in enumerate(exact) if weight]
    if mode is not SimulationMode.SAMPLED or len(possible) == 1:
        return constant(exact.index(max(exact)))
    # The sum of the probabilities up to each index but the last, as a binary fraction.
    sums = [sum(exact[: index + 1], Fraction(0)) / total for index in range(possible[-1])]
    ends = np.array([floor(end * 2**64) for end in sums], np.uint64)
    return ValueStream(0, len(ends), lambda count: np.searchsorted(ends, source.words(count), side="right").astype(np.int64))


def permutations(source: RandomSource) -> ValueStream:
    """Random numbers from 0 to 2**63 - 1 that decide an order, in all modes."""
    return ValueStream(0, 2**63 - 1, lambda count: (source.words(count) >> np.uint64(1)).view(np.int64))


def _value(distribution: Distribution[int], mode: SimulationMode) -> int | Fraction:
    """The value that a mode always takes."""
    if mode is SimulationMode.AVERAGE:
        if isinstance(distribution, Bounds):
            raise UnknownError(NO_PARAMETERS)
        return mean(distribution)
    found = highest(distribution) if mode is SimulationMode.WORST else lowest(distribution)
    if found is None:
        raise UnknownError(f"a distribution has no {'maximum' if mode is SimulationMode.WORST else 'minimum'}")
    return found


def _truncated_at_0(distribution: Distribution[int]) -> Distribution[int]:
    match distribution:
        case Gauss(lower=None, upper=None | int() as upper) if upper is None or upper >= 0:
            return replace(distribution, lower=0)
    return distribution
