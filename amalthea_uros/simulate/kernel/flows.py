"""Flows: what sender and receiver know of the reliable messages of a session in one direction.

Each part of a message has a number. The receiver hands over in this order, and acknowledges what it has up to the first part that is
missing; from there on it says which parts are missing (eProsima/Micro-XRCE-DDS-Client, `input_reliable_stream.c` and
`output_reliable_stream.c`; the same in the agent).
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.message_records import append, parts_of, pop, stop_using

#: Bits of an acknowledgement (ACKNACK).
_BITMAP = 16


def has_room(m: Memory, flow: int, parts: int) -> bool:
    """Whether a sender can send some more parts; if all is acknowledged, any number: full buffers are emptied in between."""
    unacknowledged = m[flow + NEXT_PART] - m[flow + UNACKNOWLEDGED]
    return unacknowledged == 0 or unacknowledged + parts <= m[flow + SEND_ROOM]


def number(m: Memory, flow: int, message: int) -> None:
    """Keep a message until it is acknowledged; its number is that of its first part."""
    m[flow + NEXT_PART] += parts_of(m, message)
    append(m, flow + SENT_FIRST, message)


def acknowledged(m: Memory, flow: int, up_to: int) -> None:
    """The parts up to a number are acknowledged: messages of which all are need not be kept."""
    m[flow + UNACKNOWLEDGED] = max(m[flow + UNACKNOWLEDGED], up_to)
    while m[flow + SENT_FIRST] and end_of(m, m[flow + SENT_FIRST]) <= m[flow + UNACKNOWLEDGED]:
        stop_using(m, pop(m, flow + SENT_FIRST))


def end_of(m: Memory, message: int) -> int:
    """The number after the last part of a message."""
    return m[message + FIRST_PART] + parts_of(m, message)


def with_part(m: Memory, flow: int, part: int) -> int:
    """The message that is kept with a part, or the first one after it; 0 if there is none."""
    message = m[flow + SENT_FIRST]
    while message and end_of(m, message) <= part:
        message = m[message + NEXT_MESSAGE]
    return message


def accept(m: Memory, flow: int, part: int) -> None:
    """A part has arrived; it is dropped if it is there already, or if there is no room for it."""
    ahead = part - m[flow + EXPECTED]
    m[flow + KNOWN_TO] = max(m[flow + KNOWN_TO], part + 1)
    if 0 <= ahead < m[flow + RECEIVE_ROOM]:
        m[flow + ARRIVED_PARTS] |= 1 << ahead
        while m[flow + ARRIVED_PARTS] & 1:
            m[flow + ARRIVED_PARTS] >>= 1
            m[flow + EXPECTED] += 1


def announce(m: Memory, flow: int, up_to: int) -> None:
    """The other side has sent the parts up to a number."""
    m[flow + KNOWN_TO] = max(m[flow + KNOWN_TO], up_to)


def is_to_hand_over(m: Memory, flow: int, message: int) -> bool:
    """Whether all of a message, and everything before it, has arrived."""
    return message != 0 and end_of(m, message) <= m[flow + EXPECTED]


def fill_acknowledgement(m: Memory, message: int, flow: int) -> None:
    """Have a message acknowledge what has arrived up to now."""
    known = min(m[flow + KNOWN_TO] - m[flow + EXPECTED], _BITMAP)
    m[message + ABOUT] = flow
    m[message + UP_TO] = m[flow + EXPECTED]
    m[message + MISSING] = ((1 << known) - 1) & ~m[flow + ARRIVED_PARTS] if known > 0 else 0


def fill_heartbeat(m: Memory, message: int, flow: int) -> None:
    """Have a message ask for the acknowledgement of everything that was sent."""
    m[message + ABOUT] = flow
    m[message + ANNOUNCED_TO] = m[flow + NEXT_PART]
