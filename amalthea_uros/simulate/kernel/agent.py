"""The agent: it sends messages of the host, hands over and acknowledges what arrives, and sends again what is missing.

After eProsima/Micro-XRCE-DDS-Agent `Processor.cpp` and `OutputStream.hpp`. Each function has its whole effect, or none and a reason to
stop, after which it is called again.
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.flows import (
    accept,
    acknowledged,
    announce,
    end_of,
    fill_heartbeat,
    has_room,
    is_to_hand_over,
    number,
    with_part,
)
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.losses import is_lost, lacks_loss_value
from amalthea_uros.simulate.kernel.message_records import append, carry, copy_of, free_message, new_message, parts_of
from amalthea_uros.simulate.kernel.stages import observe_response
from amalthea_uros.simulate.kernel.wires import bring, delay, delay_from, enter_wire, lacks_delay, lacks_value, reach_host


def send(m: Memory, message: int) -> int:
    """A message comes out of the agent; a reliable one waits for room."""
    flow = m[m[message + SENT_AS] + FLOW]
    if flow == 0 or m[message + ORIGINAL]:
        return enter_wire(m, message, 0)
    if m[flow + HELD_FIRST] or not has_room(m, flow, parts_of(m, message)):
        append(m, flow + HELD_FIRST, message)
        return CONTINUE
    return send_first(m, flow, message, 0)


def send_first(m: Memory, flow: int, message: int, origin: int) -> int:
    """Send a reliable message for the first time, and keep it; `origin` is as in `wires.enter_wire`."""
    if m[FREE_MESSAGES] == 0:
        return NO_MESSAGES
    m[message + FIRST_PART] = m[flow + NEXT_PART]
    m[message + USES] = 1
    copy = copy_of(m, message)
    code = enter_wire(m, copy, origin)
    if code:
        free_message(m, copy)
        return code
    number(m, flow, message)
    return CONTINUE


# What arrives.


def part_arrives(m: Memory, process: int, line: int, part: int) -> int:
    """A part of a message of the controller has left the wire: if it is not lost, the agent acknowledges what it has."""
    message = m[process + ITS_MESSAGE]
    if m[FREE_MESSAGES] == 0:
        return NO_MESSAGES
    code = lacks_delay(m, line)
    if code or message == 0:
        return code if code else bring(m, line, 0)
    transmission = m[message + SENT_AS]
    code = lacks_loss_value(m, transmission)
    if code:
        return code
    if is_lost(m, process, transmission):
        m[message + PARTS_IN_IT] &= ~(1 << part)
        return CONTINUE
    flow = m[transmission + FLOW]
    if m[message + ANNOUNCED_TO]:
        flow = m[message + ABOUT]
        announce(m, flow, m[message + ANNOUNCED_TO])
    elif flow:
        accept(m, flow, m[message + FIRST_PART] + part)
    return bring(m, line, flow)


def hand_over(m: Memory, flow: int) -> int:
    """The host gets everything that has arrived in its order."""
    message = m[flow + SENT_FIRST]
    while is_to_hand_over(m, flow, message):
        if end_of(m, message) > m[flow + HANDED_OVER]:
            code = _hand_over(m, message)
            if code:
                return code
            m[flow + HANDED_OVER] = end_of(m, message)
        message = m[message + NEXT_MESSAGE]
    return CONTINUE


def _hand_over(m: Memory, message: int) -> int:
    transmission = m[message + SENT_AS]
    code = lacks_to_relay(m, transmission)
    if code == 0:
        code = lacks_value(m, m[transmission + TO_HOST])
    if code:
        return code
    at_host = reach_host(m, transmission)
    relay(m, transmission, message, at_host)
    for place in range(m[transmission + RESPONSES], m[transmission + RESPONSES_END], 2):
        observe_response(m, m[place], at_host, m[message + CARRIED + m[place + 1]])
    return CONTINUE


def lacks_to_relay(m: Memory, transmission: int) -> int:
    """Why the agent cannot send a message back to all that have subscribed to it."""
    free = m[FREE_MESSAGES]
    for place in range(m[transmission + RELAYS], m[transmission + RELAYS_END]):
        if free == 0:
            return NO_MESSAGES
        free = m[free + NEXT_MESSAGE]
        code = lacks_delay(m, m[place])
        if code:
            return code
    return CONTINUE


def relay(m: Memory, transmission: int, message: int, at_host: int) -> None:
    """The agent sends a message back that somebody here has subscribed to, from the time at which the host has it."""
    for place in range(m[transmission + RELAYS], m[transmission + RELAYS_END]):
        copy = new_message(m, m[m[place] + CREATES])
        carry(m, message, copy)
        m[copy + BORN] = at_host
        delay_from(m, m[place], copy, at_host, m[m[place] + DELAY])


# What is missing.


def read_acknowledgement(m: Memory, message: int) -> int:
    """An acknowledgement of the controller is there: send what is missing, and what has waited for room."""
    flow = m[message + ABOUT]
    if flow:
        acknowledged(m, flow, m[message + UP_TO])
        # What is missing on a wire without losses is on its way: a driver can keep it longer than what was sent after it.
        while m[message + MISSING] and m[flow + SENT_AGAIN_ON]:
            code = _send_again(m, flow, message)
            if code:
                return code
        while m[flow + HELD_FIRST] and has_room(m, flow, parts_of(m, m[flow + HELD_FIRST])):
            first = m[flow + HELD_FIRST]
            following = m[first + NEXT_MESSAGE]
            code = send_first(m, flow, first, 0)
            if code:
                return code
            m[flow + HELD_FIRST] = following
    free_message(m, message)
    return CONTINUE


def _send_again(m: Memory, flow: int, acknowledgement: int) -> int:
    """Send the message again that has the first missing part."""
    part, bits = m[acknowledgement + UP_TO], m[acknowledgement + MISSING]
    while bits & 1 == 0:
        bits >>= 1
        part += 1
    message = with_part(m, flow, part)
    if message == 0 or m[message + FIRST_PART] > part:
        m[acknowledgement + MISSING] &= ~(1 << (part - m[acknowledgement + UP_TO]))
        return CONTINUE
    line = m[flow + SENT_AGAIN_ON]
    if m[FREE_MESSAGES] == 0:
        return NO_MESSAGES
    code = lacks_delay(m, line)
    if code:
        return code
    m[m[message + SENT_AS] + SENT_AGAIN] += 1
    delay(m, line, copy_of(m, message))
    known_to = end_of(m, message) - m[acknowledgement + UP_TO]
    m[acknowledgement + MISSING] = m[acknowledgement + MISSING] >> known_to << known_to if known_to < 62 else 0
    return CONTINUE


def ask(m: Memory, alarm: int, flow: int) -> int:
    """It is time to ask for missing acknowledgements, if there are any."""
    if m[flow + UNACKNOWLEDGED] < m[flow + NEXT_PART]:
        if m[FREE_MESSAGES] == 0:
            return NO_MESSAGES
        message = new_message(m, m[flow + ASKS_AS])
        fill_heartbeat(m, message, flow)
        code = enter_wire(m, message, 0)
        if code:
            free_message(m, message)
            return code
    m[alarm + ALARM_AT] += m[flow + ASKS_AFTER]
    return CONTINUE
