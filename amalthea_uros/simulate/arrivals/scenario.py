"""Occurrences that a clock drives: where the integral of its frequency reaches certain values."""

from __future__ import annotations

from fractions import Fraction
from itertools import count
from math import floor, isfinite

import numpy as np

from amalthea_uros.perf.stimuli import Scenario
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.arrivals.occurrences import LONGEST, Block, Blocks, UnknownArrivalError
from amalthea_uros.timing.event_models.clock_areas import ClockArea, UnknownClockError, clock_area

#: Crossings are calculated one by one.
_BLOCK = 64


def scenario(driven: Scenario, system: System, time_base: int) -> Blocks:
    """The occurrences where the integral reaches the offset plus a multiple of the recurrence, and is greater than 0.

    Raises
    ------
    UnknownArrivalError : the clock is not in the model or invalid, the recurrence is not positive.
    """
    clock = next((clock for clock in system.stimuli.clocks if clock.name == driven.clock), None)
    if clock is None:
        raise UnknownArrivalError(f"the clock {driven.clock!r} is not defined in the model")
    if not isfinite(driven.offset) or not isfinite(driven.recurrence) or driven.recurrence <= 0:
        raise UnknownArrivalError("the recurrence of its scenario is not greater than zero, or its offset is not finite")
    try:
        return _crossings(clock_area(clock), Fraction(driven.offset), Fraction(driven.recurrence), time_base)
    except UnknownClockError as error:
        raise UnknownArrivalError(str(error)) from None


def _crossings(clock: ClockArea, offset: Fraction, recurrence: Fraction, time_base: int) -> Blocks:
    times: list[int] = []
    for number in count(max(0, floor(-offset / recurrence) + 1)):
        time = clock.first_time(offset + number * recurrence, time_base)
        if time is None or time > LONGEST:
            break
        times.append(time)
        if len(times) == _BLOCK:
            yield Block(time, np.array(times, np.int64))
            times.clear()
    yield Block(LONGEST, np.array(times, np.int64))
