"""The time base of a core: the parts of a picosecond in which execution demand on it is counted, and the limits of times.

A tick of a clock is often not a whole number of picoseconds; demand is a whole number of parts. mypy refuses a time where a demand
is meant, and only the functions here convert one into the other.
"""

from __future__ import annotations

from typing import NewType

from amalthea_uros.units import Time

#: Execution demand on a core, in parts of a picosecond: its time base.
Ticks = NewType("Ticks", int)

#: Longer times are treated as unbounded: 13 days in picoseconds.
LIMIT: Time = 2**60
#: Sums of some such times still fit into 64 bits.
MAX_INPUT: Time = LIMIT // 64


def to_ticks(time: Time, time_base: int) -> Ticks:
    """What a core executes in a time."""
    return Ticks(time * time_base)


def max_time(demand: Ticks, time_base: int) -> Time:
    """How long a demand takes, rounded up to whole picoseconds: an upper bound stays one."""
    return -(-demand // time_base)


def min_time(demand: Ticks, time_base: int) -> Time:
    """How long a demand takes, rounded down to whole picoseconds: a lower bound stays one."""
    return demand // time_base
