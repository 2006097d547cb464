"""The quantities of jobs and chains, by the same names wherever they are computed, simulated, measured or limited.

Jitter has several definitions in the field, so that each result names its own. Of a time that every job has, such as the response
time, and of a latency, it is the maximum minus the minimum (peak to peak). Of a time from one job to the next, it is the largest
deviation from the nominal period (AUTOSAR Specification of Timing Extensions R21-11, glossary: jitter).
"""

from __future__ import annotations

from enum import StrEnum
from fractions import Fraction
from typing import TypeVar

from amalthea_uros.perf.constraints import TimeMetric
from amalthea_uros.units import Time


class JobMetric(StrEnum):
    """A time that every job has, or that lies between every two consecutive jobs.

    The names are those of AMALTHEA, and for what it has no name, those of the field's simulators.
    """

    NET_EXECUTION_TIME = "net_execution_time"
    GROSS_EXECUTION_TIME = "gross_execution_time"
    RESPONSE_TIME = "response_time"
    INITIAL_PENDING_TIME = "initial_pending_time"
    READY_TIME = "ready_time"
    PREEMPTION_TIME = "preemption_time"
    RUNNING_TIME = "running_time"
    WAITING_TIME = "waiting_time"
    POLLING_TIME = "polling_time"
    PARKING_TIME = "parking_time"
    ACTIVATE_TO_ACTIVATE = "activate_to_activate"
    START_TO_START = "start_to_start"
    END_TO_END = "end_to_end"
    END_TO_START = "end_to_start"
    SLACK_TIME = "slack_time"
    LATENESS = "lateness"


class ChainQuantity(StrEnum):
    """An end-to-end latency of a chain, as observed at each stimulus or at each response; docs/chains.md defines them."""

    REACTION_TIME = "reaction_time"
    REDUCED_REACTION_TIME = "reduced_reaction_time"
    DATA_AGE = "data_age"
    REDUCED_DATA_AGE = "reduced_data_age"
    FIRST_TO_FIRST = "first_to_first"
    FIRST_TO_LAST = "first_to_last"
    LAST_TO_FIRST = "last_to_first"
    LAST_TO_LAST = "last_to_last"


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
