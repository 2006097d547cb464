"""The work of callbacks for the wire, in executors that loop: it is part of what is measured of them, and the transport states it.

A driver that polls keeps the processor busy while a message is on the line, for a time that varies. A callback that publishes can also
wait until its message is on the wire, or until it is acknowledged: that is net execution time, too, and no running time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from amalthea_uros._internal.records import dataclass, replace
from amalthea_uros.compare.calibration.samples import Measured
from amalthea_uros.compare.calibration.wording import OTHER_PARTS
from amalthea_uros.errors import UnknownError
from amalthea_uros.executors.semantics.demand import IterationDemand
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.measure.series import TimeStatistics, shifted
from amalthea_uros.perf.executors import Handle
from amalthea_uros.perf.system import System
from amalthea_uros.timing.basics.quantities import JobMetric
from amalthea_uros.timing.basics.time_base import Ticks, max_time, min_time
from amalthea_uros.units import Interval, Time, time_text


@dataclass(frozen=True, slots=True)
class ExecutedTime:
    """The time of a callback, or of taking its message.

    Attributes
    ----------
    whole : with what the driver does for its messages
    can_wait : whether it can wait for the wire, too
    """

    whole: Interval[Time]
    can_wait: bool = False

    def others(self, stated: tuple[Time, Time] | None) -> Interval[Time]:
        """The time that it executes besides the time that a description states."""
        lower, upper = stated or (0, 0)
        return Interval(max(0, self.whole.lower - lower), max(0, self.whole.upper - upper))


def executed_times(system: System) -> Mapping[str, ExecutedTime]:
    """The times that executors in loops execute, by the names of handles and runnables; those of which it is not known are absent."""
    context = timing_context(system)
    times: dict[str, ExecutedTime] = {}
    for executor in system.executors:
        try:
            demand = IterationDemand.of(executor, context)
        except UnknownError:
            continue
        base = context.time_base(executor.task)
        for handle in executor.handles:
            callback, take = demand.callbacks[handle.name], demand.takes[handle.name]
            called = ExecutedTime(_times(callback, base), _can_wait(handle, system))
            times |= dict.fromkeys((handle.name, handle.runnable), called)
            if handle.take is not None:
                times[handle.take] = ExecutedTime(_times(take, base))
    return times


def _times(demand: Interval[Time], time_base: int) -> Interval[Time]:
    return Interval(min_time(Ticks(demand.lower), time_base), max_time(Ticks(demand.upper), time_base))


def _can_wait(handle: Handle, system: System) -> bool:
    wires = {wire.name: wire for wire in system.network.wires}
    sent = [system.transmissions.get(each.transmission or "") for each in handle.publications]
    return any(each.waits for each in handle.publications) or any(
        each is not None and wires[each.wire].keeps_sender for each in sent
    )


def without_waits(measured: Sequence[Measured], known: Mapping[str, ExecutedTime]) -> list[Measured]:
    """The series; of what can wait for the wire, the running time takes the place of the net execution time if it was measured."""
    running = {
        (id(each.source), each.series.name): each
        for each in measured
        if each.series.quantity == JobMetric.RUNNING_TIME and each.series.name in known and known[each.series.name].can_wait
    }
    others = [
        each
        for each in measured
        if (id(each.source), each.series.name) not in running or each.series.quantity not in _WITH_WAITS
    ]
    kept = (replace(each, series=replace(each.series, quantity=JobMetric.NET_EXECUTION_TIME)) for each in running.values())
    return [*others, *(replace(each, note=WITHOUT_WAITS) for each in kept)]


#: What is said of running times that are used.
WITHOUT_WAITS = "running times, which do not include waits for the wire"
#: The quantities of a callback that contain what it waits.
_WITH_WAITS = (JobMetric.NET_EXECUTION_TIME, JobMetric.GROSS_EXECUTION_TIME, "duration")


def without_parts(measured: Measured, others: Interval[Time]) -> Measured:
    """The series without a part of its times that varies, as if it were a baseline: of a single value only its limits are known."""
    series, mean = measured.series, (others.lower + others.upper) // 2
    if not others.upper or series.statistics is None:
        return measured
    own = series.baseline
    limits = TimeStatistics(
        count=1 if own is None else own.count,
        min=others.lower + (0 if own is None else own.min),
        mean=mean + (Fraction(0) if own is None else own.mean),
        max=others.upper + (0 if own is None else own.max),
        variance=None,
    )
    text = f"{time_text(others.lower)} to {time_text(others.upper)} {OTHER_PARTS}"
    return replace(
        measured,
        series=replace(
            series,
            statistics=shifted(series.statistics, -mean),
            values=None if series.values is None else series.values - mean,
            baseline=limits,
        ),
        note="; ".join(filter(None, (measured.note, f"without {text}"))),
    )
