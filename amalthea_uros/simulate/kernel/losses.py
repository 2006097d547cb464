"""Messages that are lost on wires, as stated: a number in a time, or each with a probability."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.reports import NO_NOTE, emit

#: One of so many messages is lost that follow each other when it is time: what comes after a silence would be lost too often.
MOST_PASSING = 8
#: The kind of event, as in `trace.table.EventKind`.
_TRIGGER = 30


def lacks_loss_value(m: Memory, transmission: int) -> int:
    """Why it cannot be decided now whether a message is lost."""
    for place in range(m[transmission + LOSES], m[transmission + LOSES_END]):
        stream = m[m[place] + LOSS_VALUES]
        if m[stream + STREAM_AT] == m[stream + STREAM_END]:
            m[CAUSE] = stream
            return STREAM_EMPTY
    return CONTINUE


def is_lost(m: Memory, process: int, transmission: int) -> bool:
    """Decide whether a message, or a part of it, is lost when it leaves the wire."""
    for place in range(m[transmission + LOSES], m[transmission + LOSES_END]):
        losses = m[place]
        if _loses(m, losses):
            m[transmission + LOST_ON_WIRE] += 1
            if m[IS_TRACED]:
                instance, occurrence = m[process + INSTANCE], m[losses + LOSS_NUMBER]
                emit(m, _TRIGGER, m[process + ENTITY], instance, m[losses + LOSS_ENTITY], occurrence, NO_NOTE)
            m[losses + LOSS_NUMBER] += 1
            return True
    return False


def _loses(m: Memory, losses: int) -> bool:
    if m[losses + LOSS_WINDOW] == 0:
        return _value(m, losses) != 0
    oldest = m[losses + LOSS_TIMES] + m[losses + LOSS_INDEX]
    if m[NOW] < m[losses + NEXT_LOSS] or m[NOW] < m[oldest] + m[losses + LOSS_WINDOW]:
        return False
    if m[losses + PASSING]:
        m[losses + PASSING] -= 1
        return False
    m[oldest] = m[NOW]
    m[losses + LOSS_INDEX] = (m[losses + LOSS_INDEX] + 1) % m[losses + LOSS_COUNT]
    value = _value(m, losses)
    m[losses + NEXT_LOSS] = m[NOW] + value // MOST_PASSING
    m[losses + PASSING] = value % MOST_PASSING
    return True


def _value(m: Memory, losses: int) -> int:
    stream = m[losses + LOSS_VALUES]
    value = m[m[stream + STREAM_AT]]
    m[stream + STREAM_AT] += 1
    return value
