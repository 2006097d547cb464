"""Measurements made by hand, in microseconds."""

import numpy as np

from amalthea_uros.measure.series import MeasuredKind, Measurement, Series, statistics_of
from amalthea_uros.units import MICROSECOND, MILLISECOND


def series(name, quantity, values, kind=MeasuredKind.PROCESS, **more):
    """A series with these values."""
    found = np.array([round(value * MICROSECOND) for value in values], np.int64)
    return Series(kind=kind, name=name, quantity=quantity, values=found, statistics=statistics_of(found), **more)


def measurement(*measured, duration=50 * MILLISECOND, resolution=MICROSECOND):
    """The measurement of a log with these series."""
    return Measurement(
        source="run.log", format="CAN log", digest="ab" * 32, duration=duration, resolution=resolution, series=measured
    )
