"""Executors: what their threads wait for, what is ready, and when the next iteration begins.

After ros2/rclc `executor.c`, ros2/rcl `timer.c` and `wait.c`: see `executors.semantics.loops`.
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.activation import fire
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.message_records import free_message, pop
from amalthea_uros.simulate.kernel.wires import draw_delay


def listen(m: Memory, executor: int) -> None:
    """Decide how long to wait: for the timeout, or until the first timer is due, cut to the resolution of the middleware."""
    if m[executor + INVOCATION] < 0:
        # The first iteration sets the time from which periods are counted.
        m[executor + INVOCATION] = m[NOW]
    timeout = m[executor + WAIT_TIMEOUT]
    for place in range(m[executor + HANDLES], m[executor + HANDLES_END]):
        handle = m[place]
        if m[handle + HANDLE_KIND] == TIMER:
            timeout = min(timeout, max(0, m[handle + NEXT_CALL] - m[NOW]))
    if m[executor + RESOLUTION]:
        timeout -= timeout % m[executor + RESOLUTION]
    m[executor + WAIT_FOR] = timeout


def begin_wait(m: Memory, process: int, executor: int) -> None:
    """Begin to wait for data, when the session is free."""
    m[executor + WAIT_END] = m[NOW] + m[executor + WAIT_FOR]
    m[executor + AWAITED] = 0
    m[executor + DATA_READ] = 0
    m[process + WAITED_UNTIL] = m[NOW]


def expect(m: Memory, executor: int, publication: int) -> None:
    """Begin to wait for the acknowledgements of a publication."""
    m[executor + WAIT_END] = m[NOW] + m[publication + TIMEOUT_AFTER]
    m[executor + AWAITED] = publication
    m[publication + IS_ANSWERED] = 0


def begin_iteration(m: Memory, process: int) -> None:
    """The wait is over: the times of the job count from here."""
    m[process + ACTIVATION] = m[process + WAITED_UNTIL]
    m[process + START] = m[NOW]
    m[process + SINCE] = m[NOW]
    for place in range(process + TIME_RUNNING, process + MIGRATIONS + 1):
        m[place] = 0


# What is ready, and what is called.


def check(m: Memory, executor: int) -> None:
    """Fix what is ready, and whether the trigger condition is true."""
    m[executor + IS_TRIGGERED] = 0
    for place in range(m[executor + HANDLES], m[executor + HANDLES_END]):
        handle = m[place]
        if m[handle + HANDLE_KIND] == TIMER or m[handle + HANDLE_KIND] == ITEM:
            m[handle + IS_READY] = 1 if m[handle + NEXT_CALL] <= m[NOW] else 0
        else:
            m[handle + IS_READY] = 1 if m[handle + KEPT_NUMBER] else 0
            if m[handle + HANDLE_KIND] == FLAG and m[handle + KEPT_NUMBER]:
                m[handle + KEPT_NUMBER] = 0
                m[handle + RELEASED] = m[handle + NEXT_CALL]
        if m[handle + IS_ALWAYS_CALLED] and not m[handle + IS_READY]:
            m[handle + RELEASED] = -1
    for trigger_set in range(m[executor + TRIGGER_SETS], m[executor + TRIGGER_SETS_END]):
        place, is_true = m[trigger_set], True
        while m[place]:
            is_true = is_true and m[m[place] + IS_READY] != 0
            place += 1
        if is_true:
            m[executor + IS_TRIGGERED] = 1


def take_data(m: Memory, handle: int) -> None:
    """Take the oldest message of a handle, or call a timer: its next time is on its grid, and later than now."""
    m[handle + CALLS] += 1
    if m[handle + HANDLE_KIND] == TIMER:
        due, period = m[handle + NEXT_CALL], m[handle + TIMER_PERIOD]
        if period == 0:
            # Always due (ros2/rcl `timer.c`): it is released when it is called.
            due = m[NOW]
        skipped = (m[NOW] - due) // period if period else 0
        m[handle + RELEASED] = due
        m[handle + LOST_CALLS] += skipped
        m[handle + NEXT_CALL] = due + (skipped + 1) * period
    elif m[handle + HANDLE_KIND] == ITEM:
        # Nothing releases it but its turn.
        m[handle + RELEASED] = m[NOW]
        m[handle + NEXT_CALL] = m[NOW] + m[handle + TIMER_PERIOD]
    elif m[handle + HANDLE_KIND] == RECEIVER:
        message = pop(m, handle + KEPT_FIRST)
        m[handle + KEPT_NUMBER] -= 1
        m[m[m[message + SENT_AS] + READ_FROM] + KEPT] -= 1
        m[handle + RELEASED] = m[message + DUE]
        for place in range(m[handle + HANDLE_STAMPS], m[handle + HANDLE_STAMPS_END], 2):
            m[m[place]] = m[message + CARRIED + m[place + 1]]
        free_message(m, message)


def plan_iteration(m: Memory, process: int, executor: int) -> int:
    """Plan when the next iteration begins: after a sleep, with the next period, or at once."""
    stream, period, wakes = m[executor + SLEEPS], m[executor + LOOP_PERIOD], m[NOW]
    if stream:
        if m[stream + STREAM_AT] == m[stream + STREAM_END]:
            m[CAUSE] = stream
            return STREAM_EMPTY
        wakes = max(m[NOW] + draw_delay(m, stream), m[executor + LAST_WAKE] + m[executor + PACE])
        m[executor + LAST_WAKE] = wakes
    elif period:
        m[executor + INVOCATION] += period
        left = max(0, m[executor + INVOCATION] - m[NOW])
        wakes = m[NOW] + left - left % m[executor + SLEEP_RESOLUTION]
    if wakes > m[NOW]:
        m[m[executor + LOOP_ALARM] + ALARM_AT] = wakes
        return CONTINUE
    return _go_on(m, process, executor)


def _go_on(m: Memory, process: int, executor: int) -> int:
    """The next iteration follows at once: the thread keeps its turn among its equals."""
    code, following = fire(m, m[executor + LOOP_STIMULUS], 0), m[executor + NEXT_PROCESS]
    if code == 0 and following == process:
        size = QUEUE_CAPTURES + m[process + CAPTURES_END] - m[process + CAPTURES]
        place = m[process + FIRST_PLACE] + size
        if place == m[process + QUEUE] + m[PLACES] * size:
            place = m[process + QUEUE]
        m[place + QUEUE_SEQUENCE] = m[process + SEQUENCE]
    elif code == 0:
        # The job of the next executor of the thread has begun.
        m[following + SEQUENCE] = m[process + SEQUENCE]
    return code
