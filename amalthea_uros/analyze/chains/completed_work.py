"""When a job has come how far."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.response_times.schedule import Jobs

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


def behind(jobs: Jobs, executed: Numbers) -> Numbers:
    """When each job has executed so much."""
    ends, target = _targets(jobs, executed)
    at = np.searchsorted(ends, target, side="left")
    found: Numbers = jobs.execution_slices[at, 2] - (ends[at] - target)
    return np.where(executed > 0, found, jobs.begins)


def before(jobs: Jobs, executed: Numbers) -> Numbers:
    """When each job goes on behind having executed so much; its end, where nothing comes behind."""
    ends, target = _targets(jobs, executed)
    at = np.minimum(np.searchsorted(ends, target, side="right"), len(ends) - 1)
    found: Numbers = jobs.execution_slices[at, 2] - (ends[at] - target)
    return np.where(jobs.execution_slices[at, 0] == np.arange(len(executed)), found, jobs.ends)


def _targets(jobs: Jobs, executed: Numbers) -> tuple[Numbers, Numbers]:
    """How much the task has executed at the ends of its pieces, and when each job has executed so much."""
    ends: Numbers = np.cumsum(jobs.execution_slices[:, 2] - jobs.execution_slices[:, 1])
    last_pieces = np.searchsorted(jobs.execution_slices[:, 0], np.arange(len(executed)), side="right") - 1
    done = np.concatenate(([0], ends[last_pieces[:-1]]))
    return ends, done + executed
