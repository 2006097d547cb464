"""Predictions of a system compared with a measurement: whether the model holds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction

from amalthea_uros._internal.records import dataclass, field, replace
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.compare.agreement import LEAST, Rule, compared
from amalthea_uros.compare.bases import bases
from amalthea_uros.compare.distributions import distributions
from amalthea_uros.compare.findings import assumptions_of, findings_of, open_phases
from amalthea_uros.compare.limits import judge_limits
from amalthea_uros.compare.measured.events import begins_of
from amalthea_uros.compare.naming import Names, Target, targets
from amalthea_uros.compare.not_measured import losses, not_measured
from amalthea_uros.compare.phases import analyses_in_phases
from amalthea_uros.compare.predictions import Predictor
from amalthea_uros.compare.results import Agreement, Comparison, ComparisonRow, PredictionSource
from amalthea_uros.compare.simulated import Run, simulate_measured
from amalthea_uros.errors import InvalidArgumentError, UnknownError
from amalthea_uros.measure.series import Measurement
from amalthea_uros.names import require
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.demand.overheads import processes_with_overhead
from amalthea_uros.timing.stated_distributions import Basis
from amalthea_uros.units import SECOND, Time

DEFAULT_TOLERANCE = Fraction(20, 100)
EVERY_SOURCE = tuple(PredictionSource)


@dataclass(frozen=True, slots=True, kw_only=True)
class CompareOptions:
    """How predictions and measurements are compared.

    Attributes
    ----------
    tolerance : of deviations, relative to the measurement
    sources : what predicts
    duration : of the simulation; None: as long as the measurement
    names : which measured series is what in the model
    overheads : process -> what is added to its predicted execution and response times; "" stands for all others
    uncertainty : by how much a measured time may be wrong; None: by less than a step of its time stamps
    """

    tolerance: Fraction = DEFAULT_TOLERANCE
    sources: tuple[PredictionSource, ...] = EVERY_SOURCE
    duration: Time | None = None
    seed: int = 1
    names: Names = field(default_factory=Names)
    overheads: Mapping[str, Time] = field(default_factory=dict)
    uncertainty: Time | None = None

    def __post_init__(self) -> None:
        if not self.sources:
            raise InvalidArgumentError("nothing predicts; compare by analysis, simulation, or both")
        if self.uncertainty is not None and self.uncertainty < 0:
            raise InvalidArgumentError("an uncertainty must not be negative")


def compare_measured(system: System, settings: Settings, measurement: Measurement, options: CompareOptions) -> Comparison:
    """What predicts the measured values, beside them, and the limits judged by them.

    Raises
    ------
    InvalidArgumentError : the options name what does not exist, or two series are the same quantity.
    """
    require("process", filter(None, options.overheads), system.processes)
    analysis = analyze_system(system, settings) if PredictionSource.ANALYSIS in options.sources else None
    with_overhead = processes_with_overhead(system) | options.overheads.keys()
    begins = begins_of(system)
    found = targets(measurement, options.names, system, with_overhead, begins)
    runs: tuple[Run, ...] = ()
    if PredictionSource.SIMULATION in options.sources:
        runs = simulate_measured(system, settings, options.duration or measurement.duration or SECOND, options.seed)
    simulation = runs[0].simulation if runs else None
    in_phases = () if analysis is None or runs else analyses_in_phases(analysis, system, settings)
    predictor = Predictor(analysis=analysis, host=system.host, runs=runs, in_phases=in_phases, overheads=options.overheads)
    uncertainty = measurement.resolution if options.uncertainty is None else options.uncertainty
    rule = Rule(
        tolerance=options.tolerance,
        uncertainty=uncertainty or 0,
        is_reached=options.uncertainty is not None and uncertainty != 0,
    )
    basis_of = bases(system, settings)
    rows = (
        *(row for target in found for row in _rows(target, predictor, rule, basis_of)),
        *not_measured(system, found, begins),
    )
    comparison = Comparison(
        model="",
        measurement=measurement,
        tolerance=options.tolerance,
        uncertainty=uncertainty,
        rows=rows,
        limits=tuple(judge_limits(system, settings, found, rule)),
        distributions=tuple(distributions(found, rows, runs, rule, options.overheads, basis_of)),
        losses=tuple(losses(found, simulation)),
        duration=None if simulation is None else simulation.duration,
        seed=None if simulation is None else simulation.seed,
        assumptions=assumptions_of(measurement, found, options.overheads, analysis, simulation),
    )
    of_predictions = (each.findings for each in (analysis, simulation) if each is not None)
    reported = (*measurement.findings, *(finding for each in of_predictions for finding in each))
    own = findings_of(comparison, found, open_phases(system, settings))
    return replace(comparison, findings=tuple(dict.fromkeys((*reported, *own))))


def _rows(target: Target, predictor: Predictor, rule: Rule, basis_of: Callable[[Target], Basis]) -> Iterator[ComparisonRow]:
    series = target.series
    nothing = ComparisonRow(
        object=target.name,
        kind=series.kind,
        quantity=target.quantity,
        statistic=None,
        verdict=Agreement.NOT_PREDICTED,
        samples=0 if series.statistics is None else series.statistics.count,
        reason=target.reason,
        series=series,
    )
    if target.reason:
        yield nothing
        return
    if series.statistics is None:
        yield replace(nothing, verdict=Agreement.NOT_MEASURED, reason="no value could be measured")
        return
    try:
        predictions = predictor.of(target.kind, target.name, target.quantity)
    except UnknownError as missing:
        yield replace(nothing, reason=str(missing))
        return
    chosen = {statistic: predictions[statistic] for statistic in target.statistics}
    rows = list(compared(replace(series, kind=target.kind), target.name, target.quantity, chosen, rule, basis_of(target)))
    yield from rows or [replace(nothing, reason=LEAST if series.is_least else _UNLIKE)]


_UNLIKE = "no prediction has the definition of what was measured"
