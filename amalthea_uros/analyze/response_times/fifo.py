"""Response times of tasks of equal priority under FIFO, which is EDF with equal deadlines."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.analyze.response_times import edf
from amalthea_uros.analyze.response_times.busy_window import Interference
from amalthea_uros.analyze.response_times.task import Task
from amalthea_uros.analyze.results import Response
from amalthea_uros.units import Time

METHOD = "busy window, fixed priorities, first come first served within one"


def response_time(task: Task, others: Sequence[Task], higher: Interference, blocking: Time = 0) -> Response:
    """The response time of a task among others of its priority; see `edf.response_time`."""
    return edf.response_time(task, others, higher, blocking, METHOD)
