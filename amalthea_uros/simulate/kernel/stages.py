"""The effect of a chain's stimulus, followed from job to job; values are numbers of occurrences of the stimulus."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.reports import emit

_CHAIN_STEP = 70
_STIMULUS, _RESPONSE = 0, 1


def follow(m: Memory, process: int, operation: int, stage: int, argument: int) -> None:
    """Carry out an operation of a stage."""
    if operation == ENTER:
        m[stage + REACHED] = 0
        m[stage + IS_MARKED] = 0
        m[stage + HAS_RESPONDED] = 0
        if m[stage + CAPTURE] >= 0:
            m[stage + TAKEN] = m[m[process + FIRST_PLACE] + QUEUE_CAPTURES + m[stage + CAPTURE]]
        elif m[stage + BEFORE_STAGE]:
            m[stage + TAKEN] = m[m[stage + BEFORE_STAGE] + LINK]
        if argument:
            m[stage + VALUE] = m[stage + TAKEN]
    elif operation == TAKE:
        m[stage + VALUE] = m[stage + TAKEN] if argument else m[m[stage + BEFORE_STAGE] + LINK]
    elif operation == REACH:
        m[stage + REACHED] |= argument
        _complete(m, process, stage)
    elif operation == MARK:
        m[stage + IS_MARKED] = 1
        sent_at = m[m[process + ITS_MESSAGE] + BORN] if argument == 2 else m[NOW]
        m[stage + MARKED_AT] = m[process + ACTIVATION] if argument == 1 else sent_at
        _complete(m, process, stage)
    elif operation == RESPOND:
        m[stage + HAS_RESPONDED] = 1
        m[stage + RESPONDED_AT] = m[process + argument] if argument else m[NOW]
        _complete(m, process, stage)
    elif operation == PUT or m[stage + REACHED] == m[stage + NEEDED]:
        _leave(m, process, operation, stage)


def _leave(m: Memory, process: int, operation: int, stage: int) -> None:
    value = m[stage + VALUE]
    _trace(m, process, stage)
    if operation != PUBLISH:
        m[stage + LINK] = value
    elif m[process + PENDING] > 1:
        # The next job has been released before this one ends: what it writes is late.
        _give(m, stage, value)
    else:
        m[stage + OUT] = value
        m[stage + IS_OUT] = 1


def _trace(m: Memory, process: int, stage: int) -> None:
    if m[IS_TRACED] and m[stage + VALUE] >= 0:
        chain, step = m[stage + CHAIN_ENTITY], m[stage + STEP]
        emit(m, _CHAIN_STEP, m[process + ENTITY], m[process + INSTANCE], chain, m[stage + VALUE], step)


def _complete(m: Memory, process: int, stage: int) -> None:
    """Stimulus and response of a chain count in jobs that take part in it, when they have reached all positions.

    The response can be an event before the last of them, such as the start of the runnable that reads.
    """
    if m[stage + REACHED] != m[stage + NEEDED]:
        return
    if m[stage + IS_MARKED]:
        route = m[stage + ROUTE]
        m[stage + IS_MARKED] = 0
        m[stage + VALUE] = m[route + STAMPS]
        m[route + STAMPS] += 1
        _observe(m, stage, _STIMULUS, m[stage + MARKED_AT], m[stage + VALUE])
    if m[stage + HAS_RESPONDED]:
        m[stage + HAS_RESPONDED] = 0
        _trace(m, process, stage)
        _observe(m, stage, _RESPONSE, m[stage + RESPONDED_AT], m[stage + VALUE])


def observe_response(m: Memory, stage: int, time: int, value: int) -> None:
    """Report a response of a chain that occurs after the job of its last stage."""
    _observe(m, stage, _RESPONSE, time, value)


def _observe(m: Memory, stage: int, kind: int, time: int, value: int) -> None:
    """Report a stimulus or a response of a chain."""
    row = m[OBSERVATIONS]
    m[row] = m[m[stage + ROUTE] + ROUTE_NUMBER]
    m[row + 1] = kind
    m[row + 2] = time
    m[row + 3] = value
    m[OBSERVATIONS] = row + OBSERVATION_SIZE


def publish(m: Memory, process: int) -> None:
    """What the last job has written under LET is there from the end of its period on."""
    for place in range(m[process + LET_STAGES], m[process + LET_STAGES_END]):
        stage = m[place]
        if m[stage + IS_OUT]:
            m[stage + IS_OUT] = 0
            _give(m, stage, m[stage + OUT])


def _give(m: Memory, stage: int, value: int) -> None:
    """A value gets to the next stage, or is the response."""
    if m[stage + IS_LAST]:
        _observe(m, stage, _RESPONSE, m[NOW], value)
    else:
        m[stage + LINK] = value
