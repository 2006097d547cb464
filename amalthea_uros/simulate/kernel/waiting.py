"""Waiting for semaphores, events of the operating system and answers: on the core (polling) or off it."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.budgets import activate_server, deactivate_server
from amalthea_uros.simulate.kernel.cores import change_level, is_before, leave_core, pause, requeue, run
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.reports import NO_NOTE, emit, enter_state, report, report_access

#: The kinds of events, as in `trace.table.EventKind`.
_POLL, _RUN, _RELEASE_PARKING, _WAIT, _RELEASE = 5, 6, 9, 10, 11
_REQUEST, _ASSIGNED, _WAITING, _RELEASED = 40, 43, 44, 45
_SET, _CLEAR, _WAIT_EVENT = 50, 51, 52
#: A semaphore changes, as in `trace.derived_events`.
_CHANGE = -1


def wait(m: Memory, core: int, process: int, is_active: bool) -> None:
    """Have the process of a core wait."""
    requeue(m, process)
    if is_active:
        enter_state(m, process, POLLING)
        report(m, _POLL, core, process)
        m[process + LEFT] = NEVER - m[NOW]
        m[core + NEEDS_STEP] = 0
        run(m, core, process)
        return
    # Back from waiting, it keeps off nobody until it has its core again.
    m[process + YIELDS] = 1
    enter_state(m, process, WAITING)
    report(m, _WAIT, core, process)
    m[process + LEFT] = 0
    change_level(m, process)
    leave_core(m, core)
    if m[process + SERVER]:
        deactivate_server(m, m[process + SERVER])


def release(m: Memory, process: int) -> None:
    """What a process waits for has come."""
    core = m[process + CORE]
    m[process + WAITED_UNTIL] = m[NOW]
    if m[process + STATE] == POLLING:
        pause(m, core, process)
        enter_state(m, process, RUNNING)
        report(m, _RUN, core, process)
        m[core + NEEDS_STEP] = 1
        m[core + STOP] = NEVER
    elif m[process + STATE] == PARKING:
        enter_state(m, process, READY)
        report(m, _RELEASE_PARKING, core, process)
    else:
        enter_state(m, process, READY)
        report(m, _RELEASE, core, process)
        m[ORDER] += 1
        m[process + SEQUENCE] = m[ORDER]
        if m[process + SERVER]:
            activate_server(m, m[process + SERVER])
    m[process + LEFT] = 0
    change_level(m, process)


def wake(m: Memory, process: int) -> None:
    """A process that waits for messages continues."""
    executor = m[process + READS_WITH]
    if executor:
        m[process + READS_WITH] = 0
        m[m[executor + WAIT_ALARM] + ALARM_AT] = NEVER
        release(m, process)


# Semaphores.


def request(m: Memory, core: int, process: int, semaphore: int, flags: int) -> bool:
    """Request a semaphore; the result says whether the job continues."""
    amount = m[semaphore + USERS] if flags & EXCLUSIVE else 1
    report_access(m, _REQUEST, process, m[semaphore + SEMAPHORE_ENTITY])
    if m[semaphore + USED] + amount <= m[semaphore + USERS]:
        _grant(m, process, semaphore, amount)
        is_wanted = _is_wanted(m, semaphore)
        _report_change(m, semaphore, m[semaphore + USED] - amount, is_wanted, is_wanted)
        report_access(m, _ASSIGNED, process, m[semaphore + SEMAPHORE_ENTITY])
        return True
    if m[semaphore + USED] == m[semaphore + USERS]:
        _report_change(m, semaphore, m[semaphore + USED], _is_wanted(m, semaphore), 1)
    m[process + WAITS_FOR] = semaphore
    m[process + WANTED] = amount
    report_access(m, _WAITING, process, m[semaphore + SEMAPHORE_ENTITY])
    wait(m, core, process, flags & ACTIVE != 0)
    return False


def _hold(m: Memory, process: int, semaphore: int) -> int:
    """What a process holds of a semaphore."""
    return m[process + HOLDS] + m[semaphore + SEMAPHORE_NUMBER] * HOLD_SIZE


def _grant(m: Memory, process: int, semaphore: int, amount: int) -> None:
    """A process gets a semaphore."""
    hold = _hold(m, process, semaphore)
    m[semaphore + USED] += amount
    m[hold + HELD] += amount
    m[hold + HELD_SINCE] = m[NOW]
    if m[semaphore + CEILING] >= 0:
        change_level(m, process)


def unlock(m: Memory, process: int, semaphore: int) -> None:
    """Release a semaphore; of those that wait, the most urgent ones get it."""
    holder, entity, amount = _holder(m, process, semaphore), m[semaphore + SEMAPHORE_ENTITY], 1
    if holder:
        hold = _hold(m, holder, semaphore)
        # Who holds it exclusively has all of it.
        amount = m[hold + HELD] if m[hold + HELD] == m[semaphore + USERS] else 1
        m[hold + HELD] -= amount
    elif m[semaphore + HAS_OWNER] or m[semaphore + USED] == 0:
        return
    m[semaphore + USED] -= amount
    report_access(m, _RELEASED, process, entity)
    change, was_wanted = m[EVENTS], _is_wanted(m, semaphore)
    _report_change(m, semaphore, m[semaphore + USED] + amount, was_wanted, was_wanted)
    if holder and m[semaphore + CEILING] >= 0:
        change_level(m, holder)
    best = _first_waiting(m, semaphore)
    while best:
        m[best + WAITS_FOR] = 0
        _grant(m, best, semaphore, m[best + WANTED])
        report_access(m, _ASSIGNED, best, entity)
        release(m, best)
        best = _first_waiting(m, semaphore)
    if m[IS_TRACED]:
        # The change comes before those who get it now, and is complete only after them.
        m[change + 5] = m[semaphore + USED]
        m[change + 6] = 2 * was_wanted + _is_wanted(m, semaphore)


def _holder(m: Memory, process: int, semaphore: int) -> int:
    """Whose use of a semaphore a process ends: its own, or without ownership that of any other; 0 if there is none."""
    if m[_hold(m, process, semaphore) + HELD]:
        return process
    if not m[semaphore + HAS_OWNER]:
        for place in range(m[PROCESSES], m[PROCESSES_END]):
            if m[_hold(m, m[place], semaphore) + HELD]:
                return m[place]
    return 0


def _first_waiting(m: Memory, semaphore: int) -> int:
    """The most urgent process that waits for a semaphore and can have it; 0 if there is none."""
    best, free = 0, m[semaphore + USERS] - m[semaphore + USED]
    for place in range(m[PROCESSES], m[PROCESSES_END]):
        process = m[place]
        if m[process + WAITS_FOR] == semaphore and m[process + WANTED] <= free:
            if best == 0 or is_before(m, process, best):
                best = process
    return best


def _is_wanted(m: Memory, semaphore: int) -> int:
    """1 if a process waits for a semaphore, otherwise 0; also 0 if there is no trace, for which alone it is needed."""
    if m[IS_TRACED]:
        for place in range(m[PROCESSES], m[PROCESSES_END]):
            if m[m[place] + WAITS_FOR] == semaphore:
                return 1
    return 0


def _report_change(m: Memory, semaphore: int, used_before: int, was_wanted: int, is_wanted: int) -> None:
    """Record how much of a semaphore was and is in use, and whether somebody waited and waits for it, if there is a trace."""
    if m[IS_TRACED]:
        entity = m[semaphore + SEMAPHORE_ENTITY]
        emit(m, _CHANGE, entity, used_before, entity, m[semaphore + USED], 2 * was_wanted + is_wanted)


# Events of the operating system.


def change_events(m: Memory, process: int, row: int, is_set: bool) -> None:
    """Set events of one process or of all, or clear those of the process itself."""
    only = m[row + OF_PROCESS] if is_set else process
    for entry in range(m[row + EVENT_LIST], m[row + EVENT_LIST_END], 2):
        if m[IS_TRACED]:
            owner = m[only + ENTITY] if only else NO_NOTE
            emit(m, _SET if is_set else _CLEAR, m[process + ENTITY], m[process + INSTANCE], m[entry + 1], 0, owner)
        for place in range(m[PROCESSES], m[PROCESSES_END]):
            if only == 0 or m[place] == only:
                m[m[m[place] + EVENTS_SET] + m[entry]] = 1 if is_set else 0
    for place in range(m[PROCESSES], m[PROCESSES_END]):
        other = m[place]
        if m[other + WAITS_EVENTS] and _are_set(m, other, m[other + WAITS_EVENTS]):
            m[other + WAITS_EVENTS] = 0
            release(m, other)


def _are_set(m: Memory, process: int, row: int) -> bool:
    """Whether all, or any, of some events of a process are set."""
    number, total = 0, 0
    for entry in range(m[row + EVENT_LIST], m[row + EVENT_LIST_END], 2):
        total += 1
        number += m[m[process + EVENTS_SET] + m[entry]]
    return number == total if m[row + NEEDS_ALL] else number > 0


def await_events(m: Memory, core: int, process: int, row: int) -> bool:
    """Wait for events; the result says whether the job continues."""
    for entry in range(m[row + EVENT_LIST], m[row + EVENT_LIST_END], 2):
        report_access(m, _WAIT_EVENT, process, m[entry + 1])
    if _are_set(m, process, row):
        return True
    m[process + WAITS_EVENTS] = row
    wait(m, core, process, m[row + IS_ACTIVE_WAIT] != 0)
    return False


# Runnables that others ask for.


def serve(m: Memory, core: int, process: int, operation: int, service: int, flags: int) -> bool:
    """Ask for a runnable, wait for its answer, or execute it; the result says whether the job continues.

    An execution of the runnable answers everything that was asked before it began.
    """
    if operation == ASK:
        m[service + ASKED] += 1
        m[m[process + TICKETS] + m[service + SERVICE_NUMBER]] = m[service + ASKED]
    elif operation == SERVE:
        m[service + BEGUN] = m[service + ASKED]
    elif operation == ANSWER:
        m[service + ANSWERED] = max(m[service + ANSWERED], m[service + BEGUN])
        for place in range(m[PROCESSES], m[PROCESSES_END]):
            other = m[place]
            if m[other + WAITS_ANSWER] == service and _is_answered(m, other, service):
                m[other + WAITS_ANSWER] = 0
                release(m, other)
    elif not _is_answered(m, process, service):
        m[process + WAITS_ANSWER] = service
        wait(m, core, process, flags & ACTIVE != 0)
        return False
    return True


def _is_answered(m: Memory, process: int, service: int) -> bool:
    """Whether a runnable has answered what a process has asked for last."""
    return m[m[process + TICKETS] + m[service + SERVICE_NUMBER]] <= m[service + ANSWERED]
