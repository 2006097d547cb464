"""When a process can be preempted: always, at some points, or never."""

from __future__ import annotations

from amalthea_uros.perf.software import Preemption, Task
from amalthea_uros.timing.scheduling import ScheduledProcess


def preemption(item: ScheduledProcess) -> Preemption:
    """The preemption mode of a process; an ISR is preempted only by interrupts of higher priority."""
    return item.process.preemption if isinstance(item.process, Task) else Preemption.PREEMPTIVE


def is_preemptive(item: ScheduledProcess) -> bool:
    """Whether every process of higher rank can preempt a process immediately."""
    return preemption(item) is Preemption.PREEMPTIVE and item.group is None
