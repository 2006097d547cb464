"""The times of jobs that have ended, from when they were activated, started and ended, and how long they were in which state.

AMALTHEA defines most of them by the states of the BTF state chart; its net execution time includes waiting and polling, and leaves out
only the time in which other processes execute instead (READY, PARKING). The preemption time is the initial pending time and the time in
READY: while the job does not execute because others do.

Consecutive jobs of a process are those that end one after the other. Activations that are lost are no jobs: the time between two
activations is that between two jobs.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.timing.basics.quantities import JobMetric

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Numbers = NDArray[np.int64]


class JobColumn(IntEnum):
    """The columns of a row about a job that has ended, or an execution of a runnable: their numbers follow those of the processes.

    `ACTIVATION`, `START` and `END` are points in time. `RUNNING`, `WAITING`, `POLLING` and `PARKING` are the time in these states
    (BTF state chart); the rest between start and end is the time in the state READY.
    """

    PROCESS = 0
    INSTANCE = 1
    ACTIVATION = 2
    START = 3
    END = 4
    RUNNING = 5
    WAITING = 6
    POLLING = 7
    PARKING = 8
    PREEMPTIONS = 9
    MIGRATIONS = 10


#: What each job has, in the order of the rows of `own_times`.
OWN = (
    JobMetric.NET_EXECUTION_TIME,
    JobMetric.GROSS_EXECUTION_TIME,
    JobMetric.RESPONSE_TIME,
    JobMetric.INITIAL_PENDING_TIME,
    JobMetric.READY_TIME,
    JobMetric.PREEMPTION_TIME,
    JobMetric.RUNNING_TIME,
    JobMetric.WAITING_TIME,
    JobMetric.POLLING_TIME,
    JobMetric.PARKING_TIME,
)
#: What lies between two consecutive jobs, in the order of the rows of `times_between`.
BETWEEN = (JobMetric.ACTIVATE_TO_ACTIVATE, JobMetric.START_TO_START, JobMetric.END_TO_END, JobMetric.END_TO_START)


def own_times(jobs: Numbers) -> Numbers:
    """The times of each job: a row for each of `OWN`.

    Parameters
    ----------
    jobs : a column for each job, a row for each of `JobColumn`
    """
    found = np.empty((len(OWN), jobs.shape[1]), np.int64)
    net, gross, response, pending, ready, preemption, running, waiting, polling, parking = found
    running[:], waiting[:], polling[:], parking[:] = (
        jobs[column] for column in (JobColumn.RUNNING, JobColumn.WAITING, JobColumn.POLLING, JobColumn.PARKING)
    )
    np.subtract(jobs[JobColumn.END], jobs[JobColumn.START], out=gross)
    np.subtract(jobs[JobColumn.END], jobs[JobColumn.ACTIVATION], out=response)
    np.subtract(jobs[JobColumn.START], jobs[JobColumn.ACTIVATION], out=pending)
    np.add(running, waiting, out=net)
    net += polling
    np.subtract(gross, net, out=ready)
    ready -= parking
    np.add(pending, ready, out=preemption)
    return found


def times_between(earlier: Numbers, later: Numbers) -> Numbers:
    """The times between jobs and those after them: a row for each of `BETWEEN`.

    Parameters
    ----------
    earlier, later : as for `own_times`
    """
    found = np.empty((len(BETWEEN), later.shape[1]), np.int64)
    ends = (
        (JobColumn.ACTIVATION, JobColumn.ACTIVATION),
        (JobColumn.START, JobColumn.START),
        (JobColumn.END, JobColumn.END),
        (JobColumn.END, JobColumn.START),
    )
    for row, (begin, end) in zip(found, ends, strict=True):
        np.subtract(later[end], earlier[begin], out=row)
    return found
