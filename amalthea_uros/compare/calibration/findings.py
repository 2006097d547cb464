"""Findings about measured values and the description."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.compare.calibration.options import CalibrationOptions, Form
from amalthea_uros.compare.calibration.samples import Measured
from amalthea_uros.compare.calibration.values import CalibratedValue, Outcome
from amalthea_uros.compare.calibration.wording import statistics_text
from amalthea_uros.design.description.built_objects import BuiltObjects
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.measure.baselines import subtracted_objects
from amalthea_uros.measure.series import MeasuredKind
from amalthea_uros.names import listed
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.uros.described import Described


def findings_of(
    path: Path,
    text: str,
    values: Sequence[CalibratedValue],
    measured: Sequence[Measured],
    description: Described,
    built: BuiltObjects,
    options: CalibrationOptions,
) -> Iterator[Finding]:
    """What has to be said about a calibration."""
    lines = text.replace("\r\n", "\n").split("\n")
    for value in values:
        place = None if value.line is None else Location(path, value.line, None, lines[value.line - 1])
        yield from _about(value, place)
    written = [value for value in values if value.outcome is Outcome.WRITTEN and value.target.endswith(".execution_time")]
    if written:
        margin = (
            "" if options.form is Form.HISTOGRAM else f"; the margin of {float(options.margin * 100):.4g} % is an assumption"
        )
        message = f"measured maxima are high-water marks, not bounds: longer execution times can occur{margin}"
        advice = "Measure longer and with other inputs, or replace them by bounds that are derived otherwise."
        yield Finding("CAL002", Severity.INFO, message, Location(path), advice)
    gross = sorted({each.series.name for each in measured if _is_gross(each, values)})
    if gross:
        message = f"gross times, which include preemption by other processes, count as execution times of {listed(gross)}"
        advice = "Trace the processes so that net execution times are known, or measure while nothing preempts them."
        yield Finding("CAL005", Severity.WARNING, message, Location(path), advice)
    yield from _unknown(path, measured, description, built)
    missing = sorted(description.assembly.system.processes.keys() - {name for value in values for name in _names(value)})
    if missing:
        message = f"not measured: {listed(missing)}"
        yield Finding("CAL006", Severity.INFO, message, Location(path))


def _unknown(path: Path, measured: Sequence[Measured], description: Described, built: BuiltObjects) -> Iterator[Finding]:
    """The objects of the trace that have no place in the description, with what they may be."""
    known, chains = description.assembly.system.processes, description.assembly.system.chains
    topics = {message.topic for callback in built.callbacks for message in (callback.incoming, *callback.outgoing) if message}
    series = [each.series for each in measured]
    used = subtracted_objects(series)
    names = dict.fromkeys(each.name for each in series if each.kind is not MeasuredKind.CHAIN and each.name not in used)
    for name in names:
        if not built.knows(name) and name not in known and name not in topics and name not in chains:
            advice = did_you_mean(name, known)
            message = f"the description has no process or function {name!r}, so what was measured of it is not used"
            yield Finding(
                "CAL008", Severity.INFO, message, Location(path), f"{advice[:1].upper()}{advice[1:]}" if advice else ""
            )


def _about(value: CalibratedValue, place: Location | None) -> Iterator[Finding]:
    if value.refuted:
        stated = f" ({value.before})" if value.before else ""
        message = f"the measurement refutes {value.target}{stated}: {statistics_text(value.statistics)}"
        done = f"Now {value.after}." if value.after else "Correct it in the description."
        yield Finding("CAL001", Severity.ERROR, message, place, done)
    if value.outcome is Outcome.NOT_WRITTEN:
        yield Finding("CAL003", Severity.WARNING, f"{value.target} is not calibrated: {value.reason}", place)
    if value.outcome is Outcome.KEPT:
        message = f"{value.target} stays as it is: the description allows more than was measured ({statistics_text(value.statistics)})"
        yield Finding("CAL004", Severity.INFO, message, place, "Use --tighten to narrow it to the measurement.")
    if value.outside:
        message = (
            f"{value.outside} of the {counted(value.held_out, 'value')} of {value.target} on which the calibration is judged "
            "are not within the description"
        )
        yield Finding("CAL007", Severity.ERROR, message, place, "Use all values, a larger margin, or a longer trace.")


def _is_gross(measured: Measured, values: Sequence[CalibratedValue]) -> bool:
    quantity = measured.series.quantity
    is_used = any(
        measured.series.name in value.measured and value.quantity == quantity and value.outcome is not Outcome.NOT_WRITTEN
        for value in values
    )
    return is_used and quantity in ("duration", JobMetric.GROSS_EXECUTION_TIME)


def _names(value: CalibratedValue) -> tuple[str, ...]:
    return (*value.measured, value.target.rpartition(".")[0])
