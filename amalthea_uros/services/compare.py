"""Predictions of a model compared with a measurement: whether the model holds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from amalthea_uros._internal.paths import StrPath
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.compare.agreement import LEAST, Rule, compared
from amalthea_uros.compare.distributions import distributions
from amalthea_uros.compare.findings import assumptions_of, findings_of, open_phases
from amalthea_uros.compare.limits import judge_limits
from amalthea_uros.compare.measured.events import chain_starts
from amalthea_uros.compare.naming import Names, Target, targets
from amalthea_uros.compare.phases import analyses_in_phases, systems_in_phases
from amalthea_uros.compare.predictions import Missing, Predictor
from amalthea_uros.compare.results import (
    Agreement,
    Comparison,
    ComparisonRow,
    MeasuredLimit,
    Source,
)
from amalthea_uros.compare.simulated import Run, simulate_measured
from amalthea_uros.design.changes.apply import apply
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.changes.key import Configuration
from amalthea_uros.design.changes.timing_changes import described
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.judge.verdict import ObservedVerdict
from amalthea_uros.measure.chains import BEGINS
from amalthea_uros.measure.series import MeasuredKind, Measurement
from amalthea_uros.names import require
from amalthea_uros.perf.system import System
from amalthea_uros.services.inputs import as_paths
from amalthea_uros.services.measure import MeasureOptions, measure_file
from amalthea_uros.services.names import require_settings
from amalthea_uros.services.simulate import time_of
from amalthea_uros.services.subject import Subject, open_subject, paths_of, reusable
from amalthea_uros.services.what_if import Changes, as_changes
from amalthea_uros.timing.activation.releases import with_first_arrivals
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.demand.overheads import processes_with_overhead
from amalthea_uros.timing.stated_distributions import Basis, StatedDistributions
from amalthea_uros.trace.table import EventKind
from amalthea_uros.units import SECOND, Time

if TYPE_CHECKING:
    pass

#: What was measured, or the trace to measure.
Measured: TypeAlias = "Measurement | StrPath | Iterable[StrPath]"

DEFAULT_TOLERANCE = Fraction(20, 100)
_EVERYTHING = tuple(Source)


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
    sources: tuple[Source, ...] = _EVERYTHING
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


def compare(
    subject: Subject,
    measured: Measured,
    *,
    tolerance: str | float | Fraction = DEFAULT_TOLERANCE,
    by: Iterable[Source | str] = _EVERYTHING,
    duration: str | Time | None = None,
    seed: int = 1,
    names: Names | None = None,
    overheads: Mapping[str, Time] | None = None,
    uncertainty: Time | None = None,
    settings: Settings | None = None,
    changes: Changes = (),
) -> Comparison:
    """Compare what the analysis and a simulation of a system predict with what was measured.

    >>> print(compare("app.yaml", "run.log"))  # doctest: +SKIP

    Parameters
    ----------
    subject : as for `analyze`
    measured : what `measure` returned, or the files of a trace
    tolerance : of deviations, as a share of the measurement: "20 %" or 0.2
    by : "analysis", "simulation", or both
    duration : of the simulation, such as "1 s", or picoseconds; None: as long as the measurement
    names : which measured series is what in the model, where the names differ
    overheads : process -> picoseconds that are added to its predicted execution and response times; "" stands for all others
    uncertainty : by how many picoseconds a measured time may be wrong; None: by less than a step of its time stamps

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : a name, a value or the tolerance is wrong.
    """
    options = CompareOptions(
        tolerance=parse_tolerance(tolerance),
        sources=tuple(_source(each) for each in by),
        duration=None if duration is None else time_of(duration),
        seed=seed,
        names=names or Names(),
        overheads=overheads or {},
        uncertainty=uncertainty,
    )
    return _run(subject, measured, MeasureOptions(), options, settings or Settings(), as_changes(changes))


def compare_files(
    model: StrPath,
    traces: Sequence[StrPath],
    options: CompareOptions,
    reading: MeasureOptions,
    *,
    settings: Settings | None = None,
    changes: Sequence[Change] = (),
) -> Comparison:
    """Compare what a model in files predicts with what is measured in traces.

    Parameters
    ----------
    reading : how the traces are measured
    changes : of the system and the settings, made first

    Raises
    ------
    ReadError, InvalidArgumentError : as for `compare`.
    """
    return _run(model, traces, reading, options, settings or Settings(), tuple(changes))


def _run(
    subject: Subject,
    measured: Measured,
    reading: MeasureOptions,
    options: CompareOptions,
    settings: Settings,
    changes: Sequence[Change],
) -> Comparison:
    given = reusable(subject)
    opened = open_subject(given)
    configuration = Configuration(opened.system, settings)
    require_settings(settings, opened.system)
    differences = described(configuration, changes)
    system, settings = apply(*configuration, changes)
    found = _compared(system, settings, _measured(measured, reading, system), options)
    return replace(
        found,
        model=" ".join(map(str, paths_of(given) or ())),
        differences=differences,
        findings=unsuppressed((*opened.findings, *found.findings)),
    )


def parse_tolerance(value: str | float | Fraction) -> Fraction:
    """A tolerance as a share: "20 %", "0.2" or 0.2.

    Raises
    ------
    InvalidArgumentError : it is none, or a number above 1, which may be meant in percent.
    """
    text = str(value).strip()
    number, percent = text.removesuffix("%").strip(), text.endswith("%")
    try:
        share = Fraction(number) / (100 if percent else 1)
    except (ValueError, ZeroDivisionError):
        raise InvalidArgumentError(f"{value!r} is not a tolerance such as '20%'") from None
    if share < 0 or (share > 1 and not percent):
        raise InvalidArgumentError(f"{value!r} is not a tolerance from 0 to 1; write percent as in '20%'")
    return share


def _source(name: Source | str) -> Source:
    require("source of predictions", [name], _EVERYTHING)
    return Source(name)


def _measured(measured: Measured, reading: MeasureOptions, system: System) -> Measurement:
    """What was measured, or is now: of chains what begins as in the model."""
    if isinstance(measured, Measurement):
        return measured
    from amalthea_uros.compare.traces import joined

    reading = replace(reading, chain_starts=chain_starts(system))
    return joined([measure_file(path, reading) for path in as_paths(measured)])


def _compared(system: System, settings: Settings, measurement: Measurement, options: CompareOptions) -> Comparison:
    require("process", filter(None, options.overheads), system.processes)
    analysis = analyze_system(system, settings) if Source.ANALYSIS in options.sources else None
    with_overhead = processes_with_overhead(system) | options.overheads.keys()
    found = tuple(_of_same_begin(targets(measurement, options.names, system, with_overhead), chain_starts(system)))
    _refuse_twice(found)
    runs = _simulated(system, settings, options, measurement) if Source.SIMULATION in options.sources else ()
    simulation = runs[0].simulation if runs else None
    in_phases = () if analysis is None or runs else analyses_in_phases(analysis, system, settings)
    predictor = Predictor(analysis=analysis, runs=runs, in_phases=in_phases, overheads=options.overheads)
    uncertainty = measurement.resolution if options.uncertainty is None else options.uncertainty
    rule = Rule(
        tolerance=options.tolerance,
        uncertainty=uncertainty or 0,
        is_reached=options.uncertainty is not None and uncertainty != 0,
    )
    basis_of = _bases(system, settings)
    rows = (*(row for target in found for row in _rows(target, predictor, rule, basis_of)), *_not_measured(system, found))
    comparison = Comparison(
        model="",
        measurement=measurement,
        tolerance=options.tolerance,
        uncertainty=uncertainty,
        rows=rows,
        limits=tuple(_with_doubt(limit, rule) for limit in judge_limits(system, settings, found)),
        distributions=tuple(distributions(found, rows, runs, rule, options.overheads, basis_of)),
        duration=None if simulation is None else simulation.duration,
        seed=None if simulation is None else simulation.seed,
        assumptions=assumptions_of(measurement, found, options.overheads, analysis, simulation),
    )
    of_predictions = (each.findings for each in (analysis, simulation) if each is not None)
    reported = (*measurement.findings, *(finding for each in of_predictions for finding in each))
    own = findings_of(comparison, found, open_phases(system, settings))
    return replace(comparison, findings=tuple(dict.fromkeys((*reported, *own))))


def _with_doubt(limit: MeasuredLimit, rule: Rule) -> MeasuredLimit:
    """A limit that was kept, with the remark that it may have been missed if the measured time is wrong."""
    is_near = limit.is_time and limit.margin is not None and limit.margin < rule.uncertainty
    if limit.verdict is not ObservedVerdict.OK or not is_near:
        return limit
    return replace(limit, reason="the distance from the limit is within the uncertainty of the measurement")


def _of_same_begin(found: Iterable[Target], starts: Mapping[str, EventKind | None]) -> Iterator[Target]:
    """The targets; chains that were measured from another event of a job on than in the model have no counterpart."""
    for target in found:
        measured, modelled = target.series.begin, starts.get(target.name, EventKind.ACTIVATE)
        if not measured or target.reason or (modelled is not None and measured == BEGINS[modelled]):
            yield target
        elif modelled is None:
            yield replace(target, reason=_WITHIN_A_JOB)
        else:
            begins = (
                f"it was measured from the {measured} of its first job on, and begins in the model with its {BEGINS[modelled]}"
            )
            yield replace(target, reason=f"{begins}; measure it with the model")


_WITHIN_A_JOB = "it begins or ends within a job, at an event that is not in traces; measure it between markers"


def _refuse_twice(found: Iterable[Target]) -> None:
    """Refuse that two series are the same quantity: which of them is meant is not known."""
    series: dict[tuple[MeasuredKind, str, str], list[str]] = {}
    for target in found:
        if not target.reason:
            series.setdefault((target.kind, target.name, target.quantity), []).append(target.series.name)
    for (_, name, quantity), names in series.items():
        if len(names) > 1:
            listed = " and ".join(map(repr, names))
            raise InvalidArgumentError(f"{listed} of the trace are both {name}.{quantity}; leave one of them out")


def _simulated(system: System, settings: Settings, options: CompareOptions, measurement: Measurement) -> tuple[Run, ...]:
    """A run as long as the measurement, and others in other phases."""
    duration = options.duration or measurement.duration or SECOND
    return simulate_measured(system, settings, duration, options.seed)


def _bases(system: System, settings: Settings) -> Callable[[Target], Basis]:
    """What the distributions of what is compared follow from."""
    are_phases_open = systems_in_phases(system, settings) is None
    stated = StatedDistributions(with_first_arrivals(system, settings.phases), settings, are_phases_open)

    def basis_of(target: Target) -> Basis:
        match target.kind:
            case MeasuredKind.CHAIN:
                return stated.of_chain(target.name)
            case MeasuredKind.RUNNABLE:
                return stated.of_runnable(target.name, target.quantity)
        return stated.of_process(target.name, target.quantity)

    return basis_of


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
    except Missing as missing:
        yield replace(nothing, reason=str(missing))
        return
    chosen = {statistic: predictions[statistic] for statistic in target.statistics}
    rows = list(compared(replace(series, kind=target.kind), target.name, target.quantity, chosen, rule, basis_of(target)))
    yield from rows or [replace(nothing, reason=LEAST if series.is_least else _UNLIKE)]


_UNLIKE = "no prediction has the definition of what was measured"


_NOT_IN_TRACE = {
    MeasuredKind.PROCESS: "the trace has no process of this name",
    MeasuredKind.CHAIN: "the trace has no values of this chain",
}


def _not_measured(system: System, found: Sequence[Target]) -> Iterator[ComparisonRow]:
    """A row for each process and chain of which the trace has nothing, or nothing of the same definition."""
    starts = chain_starts(system)
    measured = {(target.kind, target.name) for target in found}
    for kind, names in ((MeasuredKind.PROCESS, system.processes), (MeasuredKind.CHAIN, system.chains)):
        for name in names:
            if (kind, name) not in measured:
                yield ComparisonRow(
                    object=name,
                    kind=kind,
                    quantity="",
                    statistic=None,
                    verdict=Agreement.NOT_MEASURED,
                    reason=_WITHIN_A_JOB if starts.get(name, ...) is None else _NOT_IN_TRACE[kind],
                )
