"""Quantile functions as tables of whole numbers.

The last bit of `exp` or `log` depends on the machine. A table holds the quantiles as whole numbers, rounded so coarsely that such
differences vanish, and values are drawn from it by integer arithmetic: the same on every machine.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from amalthea_uros._internal.arrays import Floats, Words

#: Gives the quantiles of probabilities, as fractions of the range of the values.
Quantiles: TypeAlias = "Callable[[Floats], Floats]"

#: Cells of equal probability in a table: 2 to this power.
_CELL_BITS = 10
#: Quantiles are multiples of 2 to the power of minus this; a value between them has 64 bits.
_KNOT_BITS = 28
_REMAINDER_BITS = 64 - _KNOT_BITS
#: How often the outermost cell is divided further: down to probabilities of 2**-30.
_REFINEMENTS = 2

_CELL_SHIFT = np.uint64(64 - _CELL_BITS)
_CELLS = 2**_CELL_BITS


@dataclass(frozen=True, slots=True)
class QuantileTable:
    """A quantile function; between two quantiles, values are equally probable.

    Attributes
    ----------
    knots : the quantiles at the lower ends of the cells
    widths : distance to the next one
    tails : the outermost cells that are divided further, by their number
    """

    knots: Words
    widths: Words
    tails: tuple[tuple[int, QuantileTable], ...]

    def fractions(self, words: Words) -> Words:
        """The quantiles at probabilities; both are binary fractions."""
        cells = words >> _CELL_SHIFT
        places = cells.view(np.int64)
        remainders = (words << np.uint64(_CELL_BITS)) >> np.uint64(64 - _REMAINDER_BITS)
        found = (self.knots.take(places) << np.uint64(_REMAINDER_BITS)) + self.widths.take(places) * remainders
        for cell, tail in self.tails:
            inside = np.flatnonzero(places == cell)
            if len(inside):
                found[inside] = tail.fractions(words[inside] << np.uint64(_CELL_BITS))
        return found


def tabulated(quantiles: Quantiles) -> QuantileTable:
    """The table of a quantile function from [0, 1] to [0, 1]."""
    return _tabulated(quantiles, 0.0, 1.0, (0, _CELLS - 1), _REFINEMENTS)


def _tabulated(quantiles: Quantiles, start: float, width: float, ends: tuple[int, ...], refinements: int) -> QuantileTable:
    """The table of a cell; `ends`: its cells at the ends of the range."""
    # These probabilities have at most 30 bits, so that 1 - p is exact, too.
    probabilities = start + width * np.arange(_CELLS + 1) / _CELLS
    knots = np.rint(quantiles(probabilities) * 2.0**_KNOT_BITS).clip(0, 2**_KNOT_BITS - 1)
    knots = np.maximum.accumulate(knots).astype(np.uint64)
    tails = tuple(
        (end, _tabulated(quantiles, start + width * end / _CELLS, width / _CELLS, (end,), refinements - 1))
        for end in ends
        if refinements
    )
    return QuantileTable(knots[:-1], np.diff(knots), tails)


# Quantiles of a distribution that is given by its density.

#: Where the density is less than exp(-20) of its maximum, a distribution is cut off: a normal one at 6.3 standard deviations.
NEGLIGIBLE = 20.0
#: Points of the integration.
POINTS = 2**14


def quantiles_of_density(points: Floats, logarithms: Floats, values: Floats, ends: tuple[float, float] = (0, 0)) -> Quantiles:
    """The quantiles by the trapezoidal rule, whose error is far below the resolution of a simulation.

    Parameters
    ----------
    points : equidistant
    logarithms : of the density at the points
    values : at the points
    ends : the integral of the density before the first and after the last point
    """
    densities = np.exp(logarithms)
    areas = (densities[1:] + densities[:-1]) * ((points[-1] - points[0]) / (len(points) - 1) / 2)
    integral = np.concatenate(([0.0], np.cumsum(areas))) + ends[0]
    probabilities = integral / (integral[-1] + ends[1])
    return lambda wanted: np.interp(wanted, probabilities, values)
