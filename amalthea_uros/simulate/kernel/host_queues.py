"""The queues of executors of the host: messages for their subscriptions, and the events of an events executor.

After ros2/rclcpp `events_executor.cpp` and `timers_manager.cpp`: a thread of its own queues an event whenever a timer is due, so that
no period is left out; an event whose message was overwritten calls nothing.
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.message_records import append, keep, new_message
from amalthea_uros.simulate.kernel.waiting import wake


def deliver(m: Memory, message: int) -> int:
    """A message reaches the queue of a subscription."""
    transmission = m[message + SENT_AS]
    handle = m[transmission + FOR_HANDLE]
    executor = m[handle + HANDLE_OF]
    if m[executor + WORKS_BY] == EVENT_QUEUE:
        if m[FREE_MESSAGES] == 0:
            return NO_MESSAGES
        _queue_event(m, executor, handle, m[NOW])
    m[message + DUE] = m[NOW]
    keep(m, m[transmission + READ_FROM], handle, message)
    wake_threads(m, executor)
    return CONTINUE


def expire(m: Memory, alarm: int, executor: int) -> int:
    """Timers of an events executor are due."""
    following = NEVER
    for place in range(m[executor + READY_HANDLES], m[executor + READY_HANDLES_END]):
        handle = m[place]
        if m[handle + HANDLE_KIND] == TIMER:
            while m[handle + NEXT_CALL] <= m[NOW]:
                if m[FREE_MESSAGES] == 0:
                    return NO_MESSAGES
                _queue_event(m, executor, handle, m[handle + NEXT_CALL])
                m[handle + NEXT_CALL] += m[handle + TIMER_PERIOD]
            following = min(following, m[handle + NEXT_CALL])
    m[alarm + ALARM_AT] = following
    wake_threads(m, executor)
    return CONTINUE


def _queue_event(m: Memory, executor: int, handle: int, time: int) -> None:
    event = new_message(m, 0)
    m[event + ABOUT] = handle
    m[event + DUE] = time
    append(m, executor + EVENT_FIRST, event)


def wake_threads(m: Memory, executor: int) -> None:
    """The threads of an executor that wait look again."""
    for place in range(m[executor + ITS_THREADS], m[executor + ITS_THREADS_END]):
        wake(m, m[m[place] + READER_PROCESS])
