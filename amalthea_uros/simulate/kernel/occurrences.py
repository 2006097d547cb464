"""Occurrences without a job at an instant: stimuli that come from outside, and alarms."""

from __future__ import annotations

from amalthea_uros.simulate.kernel.activation import fire, publish_all
from amalthea_uros.simulate.kernel.layout import *
from amalthea_uros.simulate.kernel.messages import ring
from amalthea_uros.simulate.kernel.wires import bring


def occur(m: Memory) -> int:
    """Everything occurs whose time has come."""
    if m[ARRIVAL] < m[ARRIVALS_END] and m[m[ARRIVAL]] == m[NOW]:
        code = _arrive(m)
        if code:
            return code
    return _ring_all(m)


def _arrive(m: Memory) -> int:
    """The stimuli occur that come from outside at this instant."""
    now, place, end = m[NOW], m[ARRIVAL], m[ARRIVALS_END]
    while place < end and m[place] == now:
        publish_all(m, m[place + 1])
        place += ARRIVAL_SIZE
    while m[ARRIVAL] < place:
        # While a job executes for long, others can be activated any number of times.
        if m[EVENTS] >= m[EVENTS_END]:
            return ROWS_FULL
        stimulus = m[m[ARRIVAL] + 1]
        code = bring(m, m[stimulus + BRINGS], 0) if m[stimulus + BRINGS] else fire(m, stimulus, 0)
        if code:
            return code
        m[ARRIVAL] += ARRIVAL_SIZE
    return 0


def _ring_all(m: Memory) -> int:
    """Carry out all alarms whose time has come."""
    for place in range(m[ALARMS], m[ALARMS_END]):
        while m[m[place] + ALARM_AT] <= m[NOW]:
            if m[EVENTS] >= m[EVENTS_END]:
                return ROWS_FULL
            code = ring(m, m[place])
            if code:
                return code
    return 0
