"""Stimuli that occur, activations, and the beginning and end of jobs."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.budgets import activate_server, deactivate_server
from amalthea_uros.simulate.kernel.conditions import counts, holds, set_mode
from amalthea_uros.simulate.kernel.cores import leave_core, restore_level
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.message_records import free_message
from amalthea_uros.simulate.kernel.reports import NO_NOTE, emit, enter_state, observe, report, watch
from amalthea_uros.simulate.kernel.stages import publish

#: The kinds of events, as in `trace.table.EventKind`.
_ACTIVATE, _TERMINATE, _LOST, _TRIGGER = 0, 4, 12, 30


def fire(m: Memory, stimulus: int, origin: int) -> int:
    """A stimulus occurs; `origin` is the process that causes it, 0 if it comes from outside."""
    first, last = m[stimulus + TARGETS], m[stimulus + TARGETS_END]
    for place in range(first, last):
        pending = m[m[place] + PENDING]
        if pending >= m[PLACES] and pending < m[m[place] + LIMIT]:
            return QUEUE_FULL
    if m[stimulus + CONDITION] and not holds(m, m[stimulus + CONDITION]):
        return CONTINUE
    if not counts(m, m[stimulus + COUNTER]):
        return CONTINUE
    for place in range(m[stimulus + ASSIGNMENTS], m[stimulus + ASSIGNMENTS_END], 2):
        set_mode(m, m[place], m[place + 1])
    number, entity = m[stimulus + OCCURRENCES], m[stimulus + STIMULUS_ENTITY]
    m[stimulus + OCCURRENCES] = number + 1
    if m[IS_TRACED] and origin:
        emit(m, _TRIGGER, m[origin + ENTITY], m[origin + INSTANCE], entity, number, NO_NOTE)
    elif m[IS_TRACED]:
        emit(m, _TRIGGER, entity, number, entity, number, NO_NOTE)
    if m[stimulus + STIMULUS_SOURCE]:
        observe(m, m[stimulus + STIMULUS_SOURCE] - 1, 0)
    if m[stimulus + MESSAGES]:
        _arrive(m, m[stimulus + MESSAGES])
    for place in range(first, last):
        activate(m, m[place], entity, number)
    return CONTINUE


def _arrive(m: Memory, queue: int) -> None:
    """A message arrives in a queue, or is lost."""
    if m[queue + ARRIVED] - m[queue + TAKEN_MESSAGES] < m[queue + MESSAGE_LIMIT]:
        m[queue + ARRIVED] += 1
    else:
        m[queue + LOST_MESSAGES] += 1


def publish_all(m: Memory, stimulus: int) -> None:
    """Publish what is due under LET when a stimulus occurs: everything is there before anybody reads at that instant."""
    for place in range(m[stimulus + TARGETS], m[stimulus + TARGETS_END]):
        if m[m[place] + LET_STAGES] != m[m[place] + LET_STAGES_END]:
            publish(m, m[place])


def activate(m: Memory, process: int, stimulus: int, number: int) -> None:
    """Activate a process, or lose the activation; `stimulus` is the number of the entity."""
    instance = m[process + NEXT_INSTANCE]
    m[process + NEXT_INSTANCE] = instance + 1
    if m[process + PENDING] >= m[process + LIMIT]:
        m[process + LOST] += 1
        if m[process + IS_ABOUT_MESSAGE] and m[MESSAGE]:
            free_message(m, m[MESSAGE])
        if m[IS_TRACED]:
            emit(m, _LOST, stimulus, number, m[process + ENTITY], instance, NO_NOTE)
        return
    m[process + ACTIVATIONS] += 1
    if m[process + WATCHED]:
        watch(m, process, _ACTIVATE, 0)
    if m[IS_TRACED]:
        emit(m, _ACTIVATE, stimulus, number, m[process + ENTITY], instance, NO_NOTE)
    _enqueue(m, process, instance)
    if m[process + DECISION]:
        _enqueue(m, m[process + DECISION], 0)


def _enqueue(m: Memory, process: int, instance: int) -> None:
    captures, end = m[process + CAPTURES], m[process + CAPTURES_END]
    size = QUEUE_CAPTURES + end - captures
    place = m[process + FIRST_PLACE]
    if m[process + PENDING]:
        place += (m[process + PENDING] % m[PLACES]) * size
        if place >= m[process + QUEUE] + m[PLACES] * size:
            place -= m[PLACES] * size
    m[place + QUEUE_TIME] = m[NOW]
    m[place + QUEUE_INSTANCE] = instance
    m[ORDER] += 1
    m[place + QUEUE_SEQUENCE] = m[ORDER]
    for capture in range(captures, end):
        m[place + QUEUE_CAPTURES + capture - captures] = m[m[capture]]
    m[process + PENDING] += 1
    if m[process + PENDING] == 1:
        _begin_job(m, process)


def _begin_job(m: Memory, process: int) -> None:
    """The first pending activation becomes the job of a process."""
    place = m[process + FIRST_PLACE]
    m[process + ACTIVATION] = m[place + QUEUE_TIME]
    m[process + INSTANCE] = m[place + QUEUE_INSTANCE]
    if m[process + IS_ABOUT_MESSAGE]:
        m[process + ITS_MESSAGE] = m[place + QUEUE_CAPTURES]
    m[process + AT] = m[process + ENTRY]
    m[process + STATE] = ACTIVATED
    m[process + SINCE] = m[NOW]
    m[process + SEQUENCE] = m[place + QUEUE_SEQUENCE]
    if m[process + IS_BY_DEADLINE]:
        m[process + OWN_DEADLINE] = m[process + ACTIVATION] + m[process + RELATIVE_DEADLINE]
        m[process + DEADLINE] = m[process + OWN_DEADLINE]
    if m[process + SERVER]:
        activate_server(m, m[process + SERVER])
    m[m[process + GROUP]] += 1
    m[m[process + DOMAIN] + PRESENT] += 1
    m[m[process + DOMAIN] + IS_DUE] = 1


def end_job(m: Memory, core: int) -> None:
    """The job of a core ends."""
    process = m[core + RUNS]
    enter_state(m, process, TERMINATED)
    report(m, _TERMINATE, core, process)
    if m[process + IS_REPORTED]:
        _report(m, process)
    m[process + TIME_RUNNING] = 0
    m[process + TIME_WAITING] = 0
    m[process + TIME_POLLING] = 0
    m[process + TIME_PARKING] = 0
    m[process + PREEMPTIONS] = 0
    m[process + MIGRATIONS] = 0
    m[process + IS_STARTED] = 0
    m[process + MASKS] = 0
    if m[m[process + DOMAIN] + RAISED]:
        restore_level(m, process)
    size = QUEUE_CAPTURES + m[process + CAPTURES_END] - m[process + CAPTURES]
    m[process + FIRST_PLACE] += size
    if m[process + FIRST_PLACE] == m[process + QUEUE] + m[PLACES] * size:
        m[process + FIRST_PLACE] = m[process + QUEUE]
    m[process + PENDING] -= 1
    m[m[process + GROUP]] -= 1
    m[m[process + DOMAIN] + PRESENT] -= 1
    leave_core(m, core)
    if m[process + PENDING]:
        _begin_job(m, process)
    elif m[process + SERVER]:
        deactivate_server(m, m[process + SERVER])


def _report(m: Memory, process: int) -> None:
    row = m[JOBS]
    m[row] = m[process + NUMBER]
    m[row + 1] = m[process + INSTANCE]
    m[row + 2] = m[process + ACTIVATION]
    m[row + 3] = m[process + START]
    m[row + 4] = m[NOW]
    m[row + 5] = m[process + TIME_RUNNING]
    m[row + 6] = m[process + TIME_WAITING]
    m[row + 7] = m[process + TIME_POLLING]
    m[row + 8] = m[process + TIME_PARKING]
    m[row + 9] = m[process + PREEMPTIONS]
    m[row + 10] = m[process + MIGRATIONS]
    m[JOBS] = row + JOB_SIZE
