"""The measurements of several traces as one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from amalthea_uros.measure.series import Counts, MeasuredKind, Measurement, Series, merged, statistics_of


def joined(parts: Sequence[Measurement]) -> Measurement:
    """The values of all traces; their durations add up.

    Parameters
    ----------
    parts : at least one
    """
    if len(parts) == 1:
        return parts[0]
    series: dict[tuple[MeasuredKind, str, str], list[Series]] = {}
    for part in parts:
        for each in part.series:
            series.setdefault((each.kind, each.name, each.quantity), []).append(each)
    resolutions = [part.resolution for part in parts]
    return Measurement(
        source=" ".join(part.source for part in parts),
        format=", ".join(dict.fromkeys(part.format for part in parts)),
        digest=" ".join(part.digest for part in parts),
        duration=sum(part.duration for part in parts),
        resolution=None if None in resolutions else max(filter(None, resolutions), default=0),
        series=tuple(map(_joined, series.values())),
        findings=tuple(dict.fromkeys(finding for part in parts for finding in part.findings)),
    )


def _joined(parts: Sequence[Series]) -> Series:
    if len(parts) == 1:
        return parts[0]
    values = [part.values for part in parts if part.values is not None]
    known = [part.statistics for part in parts if part.statistics is not None]
    together = np.concatenate(values) if len(values) == len(parts) else None
    baselines = [part.baseline for part in parts]
    return replace(
        parts[0],
        statistics=(statistics_of(together) if together is not None and len(together) else merged(known)) if known else None,
        values=together,
        times=None,
        counts=Counts(**{each.name: sum(getattr(part.counts, each.name) for part in parts) for each in fields(Counts)}),
        baseline=merged([each for each in baselines if each is not None]) if None not in baselines else None,
    )
