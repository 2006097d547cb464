"""What is said about measured values: beside them in the description, and in findings."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

from amalthea_uros.compare.calibration.samples import Measured, Samples
from amalthea_uros.measure.series import TimeStatistics
from amalthea_uros.units import Rounding, rounded_time_text, time_text

#: What is said of parts that are subtracted like a baseline.
OTHER_PARTS = "of other parts, such as the wire"
#: Of the digest of a file; enough to recognise it.
_DIGITS = 12


def provenance(samples: Samples, remark: str) -> str:
    """Where measured values come from, as the end of a comment."""
    baselines = dict.fromkeys(
        _baseline(each) for each in samples.measured if each.series.baseline is not None and OTHER_PARTS not in each.note
    )
    notes = dict.fromkeys(each.note for each in samples.measured)
    parts = [statistics_text(samples.statistics), *notes, *baselines, remark]
    return f"measured in {', '.join(dict.fromkeys(map(_source, samples.measured)))}: {'; '.join(filter(None, parts))}"


def statistics_text(statistics: TimeStatistics) -> str:
    """The number, the extremes and the mean of values."""
    mean = rounded_time_text(statistics.mean, Rounding.NEAREST)
    return f"n {statistics.count}, min {time_text(statistics.min)}, mean {mean}, max {time_text(statistics.max)}"


def percentage(share: Fraction) -> str:
    """A share such as "20 %"."""
    return f"{float(share * 100):.4g} %"


def sources(measured: Iterable[Measured]) -> tuple[str, ...]:
    """The names of the traces."""
    return tuple(dict.fromkeys(each.source.source for each in measured))


def _source(measured: Measured) -> str:
    source = measured.source
    digest = f" (sha256 {source.digest[:_DIGITS]})" if source.digest else ""
    return f"{Path(source.source).name}{digest}"


def _baseline(measured: Measured) -> str:
    assert measured.series.baseline is not None
    mean = rounded_time_text(measured.series.baseline.mean, Rounding.NEAREST)
    return f"baseline with a mean of {mean} subtracted"
