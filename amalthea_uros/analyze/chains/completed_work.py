"""The times at which jobs have executed a given part of their demand."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.response_times.schedule import Jobs

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


def times_of_completion(jobs: Jobs, executed: Numbers) -> Numbers:
    """When each job has executed the given demand."""
    ends, target = _targets(jobs, executed)
    at = np.searchsorted(ends, target, side="left")
    found: Numbers = jobs.execution_slices[at, 2] - (ends[at] - target)
    return np.where(executed > 0, found, jobs.begins)


def times_of_continuation(jobs: Jobs, executed: Numbers) -> Numbers:
    """When each job continues after the given demand; its end if it executes no more than that."""
    ends, target = _targets(jobs, executed)
    at = np.minimum(np.searchsorted(ends, target, side="right"), len(ends) - 1)
    found: Numbers = jobs.execution_slices[at, 2] - (ends[at] - target)
    return np.where(jobs.execution_slices[at, 0] == np.arange(len(executed)), found, jobs.ends)


def _targets(jobs: Jobs, executed: Numbers) -> tuple[Numbers, Numbers]:
    """The work that the task has completed at the end of each slice, and when each job has executed the given demand."""
    ends: Numbers = np.cumsum(jobs.execution_slices[:, 2] - jobs.execution_slices[:, 1])
    last_slices = np.searchsorted(jobs.execution_slices[:, 0], np.arange(len(executed)), side="right") - 1
    done = np.concatenate(([0], ends[last_slices[:-1]]))
    return ends, done + executed
