"""The records of messages: a list of those that are free, and lists of those that wait somewhere."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.layout import *


def new_message(m: Memory, transmission: int) -> int:
    """A record for a message that carries nothing yet; there must be a free one."""
    message = m[FREE_MESSAGES]
    m[FREE_MESSAGES] = m[message + NEXT_MESSAGE]
    m[message + NEXT_MESSAGE] = 0
    m[message + BORN] = m[NOW]
    m[message + SENT_AS] = transmission
    m[message + ACKNOWLEDGES] = 0
    for place in range(message + CARRIED, message + CARRIED + m[CARRIED_VALUES]):
        m[place] = -1
    return message


def free_message(m: Memory, message: int) -> None:
    """A message is gone."""
    m[message + NEXT_MESSAGE] = m[FREE_MESSAGES]
    m[FREE_MESSAGES] = message


def append(m: Memory, first: int, message: int) -> None:
    """Put a message at the end of a list; the places of its first and its last message follow each other."""
    m[message + NEXT_MESSAGE] = 0
    if m[first]:
        m[m[first + 1] + NEXT_MESSAGE] = message
    else:
        m[first] = message
    m[first + 1] = message


def pop(m: Memory, first: int) -> int:
    """Take the first message out of a list, which must have one."""
    message = m[first]
    m[first] = m[message + NEXT_MESSAGE]
    return message
