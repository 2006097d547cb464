"""Systems whose phases are unknown: each of their phases is possible, and a measured system has one of them."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.perf.system import System
from amalthea_uros.timing.activation.releases import (
    phase_combinations,
    phase_count,
    unstated_phases,
    with_first_arrivals,
    with_phases,
)
from amalthea_uros.timing.basics.settings import Settings

#: More phases are not evaluated one by one.
MOST_PHASES = 32


def systems_in_phases(system: System, settings: Settings) -> Iterator[System] | None:
    """The system in each of its unknown phases, nothing if all phases are known; None if there are too many."""
    unknown = unstated_phases(system, settings.phases)
    if not unknown:
        return iter(())
    if phase_count(unknown) > MOST_PHASES:
        return None
    known = with_first_arrivals(system, settings.phases)
    return (with_phases(known, combination) for combination in phase_combinations(unknown))


def analyses_in_phases(analysis: Analysis, system: System, settings: Settings) -> tuple[Analysis, ...]:
    """The analysis, or one in each of the unknown phases; none if there are too many of them.

    What an analysis says of all phases together, such as a mean over them, is none of a system that has one of these phases.
    """
    variants = systems_in_phases(system, settings)
    if variants is None:
        return ()
    return tuple(analyze_system(each, settings) for each in variants) or (analysis,)
