"""When the integral of a clock's frequency reaches a number: the occurrences of a stimulus with a scenario.

All is calculated with fractions, so that crossings are exact. Only the sine is rounded, at 2**-140, and the same on every machine.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from bisect import bisect_left
from collections.abc import Callable
from fractions import Fraction
from itertools import count
from math import ceil

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.stimuli import Clock, ClockFunction, ClockSteps, Curve
from amalthea_uros.units import SECOND, Time

_PI = Fraction("3.14159265358979323846264338327950288419716939937510")
#: Unit of the fixed-point numbers in which the cosine is calculated.
_ONE = 2**140


class ClockArea(ABC):
    """The integral of a frequency over time, from 0 on."""

    period: Time | None

    @property
    @abstractmethod
    def of_period(self) -> Fraction:
        """The area of a whole period."""

    @abstractmethod
    def within_period(self, area: Fraction, time_base: int) -> Fraction | None:
        """The time in the first period at which the area reaches a value greater than 0, in parts of a picosecond."""

    def first_time(self, area: Fraction, time_base: int = 1) -> int | None:
        """When the area first reaches a value greater than 0, rounded up; None if it never does.

        Parameters
        ----------
        time_base : parts of a picosecond in which the result is
        """
        rounds, rest = 0, area
        if self.period is not None:
            if not self.of_period:
                return None
            # The rest is greater than 0: what is reached at the end of a period is not looked for in the next one.
            rounds = ceil(area / self.of_period) - 1
            rest = area - rounds * self.of_period
        found = self.within_period(rest, time_base)
        return None if found is None else ceil(rounds * (self.period or 0) * time_base + found)


@dataclass(frozen=True)
class StepArea(ClockArea):
    """The integral of steps.

    Attributes
    ----------
    times, areas, frequencies : the start of each step, the area up to it, and the frequency from it on
    """

    period: Time | None
    times: tuple[Time, ...]
    areas: tuple[Fraction, ...]
    frequencies: tuple[Fraction, ...]

    @property
    def of_period(self) -> Fraction:
        """See `ClockArea`."""
        return self.areas[-1] + self.frequencies[-1] * ((self.period or 0) - self.times[-1]) / SECOND

    def within_period(self, area: Fraction, time_base: int) -> Fraction | None:
        """See `ClockArea`."""
        step = bisect_left(self.areas, area) - 1
        frequency = self.frequencies[step]
        return (self.times[step] + (area - self.areas[step]) * SECOND / frequency) * time_base if frequency else None


@dataclass(frozen=True)
class CurveArea(ClockArea):
    """The integral of a curve that repeats.

    Attributes
    ----------
    area : up to a time in picoseconds
    """

    period: Time
    area: Callable[[Fraction], Fraction]
    _known: dict[tuple[Fraction, int], Fraction] = field(default_factory=dict)

    @property
    def of_period(self) -> Fraction:
        """See `ClockArea`."""
        return self.area(Fraction(self.period))

    def within_period(self, area: Fraction, time_base: int) -> Fraction:
        """See `ClockArea`; the first whole time unit."""
        # The areas of most scenarios repeat after some periods.
        key = (area, time_base)
        if key not in self._known:
            self._known[key] = Fraction(self._first_unit(area, time_base))
        return self._known[key]

    def _first_unit(self, area: Fraction, time_base: int) -> int:
        """The root by the Illinois method, with a bisection now and then that makes it certain to end."""
        low, high = 0, self.period * time_base
        below, above = float(-area), float(self.of_period - area)
        was_low: bool | None = None
        for step in count(1):
            if high - low <= 1:
                break
            share = below / (below - above) if step % 4 else 0.5
            middle = min(max(low + int((high - low) * share), low + 1), high - 1)
            difference = self.area(Fraction(middle, time_base)) - area
            is_low = difference < 0
            if is_low:
                low, below = middle, float(difference)
                above /= 2 if was_low else 1
            else:
                high, above = middle, float(difference)
                below /= 2 if was_low is False else 1
            was_low = is_low
        return high


def clock_area(clock: Clock) -> ClockArea:
    """The integral of the frequency of a clock.

    Raises
    ------
    UnknownError : the period is not positive, or a frequency is negative.
    """
    if clock.period is not None and clock.period <= 0:
        raise UnknownError(f"the period of the clock {clock.name!r} is not positive")
    match clock:
        case ClockSteps():
            return _steps(clock)
        case ClockFunction(lowest=lowest, swing=swing, curve=curve):
            if lowest < 0 or swing < 0:
                raise UnknownError(f"a frequency of the clock {clock.name!r} is negative")
            return CurveArea(clock.period, _sine(clock) if curve is Curve.SINE else _triangle(clock))


def _steps(clock: ClockSteps) -> ClockArea:
    """The frequency is 0 before the first step, in each period; without a period, the last one stays."""
    times, areas, frequencies = [0], [Fraction(0)], [Fraction(0)]
    for step in sorted(clock.steps, key=lambda step: step.time):
        if step.frequency < 0:
            raise UnknownError(f"a frequency of the clock {clock.name!r} is negative")
        if clock.period is not None and step.time >= clock.period:
            break
        start = max(0, step.time)
        areas.append(areas[-1] + frequencies[-1] * (start - times[-1]) / SECOND)
        times.append(start)
        frequencies.append(Fraction(step.frequency))
    return StepArea(clock.period, tuple(times), tuple(areas), tuple(frequencies))


def _triangle(clock: ClockFunction) -> Callable[[Fraction], Fraction]:
    """Lines between the lowest and the highest frequency; the rising one passes the middle at the shift."""
    lowest, swing, period = Fraction(clock.lowest), Fraction(clock.swing), clock.period

    def from_minimum(time: Fraction) -> Fraction:
        rounds, rest = divmod(time, period)
        rising = min(rest, Fraction(period, 2))
        falling = rest - rising
        # The rising line is 2 * swing * time / period above the lowest frequency.
        above = swing * (rising * rising + falling * (period - falling)) / period
        return lowest * time + rounds * swing * period / 2 + above

    start = Fraction(period, 4) - clock.shift
    at_0 = from_minimum(start)
    return lambda time: (from_minimum(start + time) - at_0) / SECOND


def _sine(clock: ClockFunction) -> Callable[[Fraction], Fraction]:
    """A sine between the lowest and the highest frequency; it rises through the middle at the shift."""
    middle, period = clock.lowest + Fraction(clock.swing) / 2, clock.period
    # The integral of a sine is the difference of two cosines, times its amplitude, divided by its angular frequency.
    factor = Fraction(clock.swing) * period / (4 * _PI)
    at_0 = _cosine(Fraction(-clock.shift, period))
    return lambda time: (middle * time + factor * (at_0 - _cosine((time - clock.shift) / period))) / SECOND


def _cosine(turns: Fraction) -> Fraction:
    """The cosine of an angle in turns, by its Taylor series."""
    angle = turns % 1
    angle = min(angle, 1 - angle)
    if angle > Fraction(1, 4):
        return -_cosine(Fraction(1, 2) - angle)
    square = int((2 * _PI * angle) ** 2 * _ONE)
    total = term = _ONE
    for number in count(1, 2):
        term = -term * square // _ONE // (number * (number + 1))
        # A negative term is rounded down, and thus never becomes 0.
        if term in (0, -1):
            break
        total += term
    return Fraction(total, _ONE)
