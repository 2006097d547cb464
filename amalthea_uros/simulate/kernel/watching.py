"""What is observed because something in the model limits it: occurrences of events, and executions of runnables."""

from __future__ import annotations

from amalthea_uros.simulate.layout import (
    ACTIVATION,
    BEFORE_MIGRATIONS,
    BEFORE_PARKING,
    BEFORE_POLLING,
    BEFORE_PREEMPTIONS,
    BEFORE_RUNNING,
    BEFORE_WAITING,
    BEGAN,
    CORE_NUMBER,
    EXECUTION_NUMBER,
    INSTANCE,
    JOB_SIZE,
    JOBS,
    MIGRATIONS,
    NOW,
    OBSERVATION_SIZE,
    OBSERVATIONS,
    PREEMPTIONS,
    SINCE,
    TIME_PARKING,
    TIME_POLLING,
    TIME_RUNNING,
    TIME_WAITING,
    WATCHED,
)
from amalthea_uros.simulate.memory import Memory

_OCCURRENCE = 2


def observe(m: Memory, source: int, core: int) -> None:
    """Report an occurrence at a source, on a core or (0) on none."""
    row = m[OBSERVATIONS]
    m[row] = source
    m[row + 1] = _OCCURRENCE
    m[row + 2] = m[NOW]
    m[row + 3] = m[core + CORE_NUMBER] if core else -1
    m[OBSERVATIONS] = row + OBSERVATION_SIZE


def watch(m: Memory, process: int, kind: int, core: int) -> None:
    """Report a transition of a process, if it is among those that are watched: a source plus 1 for each kind, or 0."""
    source = m[m[process + WATCHED] + kind]
    if source:
        observe(m, source - 1, core)


def begin_execution(m: Memory, execution: int, process: int) -> None:
    """An execution of a runnable begins in the running job of a process."""
    m[execution + BEGAN] = m[NOW]
    m[execution + BEFORE_RUNNING] = m[process + TIME_RUNNING] + m[NOW] - m[process + SINCE]
    m[execution + BEFORE_WAITING] = m[process + TIME_WAITING]
    m[execution + BEFORE_POLLING] = m[process + TIME_POLLING]
    m[execution + BEFORE_PARKING] = m[process + TIME_PARKING]
    m[execution + BEFORE_PREEMPTIONS] = m[process + PREEMPTIONS]
    m[execution + BEFORE_MIGRATIONS] = m[process + MIGRATIONS]


def end_execution(m: Memory, execution: int, process: int) -> None:
    """An execution of a runnable ends: report it as a job of its own, with the activation of the job that it is a part of."""
    row = m[JOBS]
    m[row] = m[execution + EXECUTION_NUMBER]
    m[row + 1] = m[process + INSTANCE]
    m[row + 2] = m[process + ACTIVATION]
    m[row + 3] = m[execution + BEGAN]
    m[row + 4] = m[NOW]
    m[row + 5] = m[process + TIME_RUNNING] + m[NOW] - m[process + SINCE] - m[execution + BEFORE_RUNNING]
    m[row + 6] = m[process + TIME_WAITING] - m[execution + BEFORE_WAITING]
    m[row + 7] = m[process + TIME_POLLING] - m[execution + BEFORE_POLLING]
    m[row + 8] = m[process + TIME_PARKING] - m[execution + BEFORE_PARKING]
    m[row + 9] = m[process + PREEMPTIONS] - m[execution + BEFORE_PREEMPTIONS]
    m[row + 10] = m[process + MIGRATIONS] - m[execution + BEFORE_MIGRATIONS]
    m[JOBS] = row + JOB_SIZE
