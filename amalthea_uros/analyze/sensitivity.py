"""By how much execution times may change before a verdict does.

They are multiplied by a factor, all of them as a slower clock would do, or those of one process; the greatest factor is found by
bisection, since more load never shortens a response time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.system import System
from amalthea_uros.timing.settings import Settings

#: Factors below 1 are told to a thousandth, those above to a thousandth of themselves.
STEP = Fraction(1, 1000)
#: Greater factors say no more than that there is room.
GREATEST = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensitivity:
    """The greatest factors on execution times with which nothing is missed; None where no factor helps.

    Attributes
    ----------
    everything : on all of them, on top of the scale of the analysis
    processes : on those of one process
    """

    everything: Fraction | None
    processes: Mapping[str, Fraction | None]


def sensitivity(system: System, settings: Settings | None = None) -> Sensitivity:
    """The greatest factors; deadlines and requirements that cannot be judged do not count."""
    settings = settings or Settings()
    return Sensitivity(
        everything=greatest_scale(system, settings),
        processes={name: _greatest_of(name, system, settings) for name in system.processes},
    )


def greatest_scale(system: System, settings: Settings | None = None) -> Fraction | None:
    """The greatest factor on all execution times."""
    settings = settings or Settings()
    return _greatest(lambda factor: not analyze_system(system, replace(settings, scale=settings.scale * factor)).misses)


def _greatest_of(name: str, system: System, settings: Settings) -> Fraction | None:
    def holds(factor: Fraction) -> bool:
        factors = {**settings.factors, name: settings.factors.get(name, 1) * factor}
        return not analyze_system(system, replace(settings, factors=factors)).misses

    return _greatest(holds)


def _greatest(holds: Callable[[Fraction], bool]) -> Fraction | None:
    low, high = (1000, 2000) if holds(Fraction(1)) else (0, 1000)
    while low and high * STEP < GREATEST and holds(high * STEP):
        low, high = high, high * 2
    while high - low > max(1, low // 1000):
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle * STEP) else (low, middle)
    return low * STEP if low else None
