"""The times of empty jobs as overhead of the processes that they are the baseline of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from amalthea_uros.compare.calibration.execution_times import margin_text, written_range
from amalthea_uros.compare.calibration.options import CalibrationOptions
from amalthea_uros.compare.calibration.samples import Measured, samples_of
from amalthea_uros.compare.calibration.stated_overheads import stated_overhead, with_overhead
from amalthea_uros.compare.calibration.values import CalibratedValue, Outcome, calibrated
from amalthea_uros.design.description.assign import Assignment
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import time_text
from amalthea_uros.uros.described import Described

_QUANTITIES = (JobMetric.NET_EXECUTION_TIME, "duration")


def calibrated_overheads(
    measured: Sequence[Measured], description: Described, options: CalibrationOptions
) -> Iterator[CalibratedValue]:
    """The baselines of processes; one that a description states, also as nothing, is only judged."""
    known = description.assembly.system.processes
    processes = {owner.name: owner for owner in with_overhead(description.description) if owner.name in known}
    for each in measured:
        series = each.series
        owner = processes.get(series.name)
        if series.baseline is None or series.quantity not in _QUANTITIES or owner is None:
            continue
        empty = replace(
            each, series=replace(series, statistics=series.baseline, values=None, baseline=None), note="an empty job"
        )
        samples, target = samples_of([empty], options.judge_on), f"{series.name}.overhead"
        stated = stated_overhead(series.name, description.description)
        if stated == (0, 0):
            continue
        if stated is not None:
            is_within = stated[0] - samples.step <= samples.lower and samples.upper <= stated[1] + samples.step
            limits = f"the description states {time_text(stated[0])} to {time_text(stated[1])}"
            reason = "" if is_within else f"{limits}, and how it divides into activation and termination is not measured"
            outcome = Outcome.CONFIRMED if is_within else Outcome.NOT_WRITTEN
            yield calibrated(target, samples, outcome, reason, refuted=() if is_within else ("max",))
            continue
        path = (*owner.path, "overhead")
        yield calibrated(
            target,
            samples,
            Outcome.WRITTEN,
            path=path,
            assignment=Assignment(target, path, written_range(samples, options)),
            remark=margin_text(options),
        )
