"""Periodic stimuli: an ideal grid, and jitter that does not accumulate."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.simulate.arrivals.occurrences import Block, Blocks, UnknownArrivalError, block_size
from amalthea_uros.simulate.arrivals.repeated import repeated
from amalthea_uros.simulate.options import Mode
from amalthea_uros.simulate.sampling.quantiles import variate
from amalthea_uros.simulate.sampling.random_source import RandomSource
from amalthea_uros.simulate.sampling.streams import Same, Stream, values

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Times = NDArray[np.int64]

#: An assumption.
AT_0 = "occurrences that jitter would move to before the start of the simulation occur at its start"


def periodic(stimulus: Periodic, mode: Mode, source: RandomSource, time_base: int) -> Blocks:
    """The occurrences of a periodic stimulus.

    If values are not sampled, the jitter is constant: its greatest value in the worst case, its least in the best.
    """
    jitter = Same(0) if stimulus.jitter is None else values(stimulus.jitter, mode, source)
    distance = max(0, stimulus.min_distance or 0)
    if isinstance(jitter, Same) and distance <= stimulus.period:
        return repeated(stimulus.offset + jitter.value, stimulus.period, (0,), time_base)
    if stimulus.period <= 0:
        raise UnknownArrivalError("its period is not greater than zero")
    longest = max(abs(stimulus.offset), distance, stimulus.period, abs(jitter.lowest), abs(jitter.highest))
    return _jittered(stimulus, jitter, distance * time_base, time_base, block_size(longest * time_base * 4))


def before_0(stimulus: Periodic, mode: Mode) -> bool:
    """Whether jitter can move an occurrence to before the start of the simulation."""
    if stimulus.jitter is None or mode is not Mode.SAMPLED:
        return False
    jitter = variate(stimulus.jitter)
    return stimulus.offset + _first(stimulus, jitter.highest) * stimulus.period + jitter.lowest < 0


def _first(stimulus: Periodic, latest: int) -> int:
    """The number of the first period whose occurrence is not before 0 with the greatest jitter."""
    return max(0, -((stimulus.offset + latest) // stimulus.period))


def _jittered(stimulus: Periodic, jitter: Stream, distance: int, time_base: int, size: int) -> Blocks:
    """Occurrences in the order of time, also where jitter exceeds the period, and never closer than the distance.

    Those that jitter would put before 0 occur at 0, if a greater jitter could put them there; otherwise they are before the start of
    the simulation.
    """
    period = stimulus.period * time_base
    offset, earliest = stimulus.offset * time_base, jitter.lowest * time_base
    pending = np.empty(0, np.int64)
    last = -distance
    for start in count(_first(stimulus, jitter.highest), size):
        ideal = offset + np.arange(start, start + size) * period
        drawn = np.maximum(ideal + jitter.take(size) * time_base, 0)
        drawn = np.sort(np.concatenate((pending, drawn)))
        # No later one can be before this.
        end = max(0, offset + (start + size) * period + earliest)
        settled = int(np.searchsorted(drawn, end))
        times, pending = _at_distance(drawn[:settled], last, distance), drawn[settled:]
        last = int(times[-1]) if settled else last
        yield Block(end, times)


def _at_distance(times: Times, last: int, distance: int) -> Times:
    """Times that are moved to later so that they have a distance, also from the last one before."""
    steps = np.arange(1, len(times) + 1) * distance
    return np.maximum(np.maximum.accumulate(times - steps), last) + steps
