"""Wires, and delay lines before and after them, which keep the order of messages."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.activation import fire
from amalthea_uros.simulate.kernel.flows import fill_acknowledgement
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.message_records import append, new_message


def bring(m: Memory, line: int, about: int) -> int:
    """A message begins its way on a line; it acknowledges what has arrived of a flow, or nothing (0)."""
    if m[FREE_MESSAGES] == 0:
        return NO_MESSAGES
    code = lacks_delay(m, line)
    if code == 0:
        message = new_message(m, m[line + CREATES])
        if about:
            fill_acknowledgement(m, message, about)
        delay(m, line, message)
    return code


def lacks_delay(m: Memory, line: int) -> int:
    """Why a line cannot take a message now."""
    return lacks_value(m, m[line + DELAY])


def lacks_value(m: Memory, stream: int) -> int:
    """Why nothing can be drawn from a stream now."""
    if m[stream + STREAM_AT] == m[stream + STREAM_END]:
        m[CAUSE] = stream
        return STREAM_EMPTY
    return CONTINUE


def draw_delay(m: Memory, stream: int) -> int:
    """The next delay of a stream."""
    value = m[m[stream + STREAM_AT]]
    m[stream + STREAM_AT] += 1
    return value


def reach_host(m: Memory, transmission: int) -> int:
    """When the host gets a message that is at the end of the wire now: in their order."""
    m[transmission + LAST_AT_HOST] = max(m[transmission + LAST_AT_HOST], m[NOW] + draw_delay(m, m[transmission + TO_HOST]))
    return m[transmission + LAST_AT_HOST]


def delay(m: Memory, line: int, message: int) -> None:
    """Put a message on a line now, with the next delay of the line."""
    delay_from(m, line, message, m[NOW], m[line + DELAY])


def delay_from(m: Memory, line: int, message: int, since: int, stream: int) -> None:
    """Put a message on a line, on which none overtakes another one, with a delay of a stream that begins at some time."""
    due = since + draw_delay(m, stream)
    alarm = m[line + ITS_ALARM]
    if m[line + FIRST_MESSAGE]:
        due = max(due, m[m[line + LAST_MESSAGE] + DUE])
    else:
        m[alarm + ALARM_AT] = due
    m[message + DUE] = due
    append(m, line + FIRST_MESSAGE, message)


def enter_wire(m: Memory, message: int, origin: int) -> int:
    """A message is queued on its wire; `origin` is the process that has written it, 0 if it comes from outside."""
    transmission = m[message + SENT_AS]
    for place in range(m[transmission + STAMPS_TO], m[transmission + STAMPS_TO_END], 2):
        m[m[place]] = m[message + CARRIED + m[place + 1]]
    m[MESSAGE] = message
    return fire(m, m[transmission + WIRE_STIMULUS], origin)


def keep_values(m: Memory, message: int, transmission: int) -> None:
    """A reliable message keeps the values of chains that it has on the wire."""
    original = m[message + ORIGINAL]
    m[original + HAS_BEEN_SENT] = 1
    for place in range(m[transmission + KEEPS], m[transmission + KEEPS_END], 2):
        m[original + CARRIED + m[place + 1]] = m[m[place] + VALUE]


def restore_values(m: Memory, message: int, transmission: int) -> bool:
    """Whether a message has been on the wire before; then the values of chains are those of then."""
    original = m[message + ORIGINAL]
    if not m[original + HAS_BEEN_SENT]:
        return False
    for place in range(m[transmission + KEEPS], m[transmission + KEEPS_END], 2):
        stage = m[place]
        m[stage + VALUE] = m[original + CARRIED + m[place + 1]]
        m[stage + REACHED] = m[stage + NEEDED]
        m[stage + IS_MARKED] = 0
        m[stage + HAS_RESPONDED] = 0
    return True
