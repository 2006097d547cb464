"""When stimuli occur."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.distributions import Distribution
from amalthea_uros.perf.stimuli import (
    ArrivalCurve,
    Burst,
    Custom,
    EventTriggered,
    InterProcess,
    Periodic,
    RelativePeriodic,
    Scenario,
    Single,
    Stimulus,
    Synthetic,
    VariableRate,
)
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.arrivals.arrival_curve import FOLLOWS, STARTS_AT_0, arrival_curve, limits_of
from amalthea_uros.simulate.arrivals.occurrences import OccurrenceBlock, OccurrenceBlocks, StimulusOccurrences, block_size
from amalthea_uros.simulate.arrivals.periodic import AT_0, NO_LONGER, before_0, burst, periodic, relative, synthetic
from amalthea_uros.simulate.arrivals.rates import scenario, variable_rate
from amalthea_uros.simulate.options import SimulationMode
from amalthea_uros.simulate.sampling.variates import sampling_assumption
from amalthea_uros.simulate.sampling.words import RandomSource
from amalthea_uros.units import Time


def occurrences(
    stimulus: Stimulus, system: System, mode: SimulationMode, source: RandomSource, time_base: int
) -> StimulusOccurrences:
    """The occurrences of a stimulus; those that processes or events trigger have none of their own.

    Parameters
    ----------
    time_base : time units in a picosecond

    Raises
    ------
    UnknownError : its attributes are invalid or contradict each other, or it has no meaning.
    """
    return StimulusOccurrences(_blocks(stimulus, system, mode, source, time_base), tuple(_assumptions(stimulus, mode)))


def least_count(stimulus: Stimulus, duration: Time) -> int:
    """How often a stimulus occurs at least in a duration from 0, where its attributes say so directly; 0 for all others."""
    match stimulus:
        case Periodic(period=period, offset=offset) if period > 0:
            return max(0, (duration - offset) // period)
        case Synthetic(period=period, offset=offset, times=times) if period > 0:
            return max(0, (duration - offset - max(times, default=0)) // period) * len(times)
        case _:
            return 0


def _blocks(stimulus: Stimulus, system: System, mode: SimulationMode, source: RandomSource, time_base: int) -> OccurrenceBlocks:
    match stimulus:
        case Periodic():
            return periodic(stimulus, mode, source, time_base)
        case RelativePeriodic():
            return relative(stimulus, mode, source, time_base)
        case Synthetic():
            return synthetic(stimulus, time_base)
        case Burst():
            return burst(stimulus, time_base)
        case Single(time=time):
            block_size(abs(time) * time_base)
            return iter([OccurrenceBlock(time * time_base, np.array([time * time_base], np.int64))])
        case VariableRate(scenario=Scenario() as driven):
            return scenario(driven, system, time_base)
        case VariableRate():
            return variable_rate(stimulus, mode, source, time_base)
        case ArrivalCurve():
            return arrival_curve(limits_of(stimulus), mode, source, time_base)
        case Custom():
            raise UnknownError("it does not say when it occurs")
        case InterProcess() | EventTriggered():
            return iter(())


def _assumptions(stimulus: Stimulus, mode: SimulationMode) -> Iterator[str]:
    """What is assumed beyond what a stimulus says."""
    distribution: Distribution[int] | Distribution[float] | None = None
    match stimulus:
        case Periodic(jitter=distribution):
            if before_0(stimulus, mode):
                yield AT_0
        case RelativePeriodic(distance=distribution, has_maximum=has_maximum):
            if not has_maximum and mode is not SimulationMode.WORST:
                yield NO_LONGER
        case VariableRate(rate=distribution, scenario=None):
            pass
        case ArrivalCurve():
            yield STARTS_AT_0
            if mode is not SimulationMode.WORST and not limits_of(stimulus).upper:
                yield FOLLOWS
    if distribution is not None and mode is SimulationMode.SAMPLED and (sentence := sampling_assumption(distribution)):
        yield sentence
