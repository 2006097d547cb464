"""Messages: over the wire, through the driver and the receiving processes, until they wait to be read.

A message that acknowledges another one, or a part of it, comes back as one of its own. Times in the agent, in switches and in the
driver are delays that keep the order of messages. Each function has its whole effect, or none and a reason to stop; some continue
when they are called again.
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.activation import fire
from amalthea_uros.simulate.kernel.agent import (
    ask,
    hand_over,
    lacks_to_relay,
    read_acknowledgement,
    relay,
    send,
    send_first,
)
from amalthea_uros.simulate.kernel.flows import fill_acknowledgement, has_room
from amalthea_uros.simulate.kernel.host_queues import deliver, expire
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.losses import is_lost, lacks_loss_value
from amalthea_uros.simulate.kernel.message_records import append, free_message, new_message
from amalthea_uros.simulate.kernel.waiting import release, wait, wake
from amalthea_uros.simulate.kernel.wires import delay_from, enter_wire, lacks_value


def ring(m: Memory, alarm: int) -> int:
    """Carry out an alarm whose time has come."""
    owner = m[alarm + ALARM_OF]
    if m[alarm + ALARM_KIND] == DELAY_LINE:
        return _come_out(m, owner)
    if m[alarm + ALARM_KIND] == AGENT_ASKS:
        return ask(m, alarm, owner)
    if m[alarm + ALARM_KIND] == HOST_TIMERS:
        return expire(m, alarm, owner)
    if m[alarm + ALARM_KIND] == NEXT_ITERATION:
        code = fire(m, m[owner + LOOP_STIMULUS], 0)
        if code:
            return code
    else:
        wake(m, m[owner + READER_PROCESS])
    m[alarm + ALARM_AT] = NEVER
    return CONTINUE


def _come_out(m: Memory, line: int) -> int:
    """The first message of a line comes out."""
    message = m[line + FIRST_MESSAGE]
    following, leads_to = m[message + NEXT_MESSAGE], m[line + LEADS_TO]
    if leads_to == TO_WIRE:
        code = send(m, message)
    elif leads_to == TO_AGENT_ITSELF:
        code = read_acknowledgement(m, message)
    elif leads_to == TO_HOST_QUEUE:
        code = deliver(m, message)
    else:
        code = _receive(m, message)
    if code == 0:
        m[line + FIRST_MESSAGE] = following
        m[m[line + ITS_ALARM] + ALARM_AT] = m[following + DUE] if following else NEVER
    return code


# The end of a wire, and what receives messages.


def arrive(m: Memory, process: int, transmission: int) -> int:
    """Decide whether a message is lost on the wire."""
    code = lacks_loss_value(m, transmission)
    if code == 0 and m[process + ITS_MESSAGE] and is_lost(m, process, transmission):
        m[m[process + ITS_MESSAGE] + PARTS_IN_IT] = 0
    return code


def has_arrived(m: Memory, process: int) -> bool:
    """Whether the message of a job is not lost, or only some of its parts are."""
    message = m[process + ITS_MESSAGE]
    return message == 0 or m[message + PARTS_IN_IT] != 0


def pass_on(m: Memory, process: int, transmission: int) -> int:
    """A message has left the wire, and continues from there if it is not lost."""
    if m[process + ITS_MESSAGE]:
        code = _leave_wire(m, transmission, m[process + ITS_MESSAGE], m[process + AT_HOST])
        if code:
            return code
    m[transmission + DONE_WRITING] += 1
    for place in range(m[PROCESSES], m[PROCESSES_END]):
        writer = m[place]
        if m[writer + WRITES_TO] == transmission and m[writer + WRITE_TICKET] <= m[transmission + DONE_WRITING]:
            m[writer + WRITES_TO] = 0
            release(m, writer)
    return CONTINUE


def _leave_wire(m: Memory, transmission: int, message: int, at_host: int) -> int:
    line_in = m[transmission + LINE_IN]
    if m[message + PARTS_IN_IT] == 0:
        free_message(m, message)
        return CONTINUE
    code = lacks_value(m, m[transmission + DELAY_IN]) if line_in else CONTINUE
    if code:
        return code
    for place in range(m[transmission + STAMPS_FROM], m[transmission + STAMPS_FROM_END], 2):
        value = m[m[place]]
        m[message + CARRIED + m[place + 1]] = value
        if m[message + ORIGINAL]:
            m[m[message + ORIGINAL] + CARRIED + m[place + 1]] = value
    if line_in:
        delay_from(m, line_in, message, m[NOW], m[transmission + DELAY_IN])
        return CONTINUE
    if m[message + ORIGINAL]:
        code = hand_over(m, m[transmission + FLOW])
    else:
        code = lacks_to_relay(m, transmission)
        if code == 0:
            relay(m, transmission, message, at_host)
    if code == 0:
        free_message(m, message)
    return code


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
    transmission, about = m[message + SENT_AS], m[message + ABOUT]
    inbox, handle = m[about + FLOW_INBOX] if about else m[transmission + READ_FROM], m[transmission + FOR_HANDLE]
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


# Writing. The result is 0 if the process continues, 1 if it waits until the message is on the wire, or a reason to stop plus 1.


def publish(m: Memory, core: int, process: int, transmission: int, publication: int) -> int:
    """Write a message of a callback; if there is no room for a reliable one, it is not sent."""
    flow = m[transmission + FLOW]
    if publication:
        m[publication + IS_REFUSED] = 0
        if flow and not has_room(m, flow, m[transmission + PARTS_OF]):
            m[publication + IS_REFUSED] = 1
            m[publication + REFUSALS] += 1
            return 0
    code = post(m, process, transmission)
    return code + 1 if code else until_on_wire(m, core, process, transmission)


def post(m: Memory, process: int, transmission: int) -> int:
    """Write a message, and continue; the result is a reason to stop, or 0."""
    if m[FREE_MESSAGES] == 0:
        return NO_MESSAGES
    flow, message = m[transmission + FLOW], new_message(m, transmission)
    code = send_first(m, flow, message, process) if flow else enter_wire(m, message, process)
    if code:
        free_message(m, message)
        return code
    m[transmission + WRITTEN] += 1
    return CONTINUE


def acknowledge(m: Memory, core: int, process: int, transmission: int, flow: int) -> int:
    """Write an acknowledgement of what has arrived of a flow, or (0) of nothing that is followed."""
    if m[FREE_MESSAGES] == 0:
        return NO_MESSAGES + 1
    message = new_message(m, transmission)
    if flow:
        fill_acknowledgement(m, message, flow)
    return write(m, core, process, message)


def write(m: Memory, core: int, process: int, message: int) -> int:
    """Write a message, which is gone if it cannot be written now."""
    transmission = m[message + SENT_AS]
    code = enter_wire(m, message, process)
    if code:
        free_message(m, message)
        return code + 1
    m[transmission + WRITTEN] += 1
    return until_on_wire(m, core, process, transmission)


def until_on_wire(m: Memory, core: int, process: int, transmission: int) -> int:
    """Have a process wait until the message that it has written last is on the wire, if its driver does."""
    if not m[transmission + HOLDS_WRITER]:
        return 0
    m[process + WRITES_TO] = transmission
    m[process + WRITE_TICKET] = m[transmission + WRITTEN]
    wait(m, core, process, False)
    return 1
