"""Timers: the grid is kept, and periods that have passed when a call begins are lost.

A timer is due at its first expiration and whole periods later. Whether it is due is checked once in a round, after the wait. A call
sets the next expiration one period on, and if that has passed, to the next one on the grid (ros2/rcl, rcl/src/rcl/timer.c,
`rcl_timer_call`): there is no burst of calls afterwards.
"""

from __future__ import annotations

from amalthea_uros.units import Time


def lost_periods(lateness: Time, period: Time) -> int:
    """How many expirations are lost when a call begins so long after the one that it is for."""
    return lateness // period if period else 0


def next_expiration(due: Time, called: Time, period: Time) -> Time:
    """The expiration after a call: on the grid, and after the call."""
    return due + (lost_periods(called - due, period) + 1) * period
