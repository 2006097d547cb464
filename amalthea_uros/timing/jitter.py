"""Jitter: how much a time of the jobs of a process, or of the latencies of a chain, varies.

The field has several definitions, so that each result names its own. Of a time that every job has, such as the response time, and of a
latency, it is the maximum minus the minimum (peak to peak). Of a time from one job to the next, it is the largest deviation from the
nominal period (AUTOSAR Specification of Timing Extensions R21-11, glossary: jitter).
"""

from __future__ import annotations

from fractions import Fraction
from typing import TypeVar

from amalthea_uros.perf.constraints import TimeMetric
from amalthea_uros.units import Time

Number = TypeVar("Number", int, Fraction)

#: From one job to the next one, for which a period is nominal.
_FROM_JOB_TO_JOB = (TimeMetric.ACTIVATE_TO_ACTIVATE, TimeMetric.START_TO_START, TimeMetric.END_TO_END)


def is_deviation_from_period(metric: TimeMetric) -> bool:
    """Whether the jitter of a time is its deviation from the nominal period, instead of maximum minus minimum."""
    return metric in _FROM_JOB_TO_JOB


def jitter_name(of: str) -> str:
    """How the jitter of a time or latency is named in results."""
    return f"{of} jitter"


def jitter_of(minimum: Number, maximum: Number, period: Time | None = None) -> Number:
    """The jitter of values by the least and the greatest of them.

    Parameters
    ----------
    period : the nominal one, for a jitter that is the deviation from it
    """
    return maximum - minimum if period is None else max(maximum - period, period - minimum)
