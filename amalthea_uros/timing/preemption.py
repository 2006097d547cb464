"""Where a process can be preempted: anywhere, between activities, or nowhere."""

from __future__ import annotations

from amalthea_uros.perf.software import Activity, Preemption, SchedulePoint, Task
from amalthea_uros.timing.scheduling import ScheduledProcess


def preemption(item: ScheduledProcess) -> Preemption:
    """The preemption mode of a process; an ISR is preempted only by interrupts of higher priority."""
    return item.process.preemption if isinstance(item.process, Task) else Preemption.PREEMPTIVE


def is_preemptive(item: ScheduledProcess) -> bool:
    """Whether every process of higher rank can preempt a process immediately."""
    return preemption(item) is Preemption.PREEMPTIVE and item.group is None


def regions(item: ScheduledProcess) -> list[tuple[Activity, ...]]:
    """The activities between the preemption points of a task: each activity, or for groups all between schedule points."""
    activities = item.process.activities
    if preemption(item) is Preemption.COOPERATIVE and item.group is None:
        return [(activity,) for activity in activities]
    found: list[tuple[Activity, ...]] = [()]
    for activity in activities:
        if isinstance(activity, SchedulePoint):
            found.append(())
        else:
            found[-1] += (activity,)
    return found
