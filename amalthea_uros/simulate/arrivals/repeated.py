"""Times that are repeated with a period: periodic stimuli without jitter, lists of times, bursts."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import count

import numpy as np

from amalthea_uros.perf.stimuli import Burst, Synthetic
from amalthea_uros.simulate.arrivals.occurrences import Block, Blocks, UnknownArrivalError, block_size
from amalthea_uros.timing.event_models.stimuli import MAX_OCCURRENCES


def synthetic(stimulus: Synthetic, time_base: int) -> Blocks:
    """The occurrences of a list of times; times after the period overlap with the next one."""
    if not stimulus.times:
        raise UnknownArrivalError("it has no occurrence times")
    if min(stimulus.times) < 0:
        raise UnknownArrivalError("an occurrence time is negative")
    return repeated(stimulus.offset, stimulus.period, stimulus.times, time_base)


def burst(stimulus: Burst, time_base: int) -> Blocks:
    """The occurrences of bursts; whether one at exactly the end of a burst is clipped is not specified: it occurs."""
    if stimulus.distance < 0:
        raise UnknownArrivalError("the distance of the occurrences in a burst is negative")
    clipped = max(stimulus.length, 0) // stimulus.distance + 1 if stimulus.distance else stimulus.count
    number = min(stimulus.count, clipped)
    if not 0 < number <= MAX_OCCURRENCES:
        raise UnknownArrivalError(f"the number of occurrences in a burst is not between 1 and {MAX_OCCURRENCES}")
    return repeated(stimulus.offset, stimulus.period, [i * stimulus.distance for i in range(number)], time_base)


def repeated(offset: int, period: int, times: Sequence[int], time_base: int) -> Blocks:
    """Times that are repeated with a period; arguments in picoseconds.

    Raises
    ------
    UnknownArrivalError : the period is not positive.
    """
    if period <= 0:
        raise UnknownArrivalError("its period is not greater than zero")
    size = max(1, block_size(period * time_base) // len(times))
    block_size(max(abs(offset), *times, 0) * time_base)
    return _repeated(offset, period, times, time_base, size)


def _repeated(offset: int, period: int, times: Sequence[int], time_base: int, size: int) -> Blocks:
    """The blocks of `size` periods each."""
    # Each time as the number of the first period with it, and its place in a period.
    parts = sorted((time % period, time // period) for time in times)
    places = np.array([place for place, _ in parts], np.int64) * time_base
    firsts = np.array([first for _, first in parts], np.int64)
    for start in count(max(0, -(offset // period)), size):
        periods = np.arange(start, start + size)[:, None]
        found = (offset + periods * period) * time_base + places
        has_begun = periods >= firsts
        end = (offset + (start + size) * period) * time_base
        yield Block(end, found.ravel() if start >= firsts.max() else found[has_begun])
