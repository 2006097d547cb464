"""Pictures of sweeps."""

from __future__ import annotations

from fractions import Fraction

from amalthea_uros.design.campaign.analysis_job import SCHEDULABLE
from amalthea_uros.errors import InvalidArgumentError
from amalthea_uros.judge.summary import Schedulable
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.report.pictures.swept import SweptPicture, draw_swept
from amalthea_uros.services.sweep import SweepResult

_VERDICTS = {Schedulable.YES: Verdict.MET, Schedulable.NO: Verdict.MISSED, Schedulable.UNKNOWN: Verdict.UNKNOWN}


def sweep_picture(result: SweepResult, quantity: str) -> str:
    """A quantity over the one or two swept values, as SVG.

    Raises
    ------
    InvalidArgumentError : there is no such quantity, it is no number, or there are too many values for a picture.
    """
    column = result.column(quantity)
    keys = {tuple(change.value for change in outcome.run.changes): outcome for outcome in result.outcomes}
    values: dict[tuple[str, ...], Fraction | None] = {}
    for key, outcome in keys.items():
        value = outcome.record.get(column)
        if isinstance(value, str):
            raise InvalidArgumentError(f"{quantity!r} is no number, so it cannot be drawn")
        values[key] = None if value is None else Fraction(value)
    sweeps = result.plan.sweeps
    return draw_swept(
        SweptPicture(
            quantity=column.removesuffix("_ps"),
            is_time=column.endswith("_ps"),
            targets=tuple(f"{sweep.object}.{sweep.key}" for sweep in sweeps),
            axes=tuple(tuple(sweep.values) for sweep in sweeps),
            values=values,
            verdicts={
                key: _VERDICTS[Schedulable(str(found))] for key, each in keys.items() if (found := each.record.get(SCHEDULABLE))
            },
        )
    )
