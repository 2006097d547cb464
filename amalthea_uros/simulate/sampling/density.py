"""Quantiles of a distribution that is given by its density."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from amalthea_uros.simulate.sampling.quantile_table import Quantiles

    Floats = NDArray[np.float64]

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
