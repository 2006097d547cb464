"""How the thread of an executor listens: what it reads, acknowledges, asks for and sends again, until it has what it waits for.

After eProsima/Micro-XRCE-DDS-Client `session.c` and `output_reliable_stream.c`, and micro-ROS/rmw_microxrcedds `rmw_wait.c` and
`rmw_publish.c`. A call listens until a message is there, or its time is over. Whenever it begins to listen, the time begins anew after
which it asks for missing acknowledgements; it asks if that had passed by then.
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.flows import (
    accept,
    acknowledged,
    announce,
    end_of,
    fill_heartbeat,
    is_to_hand_over,
    with_part,
)
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.message_records import copy_of, free_message, keep, new_message, pop
from amalthea_uros.simulate.kernel.messages import acknowledge, write
from amalthea_uros.simulate.kernel.waiting import wait

#: The outcomes of `read`; a reason to stop is added to the last one.
HAS_READ, IS_DONE, HAS_TO_WAIT = range(3)


def read(m: Memory, core: int, process: int, executor: int) -> int:
    """Read one message, or wait for one; whether there is more to read is only known when the process continues."""
    awaited, inbox = m[executor + AWAITED], m[executor + INBOX]
    while True:
        if m[executor + LISTENING] == NOT_LISTENING:
            if _has_what_it_waits_for(m, executor):
                return IS_DONE
            m[executor + LISTENS_FOR] = max(0, m[executor + WAIT_END] - m[NOW])
            m[executor + LISTENING] = BEGINS_TO_LISTEN
        if m[executor + LISTENING] == BEGINS_TO_LISTEN:
            result = _ask(m, core, process, executor)
            if result:
                return HAS_TO_WAIT + result - 1
        if m[executor + LISTENING] == HAS_ASKED:
            m[executor + LISTENS_UNTIL] = m[NOW] + min(m[executor + LISTENS_FOR], _until_it_asks(m, executor))
            m[executor + LISTENING] = LISTENS
        message = m[inbox + UNREAD_FIRST]
        if message:
            code = _read_message(m, executor, message)
            if code:
                return HAS_TO_WAIT + code
            m[executor + LISTENING] = NOT_LISTENING
            return HAS_READ
        if not awaited and _is_woken(m, executor):
            m[executor + LISTENING] = NOT_LISTENING
            return IS_DONE
        if m[NOW] < m[executor + LISTENS_UNTIL]:
            m[process + READS_WITH] = executor
            m[m[executor + WAIT_ALARM] + ALARM_AT] = m[executor + LISTENS_UNTIL]
            wait(m, core, process, False)
            return HAS_TO_WAIT
        m[executor + LISTENS_FOR] -= min(m[executor + LISTENS_FOR], _until_it_asks(m, executor))
        if m[executor + LISTENS_FOR] == 0:
            m[executor + LISTENING] = NOT_LISTENING
            if awaited:
                m[awaited + TIMEOUTS] += 1
            return IS_DONE
        m[executor + LISTENING] = BEGINS_TO_LISTEN


def _has_what_it_waits_for(m: Memory, executor: int) -> bool:
    awaited, flow = m[executor + AWAITED], m[executor + OUT_FLOW]
    if awaited and m[awaited + ANSWERED_BY]:
        return m[awaited + IS_ANSWERED] != 0
    if awaited:
        # Everything has to be acknowledged, also what was sent before (`uxr_run_session_until_confirm_delivery`).
        return m[awaited + IS_REFUSED] != 0 or flow == 0 or m[flow + UNACKNOWLEDGED] >= m[flow + NEXT_PART]
    return 0 < m[executor + MESSAGES_PER_WAIT] <= m[executor + DATA_READ]


def _misses_acknowledgements(m: Memory, executor: int) -> bool:
    flow = m[executor + OUT_FLOW]
    return flow != 0 and m[flow + ASKS_AS] != 0 and m[flow + UNACKNOWLEDGED] < m[flow + NEXT_PART]


def _until_it_asks(m: Memory, executor: int) -> int:
    """For how long it listens at most before it asks; the time runs if something was not acknowledged when it began to listen."""
    flow = m[executor + OUT_FLOW]
    return m[flow + ASKS_AFTER] if flow != 0 and m[flow + ASKS_AT] != NEVER else NEVER


def _ask(m: Memory, core: int, process: int, executor: int) -> int:
    """Ask for missing acknowledgements if it is time; the result is that of `messages.write`."""
    flow, result = m[executor + OUT_FLOW], 0
    if _misses_acknowledgements(m, executor):
        if m[flow + IS_ASKING] and m[NOW] >= m[flow + ASKS_AT]:
            if m[FREE_MESSAGES] == 0:
                return NO_MESSAGES + 1
            message = new_message(m, m[flow + ASKS_AS])
            fill_heartbeat(m, message, flow)
            result = write(m, core, process, message)
            if result > 1:
                return result
        m[flow + IS_ASKING] = 1
        m[flow + ASKS_AT] = m[NOW] + m[flow + ASKS_AFTER]
    elif flow:
        m[flow + ASKS_AT] = NEVER
    m[executor + LISTENING] = HAS_ASKED
    return result


def _is_woken(m: Memory, executor: int) -> bool:
    """Whether what was read ends the wait, or something that is kept already.

    Who waits for no messages reads them for others, and continues to wait (micro-ROS/rmw_microxrcedds#305).
    """
    if m[executor + DATA_READ] and m[executor + MESSAGES_PER_WAIT] != NO_MESSAGE:
        return True
    for place in range(m[executor + HANDLES], m[executor + HANDLES_END]):
        handle = m[place]
        if m[handle + KEPT_NUMBER]:
            if m[executor + FLAGS_END_WAIT] if m[handle + HANDLE_KIND] == FLAG else m[executor + KEPT_END_WAIT]:
                return True
    return False


def _read_message(m: Memory, executor: int, message: int) -> int:
    """Read the first message of the inbox; the result is a reason to stop and call again, or 0."""
    transmission, awaited = m[message + SENT_AS], m[executor + AWAITED]
    handle, inbox, flow = m[transmission + FOR_HANDLE], m[executor + INBOX], m[message + ABOUT]
    if handle and m[message + ORIGINAL]:
        flow = m[transmission + FLOW]
        for part in range(m[message + FIRST_PART], end_of(m, message)):
            accept(m, flow, part)
        code = _hand_over(m, executor, flow, m[message + DUE])
        if code:
            return code
    pop(m, inbox + UNREAD_FIRST)
    if awaited and m[awaited + ANSWERED_BY] == transmission:
        m[awaited + IS_ANSWERED] = 1
    m[executor + REPLY_AS] = m[transmission + REPLY_WITH]
    m[executor + REPLIES_LEFT] = m[transmission + REPLIES]
    m[executor + REPLY_ABOUT] = flow
    if handle and not m[message + ORIGINAL]:
        m[executor + DATA_READ] += 1
        keep(m, m[transmission + READ_FROM], handle, message)
        return CONTINUE
    if m[message + ANNOUNCED_TO]:
        announce(m, flow, m[message + ANNOUNCED_TO])
    elif m[message + ABOUT]:
        acknowledged(m, flow, m[message + UP_TO])
        m[flow + IS_ASKING] = 0
        if m[message + MISSING]:
            # It sends everything again that is not acknowledged (`uxr_next_reliable_nack_buffer_to_send`).
            m[executor + AGAIN_FROM] = m[flow + UNACKNOWLEDGED]
            m[executor + AGAIN_TO] = m[flow + NEXT_PART]
    free_message(m, message)
    return CONTINUE


def _hand_over(m: Memory, executor: int, flow: int, arrived: int) -> int:
    """Keep all messages for their callbacks that can be handed over since one has arrived."""
    message = m[flow + SENT_FIRST]
    while is_to_hand_over(m, flow, message):
        if end_of(m, message) > m[flow + HANDED_OVER]:
            if m[FREE_MESSAGES] == 0:
                return NO_MESSAGES
            m[flow + HANDED_OVER] = end_of(m, message)
            m[executor + DATA_READ] += 1
            copy = copy_of(m, message)
            m[copy + DUE] = arrived
            transmission = m[message + SENT_AS]
            keep(m, m[transmission + READ_FROM], m[transmission + FOR_HANDLE], copy)
        message = m[message + NEXT_MESSAGE]
    return CONTINUE


def has_to_write(m: Memory, executor: int) -> bool:
    """Whether there is something to acknowledge of what was read, or to send again because of it."""
    return m[executor + REPLIES_LEFT] > 0 or m[executor + AGAIN_FROM] < m[executor + AGAIN_TO]


def reply(m: Memory, core: int, process: int, executor: int) -> int:
    """Write an acknowledgement of what was read, or a message that is sent again; the result is that of `messages.write`."""
    if m[executor + REPLIES_LEFT]:
        result = acknowledge(m, core, process, m[executor + REPLY_AS], m[executor + REPLY_ABOUT])
        if result <= 1:
            m[executor + REPLIES_LEFT] -= 1
        return result
    if m[FREE_MESSAGES] == 0:
        return NO_MESSAGES + 1
    message = with_part(m, m[executor + OUT_FLOW], m[executor + AGAIN_FROM])
    if message == 0:
        m[executor + AGAIN_FROM] = m[executor + AGAIN_TO]
        return 0
    copy = copy_of(m, message)
    first = max(0, m[executor + AGAIN_FROM] - m[message + FIRST_PART])
    m[copy + PARTS_IN_IT] = m[copy + PARTS_IN_IT] >> first << first
    result = write(m, core, process, copy)
    if result <= 1:
        m[m[message + SENT_AS] + SENT_AGAIN] += 1
        m[executor + AGAIN_FROM] = end_of(m, message)
    return result
