"""Predictions of a model compared with a measurement."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from fractions import Fraction
from typing import TypeAlias

from amalthea_uros._internal.one_or_several import one_or_several
from amalthea_uros._internal.paths import StrPath
from amalthea_uros.compare.comparing import DEFAULT_TOLERANCE, EVERY_SOURCE, CompareOptions, compare_measured
from amalthea_uros.compare.measured.events import begins_of
from amalthea_uros.compare.measured.measuring import MeasureOptions, measure_file
from amalthea_uros.compare.naming import Names
from amalthea_uros.compare.results import Comparison, PredictionSource
from amalthea_uros.compare.shares import parse_tolerance
from amalthea_uros.compare.traces import joined
from amalthea_uros.design.changes.change import Changes
from amalthea_uros.findings.accepted import unsuppressed
from amalthea_uros.measure.series import Measurement
from amalthea_uros.names import require
from amalthea_uros.services.changed import open_changed
from amalthea_uros.services.inputs import as_paths
from amalthea_uros.services.subject import Subject
from amalthea_uros.timing.basics.settings import Settings
from amalthea_uros.timing.basics.stated_times import TimeLike, stated_time

#: What was measured, or the trace to measure.
Measured: TypeAlias = "Measurement | StrPath | Iterable[StrPath]"


def compare(
    subject: Subject,
    measured: Measured,
    *,
    tolerance: str | float | Fraction = DEFAULT_TOLERANCE,
    by: Iterable[PredictionSource | str] = EVERY_SOURCE,
    duration: TimeLike | None = None,
    seed: int = 1,
    names: Names | None = None,
    overheads: Mapping[str, TimeLike] | None = None,
    uncertainty: TimeLike | None = None,
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
    duration : of the simulation, such as "1 s"; None: as long as the measurement
    names : which measured series is what in the model, where the names differ
    overheads : process -> time that is added to its predicted execution and response times; "" stands for all others
    uncertainty : by how much a measured time may be wrong; None: by less than a step of its time stamps

    Raises
    ------
    ReadError : a file cannot be read, or something in a description is wrong.
    InvalidArgumentError : a name, a value or the tolerance is wrong.
    """
    options = CompareOptions(
        tolerance=parse_tolerance(tolerance),
        sources=_sources(by),
        duration=None if duration is None else stated_time("the duration", duration),
        seed=seed,
        names=names or Names(),
        overheads={of: stated_time("the overhead", time) for of, time in (overheads or {}).items()},
        uncertainty=None if uncertainty is None else stated_time("the uncertainty", uncertainty),
    )
    return compare_files(subject, measured, options, settings=settings, changes=changes)


def compare_files(
    subject: Subject,
    measured: Measured,
    options: CompareOptions,
    reading: MeasureOptions | None = None,
    *,
    settings: Settings | None = None,
    changes: Changes = (),
) -> Comparison:
    """Compare what a system predicts with what was measured, or is measured in traces; errors as for `compare`.

    Parameters
    ----------
    reading : how the traces are measured
    changes : of the system and the settings, made first
    """
    changed = open_changed(subject, settings, changes)
    if not isinstance(measured, Measurement):
        # What is measured begins as in the model.
        reading = replace(reading or MeasureOptions(), begins=begins_of(changed.system))
        measured = joined([measure_file(path, reading) for path in as_paths(measured)])
    found = compare_measured(changed.system, changed.settings, measured, options)
    return replace(
        found,
        model=" ".join(map(str, changed.opened.paths)),
        differences=changed.differences,
        findings=unsuppressed((*changed.opened.findings, *found.findings)),
    )


def _sources(names: Iterable[PredictionSource | str]) -> tuple[PredictionSource, ...]:
    given = one_or_several(names)
    require("source of predictions", given, EVERY_SOURCE)
    return tuple(map(PredictionSource, given))
