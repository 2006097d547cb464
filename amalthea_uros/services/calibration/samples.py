"""The measured values of one quantity, of one series or several."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

from amalthea_uros.measure.series import Measurement, Series
from amalthea_uros.measure.statistics import Statistics, statistics_of
from amalthea_uros.units import NANOSECOND, Time

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Measured:
    """A series that has values, and where it comes from."""

    series: Series
    source: Measurement


@dataclass(frozen=True, slots=True)
class Samples:
    """Measured values of one quantity.

    Attributes
    ----------
    values : picoseconds; None if only statistics are known
    held_out : values that are not used, but must be within what is written
    step : the resolution, to which bounds are rounded
    """

    measured: tuple[Measured, ...]
    statistics: Statistics
    values: NDArray[np.int64] | None
    held_out: NDArray[np.int64] | None
    step: Time


def samples_of(measured: Sequence[Measured], judge_on: Fraction) -> Samples:
    """The values of several series together, without the share on which they are judged."""
    import numpy as np

    used, held_out = [], []
    for each in measured:
        values = each.series.values
        if values is not None:
            count = len(values) - int(len(values) * judge_on)
            used.append(values[:count])
            held_out.append(values[count:])
    are_known = len(used) == len(measured)
    values = np.concatenate(used) if are_known else None
    statistics = _merged(each.series.statistics for each in measured) if values is None else statistics_of(values)
    return Samples(
        measured=tuple(measured),
        statistics=statistics,
        values=values,
        held_out=np.concatenate(held_out) if are_known and judge_on else None,
        step=max(each.source.resolution or NANOSECOND for each in measured),
    )


def _merged(parts: Iterable[Statistics | None]) -> Statistics:
    known = [part for part in parts if part is not None]
    count = sum(part.count for part in known)
    return Statistics(
        count=count,
        min=min(part.min for part in known),
        mean=sum((part.mean * part.count for part in known), Fraction(0)) / count,
        max=max(part.max for part in known),
        variance=None,
    )
