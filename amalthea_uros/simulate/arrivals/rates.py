"""Occurrences at a rate that changes from step to step, or that a clock drives."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import count
from math import ceil, floor, isfinite

import numpy as np

from amalthea_uros._internal.arrays import Numbers
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.distributions import (
    Bucket,
    Constant,
    Distribution,
    Gauss,
    Histogram,
    Statistics,
    Weibull,
    highest,
    lowest,
)
from amalthea_uros.perf.stimuli import Scenario, VariableRate
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.arrivals.occurrences import LONGEST, OccurrenceBlock, OccurrenceBlocks, block_size
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.sampling.streams import ValueStream, values
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.timing.event_models.clock_areas import ClockArea, clock_area

#: Rates are whole numbers of fractions of an occurrence; products of two of them fit into 64 bits.
_RATE_BITS = 31
#: Occurrences in a step, at most, and in a block, about.
_HIGHEST_RATE, _OCCURRENCES = 2**20, 2**16


def variable_rate(stimulus: VariableRate, mode: SimulationMode, source: RandomSource, time_base: int) -> OccurrenceBlocks:
    """Occurrences where the integral of the rate reaches 1, 2, 3...: evenly within a step, and fractions are carried over.

    Raises
    ------
    UnknownError : the step is not positive, a rate is negative or has no bounds, a limit of its change is negative.
    """
    if stimulus.step <= 0:
        raise UnknownError("its step is not greater than zero")
    least, most = lowest(stimulus.rate), highest(stimulus.rate)
    if least is None or most is None or not (isfinite(least) and isfinite(most)):
        raise UnknownError("its number of occurrences in a step has no bounds")
    if least < 0 or most > _HIGHEST_RATE:
        raise UnknownError(f"its number of occurrences in a step is not between 0 and {_HIGHEST_RATE}")
    if most > stimulus.step:
        raise UnknownError("more than one occurrence in a picosecond is possible")
    changes = (stimulus.max_decrease, stimulus.max_increase)
    if any(change is not None and not change >= 0 for change in changes):
        raise UnknownError("a limit of the change of its rate is negative")
    unit = 2 ** (_RATE_BITS - ceil(most).bit_length())
    rates = values(_in_units(stimulus.rate, unit), mode, source)
    decrease, increase = (unit * _HIGHEST_RATE if c is None or c > _HIGHEST_RATE else int(Fraction(c) * unit) for c in changes)
    size = min(block_size(stimulus.step * time_base), max(1, _OCCURRENCES // max(1, ceil(most))))
    is_limited = min(decrease, increase) < rates.highest - rates.lowest
    return _at_rates(rates, (decrease, increase) if is_limited else None, stimulus.step * time_base, unit, size)


def _at_rates(rates: ValueStream, changes: tuple[int, int] | None, step: int, unit: int, size: int) -> OccurrenceBlocks:
    start = carry = 0
    last: int | None = None
    while True:
        drawn = rates.take(size)
        if changes is not None:
            drawn = _limited(drawn, last, *changes)
            last = int(drawn[-1])
        sums = np.concatenate(([carry], carry + np.cumsum(drawn)))
        # The occurrences in each step, and what the sum lacks at its start until each of them.
        counts = np.diff(sums // unit)
        steps = np.repeat(np.arange(size), counts)
        numbers = sums[0] // unit + np.arange(1, len(steps) + 1)
        missing, rate = numbers * unit - sums[steps], drawn[steps]
        # step * missing / rate, in two parts that fit into 64 bits.
        yield OccurrenceBlock(
            start + size * step, start + steps * step + step // rate * missing + step % rate * missing // rate
        )
        start, carry = start + size * step, int(sums[-1] % unit)


def _limited(drawn: Numbers, last: int | None, decrease: int, increase: int) -> Numbers:
    """Rates of which none differs from the one before by more than the limits."""
    found = drawn.tolist()
    for index, rate in enumerate(found):
        last = rate if last is None else min(max(rate, last - decrease), last + increase)
        found[index] = last
    return np.array(found, np.int64)


def _in_units(rate: Distribution[float], unit: int) -> Distribution[int]:
    """A distribution of rates as one of whole numbers of a small unit."""

    def whole(value: float) -> int:
        return int(Fraction(value) * unit)

    match rate:
        case Constant(value):
            return Constant(whole(value))
        case Histogram(buckets):
            scaled = (Bucket(lower=whole(b.lower), upper=whole(b.upper), occurrences=b.occurrences) for b in buckets)
            return Histogram(tuple(scaled))
        case Gauss(mean=mean, deviation=deviation):
            bounds = {"lower": whole(rate.lower or 0), "upper": whole(rate.upper or 0)}
            return Gauss(mean=mean * unit, deviation=deviation * unit, **bounds)
        case Statistics(average=average) | Weibull(average=average):
            lower, upper = whole(rate.lower), whole(rate.upper)
            inner = min(max(average * unit, lower), upper) if rate.lower <= average <= rate.upper else average * unit
            return replace(rate, lower=lower, upper=upper, average=inner)  # type: ignore[return-value]
        case _:
            return replace(rate, lower=whole(rate.lower), upper=whole(rate.upper))  # type: ignore[return-value]


# Occurrences that a clock drives: where the integral of its frequency reaches certain values.

#: Crossings are calculated one by one.
_BLOCK = 64


def scenario(driven: Scenario, system: System, time_base: int) -> OccurrenceBlocks:
    """The occurrences where the integral reaches the offset plus a multiple of the recurrence, and is greater than 0.

    Raises
    ------
    UnknownError : the clock is not in the model or invalid, the recurrence is not positive.
    """
    clock = next((clock for clock in system.stimuli.clocks if clock.name == driven.clock), None)
    if clock is None:
        raise UnknownError(f"the clock {driven.clock!r} is not defined in the model")
    if not isfinite(driven.offset) or not isfinite(driven.recurrence) or driven.recurrence <= 0:
        raise UnknownError("the recurrence of its scenario is not greater than zero, or its offset is not finite")
    return _crossings(clock_area(clock), Fraction(driven.offset), Fraction(driven.recurrence), time_base)


def _crossings(clock: ClockArea, offset: Fraction, recurrence: Fraction, time_base: int) -> OccurrenceBlocks:
    times: list[int] = []
    for number in count(max(0, floor(-offset / recurrence) + 1)):
        time = clock.first_time(offset + number * recurrence, time_base)
        if time is None or time > LONGEST:
            break
        times.append(time)
        if len(times) == _BLOCK:
            yield OccurrenceBlock(time, np.array(times, np.int64))
            times.clear()
    yield OccurrenceBlock(LONGEST, np.array(times, np.int64))
