"""What the worst-case execution time of a process consists of."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from amalthea_uros.errors import UnknownError
from amalthea_uros.perf.activities import Activity, Call, Execute, ExecutionNeed, Group, LabelAccess
from amalthea_uros.perf.stimuli import Counter
from amalthea_uros.timing.basics.time_base import Ticks, max_time
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.units import Time

OWN, ACCESSES, OTHER = "own execution", "label accesses", "other activities"
OVERHEADS = "overheads and copies"


@dataclass(frozen=True, slots=True, kw_only=True)
class ExecutionShare:
    """The share of a runnable, or of something else that a job executes, in the worst-case execution time of a process.

    Attributes
    ----------
    name : of the runnable, or what else it is
    is_runnable : whether it is a runnable
    calls : how often it is called
    counter : if only some jobs execute it
    time : in a job that executes it; None if it is unknown, for the `reason`
    """

    name: str
    is_runnable: bool
    time: Time | None
    calls: int = 1
    counter: Counter | None = None
    reason: str = ""


def execution_shares(context: TimingContext, name: str) -> list[ExecutionShare]:
    """The shares, in order of execution; their times add up to the worst-case execution time if that is known."""
    scheduled = context.scheduled.get(name)
    if scheduled is None:
        return []
    grouped: dict[tuple[str, bool, Counter | None], list[Activity]] = {}
    for activity in _flat(scheduled.process.activities):
        grouped.setdefault(_kind(activity), []).append(activity)
    found, executed = [], Ticks(0)
    time_base = context.time_base(name)
    for (kind, is_runnable, counter), activities in grouped.items():
        before = max_time(executed, time_base)
        time, reason = None, ""
        try:
            demand = context.demand_model.of_activities(scheduled.process, activities, scheduled.core)
            executed = Ticks(executed + demand.worst)
            time = max_time(executed, time_base) - before
        except UnknownError as error:
            reason = str(error)
        if time != 0:
            found.append(
                ExecutionShare(
                    name=kind, is_runnable=is_runnable, time=time, calls=len(activities), counter=counter, reason=reason
                )
            )
    whole = context.demands.get(name)
    rest = 0 if whole is None else max_time(whole.worst, time_base) - max_time(executed, time_base)
    return [*found, ExecutionShare(name=OVERHEADS, is_runnable=False, time=rest)] if rest > 0 else found


def _flat(activities: Sequence[Activity]) -> Iterator[Activity]:
    """The activities of a process, with those of its groups instead of the groups."""
    for activity in activities:
        if isinstance(activity, Group):
            yield from _flat(activity.activities)
        else:
            yield activity


def _kind(activity: Activity) -> tuple[str, bool, Counter | None]:
    """What is shown as one row: the name of a runnable and its counter, or what else an activity is."""
    match activity:
        case Call(runnable=runnable, counter=counter):
            return runnable, True, counter
        case Execute() | ExecutionNeed():
            return OWN, False, None
        case LabelAccess():
            return ACCESSES, False, None
    return OTHER, False, None
