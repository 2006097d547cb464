"""The records of messages: a list of those that are free, and lists of those that wait somewhere.

A reliable message stays where it is until it is acknowledged; what is sent, and received, are copies.
"""

from __future__ import annotations

from amalthea_uros.simulate.kernel.layout import *

#: Bits of a word that stand for parts of a message.
MOST_PARTS = 60


def new_message(m: Memory, transmission: int) -> int:
    """A record for a message that carries nothing yet; there must be a free one."""
    message = m[FREE_MESSAGES]
    m[FREE_MESSAGES] = m[message + NEXT_MESSAGE]
    for place in range(message, message + CARRIED):
        m[place] = 0
    m[message + BORN] = m[NOW]
    m[message + SENT_AS] = transmission
    m[message + PARTS_IN_IT] = 1
    for place in range(message + CARRIED, message + CARRIED + m[CARRIED_VALUES]):
        m[place] = -1
    return message


def copy_of(m: Memory, original: int) -> int:
    """A copy of a reliable message, with all of its parts; there must be a free record."""
    copy = new_message(m, m[original + SENT_AS])
    m[original + USES] += 1
    m[copy + ORIGINAL] = original
    m[copy + BORN] = m[original + BORN]
    m[copy + FIRST_PART] = m[original + FIRST_PART]
    m[copy + PARTS_IN_IT] = (1 << min(parts_of(m, original), MOST_PARTS)) - 1
    carry(m, original, copy)
    return copy


def carry(m: Memory, message: int, other: int) -> None:
    """Have a message carry what another one does."""
    for index in range(CARRIED, CARRIED + m[CARRIED_VALUES]):
        m[other + index] = m[message + index]


def parts_of(m: Memory, message: int) -> int:
    """The number of parts of a message."""
    return m[m[message + SENT_AS] + PARTS_OF]


def free_message(m: Memory, message: int) -> None:
    """A message is gone; so is the one of which it is the last copy, if it is acknowledged."""
    original = m[message + ORIGINAL]
    _put_back(m, message)
    if original:
        stop_using(m, original)


def stop_using(m: Memory, message: int) -> None:
    """A reliable message is in one list less, or has one copy less."""
    m[message + USES] -= 1
    if m[message + USES] == 0:
        _put_back(m, message)


def _put_back(m: Memory, message: int) -> None:
    m[message + NEXT_MESSAGE] = m[FREE_MESSAGES]
    m[FREE_MESSAGES] = message


def keep(m: Memory, inbox: int, handle: int, message: int) -> None:
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
