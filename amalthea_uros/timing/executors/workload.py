"""The work that the rounds of an executor with a sleep D demand of its core, as rounds of the longest execution time C.

A round begins D after the end of the one before. Of k rounds that begin in a window of length w, all but the last one, and the k - 1
sleeps between them, are inside it, so that they demand at most C + min((k - 1) C, w - (k - 1) D), whatever the single rounds take.
With w = q (C + D) + r that is at most (q + 1) C if r <= D, and (q + 2) C otherwise, which is what ceil((w + C) / (C + D)) rounds of C
demand: a period of C + D with a jitter of C. Shorter rounds can be more frequent; so this says nothing of what a round activates.
"""

from __future__ import annotations

from amalthea_uros.perf.executors import Executor
from amalthea_uros.timing.event_models import EventModel, Sporadic
from amalthea_uros.timing.executors.loops import least_sleep
from amalthea_uros.units import Time


def workload(executor: Executor, events: EventModel, longest: Time) -> EventModel:
    """The event model of rounds that demand the longest execution time each; that of the stimulus if there is no sleep.

    Parameters
    ----------
    longest : greatest execution time of a round
    """
    sleep = least_sleep(executor)
    return Sporadic(sleep + longest, longest, sleep) if sleep else events
