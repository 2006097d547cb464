"""The times of jobs, by the same names wherever they are computed, simulated or limited."""

from __future__ import annotations

from enum import StrEnum


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
