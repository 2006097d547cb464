"""What a calibration says about single values."""

from __future__ import annotations

from enum import StrEnum

from amalthea_uros._internal.records import dataclass
from amalthea_uros.compare.calibration.samples import Samples
from amalthea_uros.compare.calibration.wording import provenance, sources
from amalthea_uros.design.description.assign import Assignment
from amalthea_uros.design.description.text_edits import Path
from amalthea_uros.measure.series import TimeStatistics


class Outcome(StrEnum):
    """What became of a measured value: written, as stated already, wider in the description, or impossible to state."""

    WRITTEN = "written"
    CONFIRMED = "confirmed"
    KEPT = "kept"
    NOT_WRITTEN = "not written"


@dataclass(frozen=True, slots=True, kw_only=True)
class CalibratedValue:
    """A measured value, and the one in the description.

    Attributes
    ----------
    target : the object and the key, such as "Control_Function.execution_time"
    measured : the objects of the trace that were measured for it
    sources : the traces
    path : its place in the description; None if it has none
    line : of the description as it was, counted from 1; None without a place
    before : None if the key was not there
    after : None if nothing was written
    refuted : what of the description a measured value contradicts: "min", "max", "period" or "jitter"
    held_out : number of values that were not used, but judged
    outside : number of those that are not within what the description says then
    reason : why it was not written, or was kept; "" otherwise
    assignment : what is written
    comment : what is said beside it
    """

    target: str
    measured: tuple[str, ...]
    quantity: str
    sources: tuple[str, ...]
    statistics: TimeStatistics
    outcome: Outcome
    path: Path | None = None
    line: int | None = None
    before: str | None = None
    after: str | None = None
    refuted: tuple[str, ...] = ()
    held_out: int = 0
    outside: int = 0
    reason: str = ""
    assignment: Assignment | None = None
    comment: str = ""


def calibrated(
    target: str,
    samples: Samples,
    outcome: Outcome,
    reason: str = "",
    *,
    path: Path | None = None,
    refuted: tuple[str, ...] = (),
    outside: int = 0,
    assignment: Assignment | None = None,
    remark: str = "",
) -> CalibratedValue:
    """What is said about some measured values.

    Parameters
    ----------
    remark : the end of the comment beside a written value
    """
    return CalibratedValue(
        target=target,
        measured=tuple(dict.fromkeys(each.series.name for each in samples.measured)),
        quantity=samples.measured[0].series.quantity,
        sources=sources(samples.measured),
        statistics=samples.statistics,
        outcome=outcome,
        path=path,
        refuted=refuted,
        held_out=0 if samples.held_out is None else len(samples.held_out),
        outside=outside,
        reason=reason,
        assignment=assignment,
        comment=provenance(samples, remark) if assignment else "",
    )
