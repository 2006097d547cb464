"""States of processes, the time in them, and the events of a trace."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.watching import watch
from amalthea_uros.simulate.layout import (
    CORE_ENTITY,
    ENTITY,
    EVENT_SIZE,
    EVENTS,
    EXECUTED,
    EXECUTION,
    EXECUTIONS,
    INSTANCE,
    IS_REPORTED,
    IS_TRACED,
    NOW,
    RUNNABLE_ENTITY,
    SINCE,
    STATE,
    TIME_PARKING,
    TIME_POLLING,
    TIME_RUNNING,
    TIME_WAITING,
    WATCHED,
)
from amalthea_uros.simulate.memory import Memory
from amalthea_uros.simulate.operations import PARKING, POLLING, RUNNING, WAITING

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


def tell(m: Memory, kind: int, core: int, process: int) -> None:
    """Record a transition of a process on a core, if there is a trace or it is watched."""
    if m[process + WATCHED]:
        watch(m, process, kind, core)
    if m[IS_TRACED] and m[process + IS_REPORTED]:
        emit(m, kind, m[core + CORE_ENTITY], 0, m[process + ENTITY], m[process + INSTANCE], NO_NOTE)


def tell_execution(m: Memory, process: int, site: int, is_begin: bool) -> None:
    """Record that an execution of a runnable begins or ends, with its number."""
    runnable = m[site + EXECUTED]
    if is_begin:
        m[site + EXECUTION] = m[runnable + EXECUTIONS]
        m[runnable + EXECUTIONS] += 1
    if m[IS_TRACED]:
        kind = _RUNNABLE_START if is_begin else _RUNNABLE_TERMINATE
        entity = m[runnable + RUNNABLE_ENTITY]
        emit(m, kind, m[process + ENTITY], m[process + INSTANCE], entity, m[site + EXECUTION], NO_NOTE)


def tell_of(m: Memory, kind: int, process: int, entity: int) -> None:
    """Record what a process does with something, if there is a trace."""
    if m[IS_TRACED]:
        emit(m, kind, m[process + ENTITY], m[process + INSTANCE], entity, 0, NO_NOTE)
