"""Times in the agent from measured round trips: a fit, made only where the user asks for it.

A round trip does not show where its time passes. The simulated one without any time in the agent is subtracted, and the rest
is divided equally between the directions that are fitted: the shortest round trips give the minimum, the longest ones the
maximum. If they differ by less than the simulated ones without it, their mean gives one time.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import ceil, floor

from amalthea_uros.compare.calibration.options import AgentFit, CalibrationOptions
from amalthea_uros.compare.calibration.samples import Measured, Samples, samples_of
from amalthea_uros.compare.calibration.values import CalibratedValue, Outcome, calibrated
from amalthea_uros.design.description.assign import Assignment, apply_assignments
from amalthea_uros.design.description.text_edits import Path
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.measure.series import WHOLE_TIME
from amalthea_uros.names import require
from amalthea_uros.perf.system import System
from amalthea_uros.simulate.observations import MetricObservation
from amalthea_uros.simulate.options import Options
from amalthea_uros.simulate.runs.run import simulate_system
from amalthea_uros.timing.basics.quantities import ChainQuantity
from amalthea_uros.units import MICROSECOND, SECOND, Duration, Time, time_text
from amalthea_uros.uros.described import Described, describe_text

#: Simulated at least, and where the measurement does not say how long it was.
_SHORTEST = 10 * SECOND
_QUANTITIES = (WHOLE_TIME, ChainQuantity.REDUCED_REACTION_TIME)


def calibrated_agent_times(
    measured: Sequence[Measured], text: str, described: Described, options: CalibrationOptions
) -> Iterator[CalibratedValue]:
    """The fitted times.

    Raises
    ------
    InvalidArgumentError : a fit names a chain that the description does not have, or that was not measured.
    """
    require("chain", (fit.chain for fit in options.fits), described.assembly.system.chains)
    for fit in options.fits:
        own = [each for each in measured if _is_round_trip(each, fit)]
        if not own:
            advice = f"give them as a table, e.g. --column 'rtt_ms={fit.chain}'"
            raise InvalidArgumentError(f"no round trips of {fit.chain!r} were measured at the host; {advice}")
        yield from _fitted(fit, samples_of(own, options.judge_on), _without_agent(fit, text, own))


def _is_round_trip(measured: Measured, fit: AgentFit) -> bool:
    """Whether it was measured from the host to the host: in traces, a chain begins at the controller."""
    series = measured.series
    return series.name == fit.chain and not series.begin and series.statistics is not None and series.quantity in _QUANTITIES


def _without_agent(fit: AgentFit, text: str, measured: Sequence[Measured]) -> MetricObservation | str:
    """The simulated round trip without the times that are fitted; a text says why there is none."""
    without = apply_assignments(text, [Assignment(key, _path(key), "0 ms") for key in fit.keys])
    system: System = describe_text(without).assembly.system
    duration: Time = max(_SHORTEST, *(each.source.duration for each in measured))
    chain = simulate_system(system, Options(duration=Duration(duration))).chains[fit.chain]
    return chain.quantities.get(ChainQuantity.REDUCED_REACTION_TIME) or chain.reason or "the simulation has no round trip"


def _fitted(fit: AgentFit, samples: Samples, without: MetricObservation | str) -> Iterator[CalibratedValue]:
    if isinstance(without, str):
        reason, lower, upper = without, 0, 0
    else:
        number = len(fit.keys) * MICROSECOND
        lower = floor((samples.statistics.min - without.min) / number) * MICROSECOND
        upper = ceil((samples.statistics.max - without.max) / number) * MICROSECOND
        reason = ""
        if lower < 0:
            reason = f"without any time in the agent, the shortest simulated round trip takes {time_text(round(without.min))}"
        elif upper < lower:
            # Other times of the chain vary by more than was measured: only the mean says something.
            lower = upper = round((samples.statistics.mean - without.mean) / number) * MICROSECOND
    for key in fit.keys:
        if reason:
            yield calibrated(key, samples, Outcome.NOT_WRITTEN, reason)
            continue
        value = {"min": time_text(lower), "max": time_text(upper)} if lower < upper else time_text(lower)
        share = "" if len(fit.keys) == 1 else ", divided equally between both directions"
        remark = f"a fit: what the simulation without it leaves of the round trip {fit.chain}{share}"
        yield calibrated(
            key, samples, Outcome.WRITTEN, path=_path(key), assignment=Assignment(key, _path(key), value), remark=remark
        )


def _path(key: str) -> Path:
    return ("middleware", *key.split("."))
