"""Measured distances as periods, intervals and jitters of a description."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from amalthea_uros.compare.calibration.grids import Grid, jitter_of
from amalthea_uros.compare.calibration.options import CalibrationOptions
from amalthea_uros.compare.calibration.samples import Measured, Samples, samples_of
from amalthea_uros.compare.calibration.values import CalibratedValue, Outcome, calibrated
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.description.built_objects import BuiltObjects
from amalthea_uros.design.description.owners import callbacks
from amalthea_uros.design.description.text_edits import Path
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.perf.system import System
from amalthea_uros.spec.application import Subscription
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import Rounding, Time, rounded, rounded_time_text, time_text
from amalthea_uros.uros.described import Described

#: The distances that show a period; those of activations first, since starts are delayed by others.
QUANTITIES = (JobMetric.ACTIVATE_TO_ACTIVATE, JobMetric.START_TO_START)


def calibrated_periods(
    measured: Sequence[Measured], description: Described, built: BuiltObjects, options: CalibrationOptions
) -> Iterator[CalibratedValue]:
    """The measured periods of processes, and the intervals of messages that are measured by the names of their topics."""
    topics = {section.topic: path for path, section in callbacks(description.description) if isinstance(section, Subscription)}
    for group in _by_object(measured):
        name, samples = group[0].series.name, samples_of(group, Fraction(0))
        if name in topics:
            yield from _message(name, samples, topics[name], description, built)
        elif name in description.assembly.system.processes:
            yield from _process(name, samples, description, built, options)


def _by_object(measured: Sequence[Measured]) -> Iterator[list[Measured]]:
    groups: dict[str, dict[str, list[Measured]]] = {}
    for each in measured:
        series = each.series
        if series.quantity in QUANTITIES and series.statistics is not None:
            groups.setdefault(series.name, {}).setdefault(series.quantity, []).append(each)
    for by_quantity in groups.values():
        yield next(by_quantity[quantity] for quantity in QUANTITIES if quantity in by_quantity)


def _process(
    name: str, samples: Samples, description: Described, built: BuiltObjects, options: CalibrationOptions
) -> Iterator[CalibratedValue]:
    target = f"{name}.period"
    present = _period(name, description.assembly.system)
    if present is None:
        return
    grid = Grid.of(samples)
    if grid.fits(present):
        yield calibrated(target, samples, Outcome.CONFIRMED)
        if samples.measured[0].series.quantity == JobMetric.ACTIVATE_TO_ACTIVATE:
            yield from _process_jitter(name, samples, present, description, built, options)
        return
    period = grid.matching(description.assembly.task_periods or [_round(grid.mean)])
    mean = rounded_time_text(grid.mean, Rounding.NEAREST)
    if period is None:
        reason = f"the mean of {mean} is not the stated {time_text(present)}, and not one of the available task periods either"
        yield calibrated(target, samples, Outcome.NOT_WRITTEN, reason, refuted=("period",))
        return
    try:
        assignments = built.assignments(Change(name, "period", time_text(period)))
    except InvalidArgumentError as error:
        yield calibrated(target, samples, Outcome.NOT_WRITTEN, str(error), refuted=("period",))
        return
    for assignment in assignments:
        yield calibrated(target, samples, Outcome.WRITTEN, path=assignment.path, refuted=("period",), assignment=assignment)


def _process_jitter(
    name: str, samples: Samples, period: Time, description: Described, built: BuiltObjects, options: CalibrationOptions
) -> Iterator[CalibratedValue]:
    """The jitter of activations, where it is more than the clock of the trace can show."""
    jitter, stated = jitter_of(samples, period), _stated_jitter(name, description.assembly.system)
    if jitter <= max(stated, samples.step):
        return
    target = f"{name}.jitter"
    try:
        (assignment,) = built.assignments(Change(name, "jitter", time_text(jitter)))
    except InvalidArgumentError:
        reason = (
            f"its activations have a jitter of {time_text(jitter)}, which an app.yaml states for tasks with a 'period' only"
        )
        yield calibrated(target, samples, Outcome.NOT_WRITTEN, reason, refuted=("jitter",))
        return
    yield calibrated(
        target, samples, Outcome.WRITTEN, path=assignment.path, refuted=("jitter",), assignment=assignment, remark=_NO_BOUND
    )


_NO_BOUND = "a high-water mark, not a bound"


def _message(
    topic: str, samples: Samples, path: Path, description: Described, built: BuiltObjects
) -> Iterator[CalibratedValue]:
    """The interval and the jitter of the messages of a topic."""
    section = next(section for place, section in callbacks(description.description) if place == path)
    assert isinstance(section, Subscription)
    stated = next(each.interval for each in built.callbacks if each.section is section)
    grid, target = Grid.of(samples), f"{section.name}.arrival_period"
    interval = stated if stated is not None and grid.fits(stated) else grid.matching([_round(grid.mean)])
    if interval is None:
        mean = rounded_time_text(grid.mean, Rounding.NEAREST)
        reason = f"the mean of {mean} is not that of regular messages; set 'interval' to the minimum distance"
        yield calibrated(target, samples, Outcome.NOT_WRITTEN, reason, path=path, refuted=("period",))
        return
    if interval == stated:
        yield calibrated(target, samples, Outcome.CONFIRMED, path=(*path, "interval"))
    else:
        (assignment,) = built.assignments(Change(section.name, "arrival_period", time_text(interval)))
        yield calibrated(target, samples, Outcome.WRITTEN, path=assignment.path, refuted=("period",), assignment=assignment)
    jitter = jitter_of(samples, interval)
    if jitter <= max(section.jitter or 0, samples.step):
        return
    target = f"{section.name}.arrival_jitter"
    if jitter >= interval:
        reason = f"the jitter of {time_text(jitter)} is not shorter than the interval of {time_text(interval)}"
        yield calibrated(target, samples, Outcome.NOT_WRITTEN, reason, path=path, refuted=("jitter",))
        return
    yield calibrated(
        target,
        samples,
        Outcome.WRITTEN,
        path=(*path, "jitter"),
        refuted=("jitter",),
        assignment=built.assignments(Change(section.name, "arrival_jitter", time_text(jitter)))[0],
        remark=_NO_BOUND,
    )


def _period(process: str, system: System) -> Time | None:
    match [system.stimuli_by_name.get(name) for name in system.processes[process].stimuli]:
        case [Periodic(period=period)]:
            return period
    return None


def _stated_jitter(process: str, system: System) -> Time:
    from amalthea_uros.perf.distributions import highest

    (stimulus,) = (system.stimuli_by_name[name] for name in system.processes[process].stimuli)
    jitter = highest(stimulus.jitter) if isinstance(stimulus, Periodic) and stimulus.jitter is not None else 0
    return jitter or 0


def _round(mean: Fraction) -> Time:
    """A period that an engineer chose, near a measured mean: one with few digits."""
    for digits in (1, 2, 3):
        scale = Fraction(10) ** (len(str(int(mean))) - digits)
        found = round(mean / scale) * scale
        if abs(found - mean) <= mean * Fraction(1, 1000):
            return int(found)
    return int(rounded(mean, Rounding.NEAREST))
