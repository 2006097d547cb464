"""By how much execution times may change before a verdict does.

They are multiplied by a factor, all of them as a slower clock would do, or those of one process; the greatest factor is found by
bisection, since more load never shortens a response time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from amalthea_uros.analyze.results import Analysis
from amalthea_uros.analyze.system import analyze_system
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


def sensitivity(analysis: Analysis) -> Sensitivity:
    """The greatest factors; deadlines and requirements that cannot be judged do not count."""
    return Sensitivity(
        everything=greatest_scale(analysis),
        processes={process.name: _greatest_of(process.name, analysis) for process in analysis.processes},
    )


def greatest_scale(analysis: Analysis) -> Fraction | None:
    """The greatest factor on all execution times."""
    context = analysis.solution.context
    scale = context.settings.scale
    return _greatest(lambda factor: _holds(analysis, factor, replace(context.settings, scale=scale * factor)))


def _greatest_of(name: str, analysis: Analysis) -> Fraction | None:
    settings = analysis.solution.context.settings

    def holds(factor: Fraction) -> bool:
        factors = {**settings.factors, name: settings.factors.get(name, 1) * factor}
        return _holds(analysis, factor, replace(settings, factors=factors))

    return _greatest(holds)


def _holds(analysis: Analysis, factor: Fraction, settings: Settings) -> bool:
    """Whether nothing is missed with changed settings; a factor of 1 changes nothing."""
    changed = analysis if factor == 1 else analyze_system(analysis.solution.context.system, settings)
    return not changed.misses


def _greatest(holds: Callable[[Fraction], bool]) -> Fraction | None:
    low, high = (1000, 2000) if holds(Fraction(1)) else (0, 1000)
    while low and high * STEP < GREATEST and holds(high * STEP):
        low, high = high, high * 2
    while high - low > max(1, low // 1000):
        middle = (low + high) // 2
        low, high = (middle, high) if holds(middle * STEP) else (low, middle)
    return low * STEP if low else None
