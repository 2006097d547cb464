"""Messages: through the agent, over the wire, through the driver and the receiving processes, until they wait to be read.

A message that acknowledges a publication, or a part of it, comes back as one of its own. Times in the agent, in switches and in the
driver are delays that keep the order of messages. Each function has its whole effect, or none and a reason to stop.
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.activation import fire
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.message_records import append, free_message, new_message
from amalthea_uros.simulate.kernel.waiting import release, wait


def ring(m: Memory, alarm: int) -> int:
    """Carry out an alarm whose time has come."""
    owner = m[alarm + ALARM_OF]
    if m[alarm + ALARM_KIND] == DELAY_LINE:
        return _come_out(m, owner)
    if m[alarm + ALARM_KIND] == NEXT_ITERATION:
        code = fire(m, m[owner + LOOP_STIMULUS], 0)
        if code:
            return code
    else:
        wake(m, m[owner + READER_PROCESS])
    m[alarm + ALARM_AT] = NEVER
    return CONTINUE


def wake(m: Memory, process: int) -> None:
    """A process that waits for messages continues."""
    executor = m[process + READS_WITH]
    if executor:
        m[process + READS_WITH] = 0
        m[m[executor + WAIT_ALARM] + ALARM_AT] = NEVER
        release(m, process)


# Delay lines.


def bring(m: Memory, line: int, publication: int) -> int:
    """A message begins its way on a line; it acknowledges a publication, or nothing (0)."""
    if m[FREE_MESSAGES] == 0:
        return NO_MESSAGES
    code = _lacks_delay(m, line)
    if code == 0:
        message = new_message(m, m[line + CREATES])
        m[message + ACKNOWLEDGES] = publication
        _delay(m, line, message)
    return code


def _lacks_delay(m: Memory, line: int) -> int:
    """Why a line cannot take a message now."""
    stream = m[line + DELAY]
    if m[stream + STREAM_AT] == m[stream + STREAM_END]:
        m[CAUSE] = stream
        return STREAM_EMPTY
    return CONTINUE


def draw_delay(m: Memory, stream: int) -> int:
    """The next delay of a stream."""
    delay = m[m[stream + STREAM_AT]]
    m[stream + STREAM_AT] += 1
    return delay


def _delay(m: Memory, line: int, message: int) -> None:
    """Put a message on a line, which none overtakes."""
    due = m[NOW] + draw_delay(m, m[line + DELAY])
    alarm = m[line + ITS_ALARM]
    if m[line + FIRST_MESSAGE]:
        due = max(due, m[m[line + LAST_MESSAGE] + DUE])
    else:
        m[alarm + ALARM_AT] = due
    m[message + DUE] = due
    append(m, line + FIRST_MESSAGE, message)


def _come_out(m: Memory, line: int) -> int:
    """The first message of a line comes out."""
    message = m[line + FIRST_MESSAGE]
    following = m[message + NEXT_MESSAGE]
    code = enter_wire(m, message, 0) if m[line + ENTERS_WIRE] else _receive(m, message)
    if code == 0:
        m[line + FIRST_MESSAGE] = following
        m[m[line + ITS_ALARM] + ALARM_AT] = m[following + DUE] if following else NEVER
    return code


# Wires and what receives messages.


def enter_wire(m: Memory, message: int, origin: int) -> int:
    """A message is queued on its wire; `origin` is the process that has written it, 0 if it comes from outside."""
    transmission = m[message + SENT_AS]
    for place in range(m[transmission + STAMPS_TO], m[transmission + STAMPS_TO_END], 2):
        m[m[place]] = m[message + CARRIED + m[place + 1]]
    m[MESSAGE] = message
    return fire(m, m[transmission + WIRE_STIMULUS], origin)


def pass_on(m: Memory, process: int, transmission: int) -> int:
    """A message has left the wire, and continues from there."""
    message, line_in = m[process + ITS_MESSAGE], m[transmission + LINE_IN]
    code = _lacks_delay(m, line_in) if line_in else CONTINUE
    if code:
        return code
    free = m[FREE_MESSAGES]
    for place in range(m[transmission + RELAYS], m[transmission + RELAYS_END]):
        if free == 0:
            return NO_MESSAGES
        free = m[free + NEXT_MESSAGE]
        code = _lacks_delay(m, m[place])
        if code:
            return code
    if message:
        _leave_wire(m, transmission, message)
    m[transmission + DONE_WRITING] += 1
    for place in range(m[PROCESSES], m[PROCESSES_END]):
        writer = m[place]
        if m[writer + WRITES_TO] == transmission and m[writer + WRITE_TICKET] <= m[transmission + DONE_WRITING]:
            m[writer + WRITES_TO] = 0
            release(m, writer)
    return CONTINUE


def _leave_wire(m: Memory, transmission: int, message: int) -> None:
    for place in range(m[transmission + STAMPS_FROM], m[transmission + STAMPS_FROM_END], 2):
        m[message + CARRIED + m[place + 1]] = m[m[place]]
    for place in range(m[transmission + RELAYS], m[transmission + RELAYS_END]):
        _relay(m, m[place], message)
    if m[transmission + LINE_IN]:
        _delay(m, m[transmission + LINE_IN], message)
    else:
        free_message(m, message)


def _relay(m: Memory, line: int, message: int) -> None:
    """The agent sends a message back that somebody here has subscribed to."""
    copy = new_message(m, m[line + CREATES])
    for index in range(CARRIED, CARRIED + m[CARRIED_VALUES]):
        m[copy + index] = m[message + index]
    _delay(m, line, copy)


def _receive(m: Memory, message: int) -> int:
    """A message has come through the driver."""
    received_by = m[m[message + SENT_AS] + RECEIVED_BY]
    if received_by:
        m[MESSAGE] = message
        return fire(m, received_by, 0)
    put_in_inbox(m, message)
    return CONTINUE


def put_in_inbox(m: Memory, message: int) -> None:
    """A message waits to be read; a flag is seen at once."""
    transmission = m[message + SENT_AS]
    inbox, handle = m[transmission + READ_FROM], m[transmission + FOR_HANDLE]
    m[message + DUE] = m[NOW]
    is_flag = handle != 0 and m[handle + HANDLE_KIND] == FLAG
    if is_flag:
        if m[handle + KEPT_NUMBER]:
            m[handle + LOST_CALLS] += 1
        else:
            m[handle + KEPT_NUMBER] = 1
            m[handle + NEXT_CALL] = m[NOW]
        free_message(m, message)
    elif inbox:
        append(m, inbox + UNREAD_FIRST, message)
    else:
        free_message(m, message)
        return
    for place in range(m[PROCESSES], m[PROCESSES_END]):
        reader = m[m[place] + READS_WITH]
        # A flag that does not end waits is seen after the next one.
        if reader and m[reader + INBOX] == inbox and (not is_flag or m[reader + FLAGS_END_WAIT]):
            wake(m, m[place])


# Writing.


def write(m: Memory, core: int, process: int, transmission: int, publication: int) -> int:
    """Write a message of a publication that waits for acknowledgements, or (0) for none; 1: the process waits until it is on the wire.

    The result is 0, 1, or a reason to stop plus 1.
    """
    code = post(m, process, transmission, publication)
    if code:
        return code + 1
    if not m[transmission + HOLDS_WRITER]:
        return 0
    m[process + WRITES_TO] = transmission
    m[process + WRITE_TICKET] = m[transmission + WRITTEN]
    wait(m, core, process, False)
    return 1


def post(m: Memory, process: int, transmission: int, publication: int) -> int:
    """Write a message, and continue."""
    if m[FREE_MESSAGES] == 0:
        return NO_MESSAGES
    message = new_message(m, transmission)
    m[message + ACKNOWLEDGES] = publication
    code = enter_wire(m, message, process)
    if code:
        free_message(m, message)
        return code
    m[transmission + WRITTEN] += 1
    if publication:
        m[publication + ASKED_FOR] += m[publication + PARTS_SENT]
    return CONTINUE
