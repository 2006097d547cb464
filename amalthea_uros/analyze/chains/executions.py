"""What a core executes in an interval of its schedule, which is extended as far as the interval reaches."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.chains.core_schedule import CoreSchedule
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


@dataclass(frozen=True, slots=True, kw_only=True)
class Execution:
    """A part of a job that a core executes without interruption.

    Attributes
    ----------
    job : its number, counted from 1 at the start of the system
    """

    core: str
    process: str
    job: int
    begin: Time
    end: Time


def executions(core: str, schedule: CoreSchedule, begin: Time, end: Time) -> list[Execution]:
    """What a core executes from one time to another one in the worst case, in order; in the time base of the core."""
    # In the steady state, each cycle is like the one that is covered last.
    skipped = max(0, (begin - schedule.steady_state_start) // schedule.cycle)
    shift = skipped * schedule.cycle
    found = [
        Execution(
            core=core,
            process=name,
            job=job + 1 + skipped * (schedule.cycle // schedule.tasks[name].period),
            begin=max(first + shift, begin),
            end=min(last + shift, end),
        )
        for name in schedule.tasks
        for job, first, last in _slices(schedule, name, begin - shift, end - shift)
    ]
    return sorted(found, key=lambda each: (each.begin, each.process))


def _slices(schedule: CoreSchedule, name: str, begin: Time, end: Time) -> Iterator[tuple[int, Time, Time]]:
    """The execution slices of a task in an interval, each with the number of its job counted from 0."""
    jobs, per_cycle = schedule.worst[name], schedule.cycle // schedule.tasks[name].period
    slices = jobs.execution_slices
    repeated = slices[slices[:, 0] >= len(jobs.releases) - per_cycle]
    rounds = max(0, -(-(end - schedule.until) // schedule.cycle))
    further: list[Numbers] = [
        repeated + np.array((per_cycle, schedule.cycle, schedule.cycle)) * number for number in range(1, rounds + 1)
    ]
    every = np.concatenate((slices, *further))
    inside = np.minimum(every[:, 2], end) > np.maximum(every[:, 1], begin)
    yield from every[inside].tolist()
