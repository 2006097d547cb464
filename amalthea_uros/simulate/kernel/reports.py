"""What the kernel reports: times in states of processes, events of a trace, observed occurrences and executions."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.layout import *

#: In the column of the note of an event: there is none, as in `trace.table`.
NO_NOTE = -(2**63)
#: The kinds of events, as in `trace.table.EventKind`.
_RUNNABLE_START, _RUNNABLE_TERMINATE = 20, 23


def enter_state(m: Memory, process: int, state: int) -> None:
    """Change the state of a process, and add the time in the old one to the account of its job."""
    before, spent = m[process + STATE], m[NOW] - m[process + SINCE]
    if before == RUNNING:
        m[process + TIME_RUNNING] += spent
    elif before == WAITING:
        m[process + TIME_WAITING] += spent
    elif before == POLLING:
        m[process + TIME_POLLING] += spent
    elif before == PARKING:
        m[process + TIME_PARKING] += spent
    m[process + SINCE] = m[NOW]
    m[process + STATE] = state


def emit(m: Memory, kind: int, source: int, source_instance: int, target: int, target_instance: int, note: int) -> None:
    """Record an event; source and target are numbers of entities."""
    row = m[EVENTS]
    m[row] = m[NOW]
    m[row + 1] = kind
    m[row + 2] = source
    m[row + 3] = source_instance
    m[row + 4] = target
    m[row + 5] = target_instance
    m[row + 6] = note
    m[EVENTS] = row + EVENT_SIZE


def report(m: Memory, kind: int, core: int, process: int) -> None:
    """Record a transition of a process on a core, if there is a trace or it is watched."""
    if m[process + WATCHED]:
        watch(m, process, kind, core)
    if m[IS_TRACED] and m[process + IS_REPORTED]:
        emit(m, kind, m[core + CORE_ENTITY], 0, m[process + ENTITY], m[process + INSTANCE], NO_NOTE)


def report_execution(m: Memory, process: int, site: int, is_begin: bool) -> None:
    """Record that an execution of a runnable begins or ends, with its number."""
    runnable = m[site + EXECUTED]
    if is_begin:
        m[site + EXECUTION] = m[runnable + EXECUTIONS]
        m[runnable + EXECUTIONS] += 1
    if m[IS_TRACED]:
        kind = _RUNNABLE_START if is_begin else _RUNNABLE_TERMINATE
        entity = m[runnable + RUNNABLE_ENTITY]
        emit(m, kind, m[process + ENTITY], m[process + INSTANCE], entity, m[site + EXECUTION], NO_NOTE)


def report_access(m: Memory, kind: int, process: int, entity: int) -> None:
    """Record what a process does with something, if there is a trace."""
    if m[IS_TRACED]:
        emit(m, kind, m[process + ENTITY], m[process + INSTANCE], entity, 0, NO_NOTE)


# What is observed because something in the model limits it: occurrences of events, and executions of runnables.

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
    """An execution of a runnable ends: report it as a job of its own, with the activation of the job that it is a part of.

    What an executor calls was activated by itself; without a message, nothing has activated it, and it is not reported.
    """
    activation = m[m[execution + ASKED_AT]] if m[execution + ASKED_AT] else m[process + ACTIVATION]
    if activation < 0:
        return
    row = m[JOBS]
    m[row] = m[execution + EXECUTION_NUMBER]
    m[row + 1] = m[process + INSTANCE]
    m[row + 2] = activation
    m[row + 3] = m[execution + BEGAN]
    m[row + 4] = m[NOW]
    m[row + 5] = m[process + TIME_RUNNING] + m[NOW] - m[process + SINCE] - m[execution + BEFORE_RUNNING]
    m[row + 6] = m[process + TIME_WAITING] - m[execution + BEFORE_WAITING]
    m[row + 7] = m[process + TIME_POLLING] - m[execution + BEFORE_POLLING]
    m[row + 8] = m[process + TIME_PARKING] - m[execution + BEFORE_PARKING]
    m[row + 9] = m[process + PREEMPTIONS] - m[execution + BEFORE_PREEMPTIONS]
    m[row + 10] = m[process + MIGRATIONS] - m[execution + BEFORE_MIGRATIONS]
    m[JOBS] = row + JOB_SIZE
