"""The cost of an executor with and without a message, from its jobs as a whole.

Where nothing in the executor is traced, a job with a message is only longer. If messages of a single callback are taken, as often as
the description says, the longest jobs are those with a message: as many as messages come, if there is a gap between them and the
others. Without the gap, or with another number, the parts are not separated.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

from amalthea_uros.compare.calibration.samples import Measured
from amalthea_uros.design.description.built_objects import BuiltObjects
from amalthea_uros.measure.series import MeasuredKind, statistics_of
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.units import Time

#: By how much the number of long jobs may differ from the number of messages: the first and the last one, and clocks.
_MOST_OTHERS = 2


def with_executor_parts(measured: Sequence[Measured], built: BuiltObjects, period: Time | None) -> Iterator[Measured]:
    """The series, those of the executor as one for its base and one for its messages if they can be separated.

    Parameters
    ----------
    period : of the executor
    """
    executor = built.description.middleware.stated_executors[0]
    cost = executor.execution_time
    incoming = [callback for callback in built.callbacks if callback.incoming is not None]
    parts = {"per_timer", "per_handle", "per_ready_callback", "per_message"} & cost.model_fields_set
    has_two_parts = parts == {"per_message"} and not cost.per_message.per_byte and len(incoming) == 1
    is_alone = not any(callback.in_executor for callback in built.callbacks)
    for each in measured:
        series = each.series
        is_executor = (series.name, series.quantity) == (executor.name, JobMetric.NET_EXECUTION_TIME)
        if is_executor and series.kind is MeasuredKind.PROCESS and has_two_parts and is_alone and period is not None:
            separated = _separated(each, Fraction(period, incoming[0].interval), executor.name, incoming[0].name)
            yield from separated or (each,)
        else:
            yield each


def _separated(measured: Measured, share: Fraction, executor: str, callback: str) -> tuple[Measured, ...]:
    """Jobs without and with a message; nothing if they cannot be told apart."""
    import numpy as np

    values = measured.series.values
    if values is None or share > Fraction(1, 2) or len(values) * share < _MOST_OTHERS + 1:
        return ()
    ordered = np.sort(values)
    first = int(np.argmax(np.diff(ordered))) + 1
    if abs(len(values) - first - len(values) * share) > _MOST_OTHERS:
        return ()
    limit = ordered[first]
    without = values[values < limit]
    base = statistics_of(without)
    extra = values[values >= limit] - round(base.mean)
    series = replace(measured.series, times=None)
    return (
        replace(
            measured,
            series=replace(series, name=f"{executor}_Spin", statistics=base, values=without),
            note="jobs without a message: the shorter ones",
        ),
        replace(
            measured,
            series=replace(series, name=f"Take_{callback}", statistics=statistics_of(extra), values=extra, baseline=base),
            note="jobs with a message: the longer ones",
        ),
    )
