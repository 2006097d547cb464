"""By how much execution times may grow before a verdict changes.

All of them are multiplied by one factor, as a slower clock would do; the greatest factor is found by bisection, since more load never
shortens a response time.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from amalthea_uros.analyze.settings import Settings
from amalthea_uros.analyze.system import analyze
from amalthea_uros.perf.system import System

#: Factors are told to a thousandth.
STEP = Fraction(1, 1000)
#: Greater factors say no more than that there is room.
GREATEST = Fraction(1000)


def greatest_scale(system: System, settings: Settings | None = None) -> Fraction | None:
    """The greatest factor on all execution times with which nothing is missed, to a thousandth; None if none is small enough.

    Deadlines and requirements that cannot be judged do not count.
    """

    def holds(steps: int) -> bool:
        return not analyze(system, replace(settings or Settings(), scale=steps * STEP)).misses

    low, high = 0, 1
    while high * STEP < GREATEST and holds(high):
        low, high = high, high * 2
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle) else (low, middle)
    return low * STEP if low else None
