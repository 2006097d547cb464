"""Executors: what their threads read and wait for, what is ready, and when the next iteration begins.

After ros2/rclc `executor.c`, ros2/rcl `timer.c` and `wait.c`, micro-ROS/rmw_microxrcedds `rmw_wait.c` and `rmw_publish.c`: see
`executors.semantics.loops`.
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.activation import fire
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.message_records import append, free_message, pop
from amalthea_uros.simulate.kernel.messages import draw_delay, write
from amalthea_uros.simulate.kernel.waiting import wait

#: The outcomes of `read`.
HAS_READ, IS_DONE, HAS_TO_WAIT = range(3)


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


def read(m: Memory, core: int, process: int, executor: int) -> int:
    """Read one message, or wait for one; whether there is more to read is only known when the process continues."""
    awaited, inbox = m[executor + AWAITED], m[executor + INBOX]
    if awaited:
        if m[awaited + ACKNOWLEDGED_PARTS] >= m[awaited + ASKED_FOR]:
            return IS_DONE
    elif 0 < m[executor + MESSAGES_PER_WAIT] <= m[executor + DATA_READ]:
        return IS_DONE
    message = m[inbox + UNREAD_FIRST]
    if message:
        pop(m, inbox + UNREAD_FIRST)
        _read_message(m, executor, message)
        return HAS_READ
    if not awaited and (m[executor + DATA_READ] or _is_woken(m, executor)):
        return IS_DONE
    if m[NOW] >= m[executor + WAIT_END]:
        if awaited:
            m[awaited + TIMEOUTS] += 1
        return IS_DONE
    m[process + READS_WITH] = executor
    m[m[executor + WAIT_ALARM] + ALARM_AT] = m[executor + WAIT_END]
    wait(m, core, process, False)
    return HAS_TO_WAIT


def _is_woken(m: Memory, executor: int) -> bool:
    """Whether something that is kept already ends the wait."""
    for place in range(m[executor + HANDLES], m[executor + HANDLES_END]):
        handle = m[place]
        if m[handle + KEPT_NUMBER]:
            if m[executor + FLAGS_END_WAIT] if m[handle + HANDLE_KIND] == FLAG else m[executor + KEPT_END_WAIT]:
                return True
    return False


def _read_message(m: Memory, executor: int, message: int) -> None:
    transmission = m[message + SENT_AS]
    m[executor + REPLY_AS] = m[transmission + REPLY_WITH]
    m[executor + REPLIES_LEFT] = m[transmission + REPLIES]
    if m[transmission + FOR_HANDLE]:
        m[executor + DATA_READ] += 1
        _keep(m, m[transmission + READ_FROM], m[transmission + FOR_HANDLE], message)
        return
    if m[message + ACKNOWLEDGES]:
        m[m[message + ACKNOWLEDGES] + ACKNOWLEDGED_PARTS] += 1
    free_message(m, message)


def _keep(m: Memory, inbox: int, handle: int, message: int) -> None:
    """Keep a message for a callback; beyond its depth the oldest one or itself is lost, and itself if there is no slot."""
    if 0 < m[handle + DEPTH] <= m[handle + KEPT_NUMBER] and m[handle + OVERWRITES]:
        m[handle + LOST_CALLS] += 1
        free_message(m, pop(m, handle + KEPT_FIRST))
    elif m[handle + KEPT_NUMBER] >= m[handle + DEPTH] or m[inbox + KEPT] >= m[inbox + SLOTS]:
        m[handle + LOST_CALLS] += 1
        free_message(m, message)
        return
    else:
        m[handle + KEPT_NUMBER] += 1
        m[inbox + KEPT] += 1
    append(m, handle + KEPT_FIRST, message)


def reply(m: Memory, core: int, process: int, executor: int) -> int:
    """Write an acknowledgement of what was read; the result is that of `write`."""
    result = write(m, core, process, m[executor + REPLY_AS], 0)
    if result <= 1:
        m[executor + REPLIES_LEFT] -= 1
    return result


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
        if m[handle + HANDLE_KIND] == TIMER:
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
    code = fire(m, m[executor + LOOP_STIMULUS], 0)
    if code == 0:
        size = QUEUE_CAPTURES + m[process + CAPTURES_END] - m[process + CAPTURES]
        place = m[process + FIRST_PLACE] + size
        if place == m[process + QUEUE] + m[PLACES] * size:
            place = m[process + QUEUE]
        m[place + QUEUE_SEQUENCE] = m[process + SEQUENCE]
    return code
