"""Threads of executors of the host: polling points, ready sets, callback groups, and what they publish.

After ros2/rclcpp `executor.cpp`, `multi_threaded_executor.cpp`, `static_single_threaded_executor.cpp` and `events_executor.cpp`. Before
a thread decides, everything that occurs at this instant has occurred.
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.cores import stays
from amalthea_uros.simulate.kernel.host_queues import wake_threads
from amalthea_uros.simulate.kernel.iterations import take_data
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.message_records import free_message, new_message, pop
from amalthea_uros.simulate.kernel.occurrences import occur
from amalthea_uros.simulate.kernel.waiting import wait
from amalthea_uros.simulate.kernel.wires import delay, lacks_delay


def call_next(m: Memory, core: int, process: int, thread: int) -> int:
    """Take what a thread calls next, or wait; the result is 0, 1 if it waits or lets others go first, or a reason to stop plus 1."""
    code = occur(m)
    if code:
        return code + 1
    if m[m[core + CORE_DOMAIN] + IS_DUE] and not stays(m, core, process):
        return CONTINUE + 1
    executor = m[thread + THREAD_OF]
    handle = _next_event(m, executor) if m[executor + WORKS_BY] == EVENT_QUEUE else _next_ready(m, executor)
    if handle:
        m[thread + CALLED_HANDLE] = handle
        m[thread + CALLED_SINCE] = m[handle + RELEASED]
        if m[handle + ITS_GROUP]:
            m[m[handle + ITS_GROUP]] = 1
        return 0
    m[process + READS_WITH] = thread
    m[m[thread + WAIT_ALARM] + ALARM_AT] = NEVER if m[executor + WORKS_BY] == EVENT_QUEUE else _next_due(m, executor)
    wait(m, core, process, False)
    return 1


def have_called(m: Memory, thread: int) -> None:
    """The group of a callback is free again, so that its other members can be called."""
    group = m[m[thread + CALLED_HANDLE] + ITS_GROUP]
    if group:
        m[group] = 0
        wake_threads(m, m[thread + THREAD_OF])


def host_publish(m: Memory, publication: int) -> int:
    """A callback publishes: the message begins its way to a subscription, or to the agent."""
    line = m[publication + PUBLISHES_ON]
    if m[FREE_MESSAGES] == 0:
        return NO_MESSAGES
    code = lacks_delay(m, line)
    if code == 0:
        message = new_message(m, m[line + CREATES])
        for place in range(m[publication + PUBLISHED_STAMPS], m[publication + PUBLISHED_STAMPS_END], 2):
            m[message + CARRIED + m[place + 1]] = m[m[place]]
        delay(m, line, message)
    return code


def _next_event(m: Memory, executor: int) -> int:
    """The callback of the first event that has something to call; 0 if there is none."""
    while m[executor + EVENT_FIRST]:
        event = pop(m, executor + EVENT_FIRST)
        handle, due = m[event + ABOUT], m[event + DUE]
        free_message(m, event)
        if m[handle + HANDLE_KIND] == TIMER:
            m[handle + CALLS] += 1
            m[handle + RELEASED] = due
            return handle
        if m[handle + KEPT_NUMBER]:
            take_data(m, handle)
            return handle
    return 0


def _next_ready(m: Memory, executor: int) -> int:
    """The first callback of the ready set whose group is free; if there is none, of a new one; 0 if nothing is ready."""
    handle = _first_ready(m, executor)
    if handle == 0:
        _poll(m, executor)
        handle = _first_ready(m, executor)
    if handle:
        m[handle + IS_READY] = 0
        take_data(m, handle)
    return handle


def _first_ready(m: Memory, executor: int) -> int:
    for place in range(m[executor + READY_HANDLES], m[executor + READY_HANDLES_END]):
        if m[m[place] + IS_READY] and not _is_busy(m, m[place]):
            return m[place]
    return 0


def _is_busy(m: Memory, handle: int) -> bool:
    return m[handle + ITS_GROUP] != 0 and m[m[handle + ITS_GROUP]] != 0


def _poll(m: Memory, executor: int) -> None:
    """A polling point: what is ready now, and of no busy group, becomes the ready set."""
    is_found = False
    for place in range(m[executor + READY_HANDLES], m[executor + READY_HANDLES_END]):
        handle, was_ready = m[place], m[m[place] + IS_READY]
        is_ready = m[handle + NEXT_CALL] <= m[NOW] if m[handle + HANDLE_KIND] == TIMER else m[handle + KEPT_NUMBER] > 0
        if _is_busy(m, handle):
            is_ready = was_ready != 0 and m[executor + KEEPS_TIMERS] != 0 and m[handle + HANDLE_KIND] == TIMER
        if m[executor + WORKS_BY] == FIRST_READY and is_found:
            is_ready = False
        m[handle + IS_READY] = 1 if is_ready else 0
        is_found = is_found or is_ready


def _next_due(m: Memory, executor: int) -> int:
    """When the first timer is due that can be called now."""
    first = NEVER
    for place in range(m[executor + READY_HANDLES], m[executor + READY_HANDLES_END]):
        handle = m[place]
        if m[handle + HANDLE_KIND] == TIMER and not _is_busy(m, handle):
            first = min(first, m[handle + NEXT_CALL])
    return first
