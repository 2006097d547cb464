"""The times at which the jobs of a stage reach its boundaries, in a schedule."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.chains import completed_work
from amalthea_uros.analyze.chains.completed_work import Busy
from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.schedule import Jobs
from amalthea_uros.perf.activities import Communication, Execute, ExecutionNeed
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.events import JobPhase
from amalthea_uros.timing.dataflow.stages import At, Boundary, Fire, Pass, Read, Stage, Write
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.jobs.positions import ActivityPosition
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


@dataclass(frozen=True, slots=True)
class BoundaryTimes:
    """The earliest or the latest times at which the jobs of a stage reach its boundaries.

    Attributes
    ----------
    jobs : in the schedule of all best cases for the earliest times, of all worst cases for the latest ones
    demand_of : best-case or worst-case demand of the n-th job, counted from 1
    busy_above : when tasks of higher priority have the core, for the latest times; None for the earliest ones
    """

    context: TimingContext
    stage: Stage
    jobs: Jobs
    period: Time
    demand_of: Callable[[MultiframeDemand, int], Time]
    busy_above: Busy | None = None

    def at(self, boundary: Boundary) -> Numbers:
        """When each job reaches a boundary."""
        jobs = self.jobs
        match kind(boundary):
            case JobPhase.ACTIVATION:
                return jobs.releases
            case JobPhase.START:
                return jobs.begins
            case JobPhase.END:
                return jobs.ends
            case None:
                return jobs.releases + self.period
        return self._inside(boundary)

    def _inside(self, boundary: Boundary) -> Numbers:
        jobs, position = self.jobs, position_of(boundary)
        assert position is not None
        if not position.is_certain:
            return jobs.begins if self.busy_above is None else self.busy_above.resumption(jobs.ends)
        executed = self._executed(position, including=kind(boundary) is JobPhase.AFTER)
        completions = completed_work.times_of_completion(jobs, executed)
        if self.busy_above is None or (kind(boundary) is JobPhase.AFTER and self._ends_with_execution(position)):
            return completions
        # A job that has not executed anything has just got the core.
        return np.where(executed > 0, self.busy_above.resumption(completions), completions)

    def _ends_with_execution(self, position: ActivityPosition) -> bool:
        """Whether nothing follows the last execution in an activity, so that it ends with that."""
        everything = self.context.dataflow.events.positions(self.stage.process.name)
        return isinstance(everything[position.last - 1].activity, Execute | ExecutionNeed)

    def _executed(self, position: ActivityPosition, including: bool) -> Numbers:
        """The demand that each job has executed before a position, or including it."""
        process, context = self.stage.process, self.context
        model, core = context.demand_model, context.scheduled[process.name].core
        before = model.of_position(position, core, including)
        everything = model.of_activities(process, process.activities, core)
        total = context.demands[process.name]

        count = len(self.jobs.releases)
        done = schedule.demands_of_jobs(before, count, self.demand_of)
        if self.busy_above is None:
            return done
        # Overheads of the job that belong to no activity may all come first.
        overheads = schedule.demands_of_jobs(total, count, self.demand_of) - schedule.demands_of_jobs(
            everything, count, self.demand_of
        )
        found: Numbers = done + overheads
        return found


def kind(boundary: Boundary) -> JobPhase | None:
    """The phase of the job at a boundary; None: the end of the period."""
    match boundary:
        case Read(communication=Communication.LET):
            return JobPhase.ACTIVATION
        case Read(communication=Communication.EXPLICIT, position=ActivityPosition()):
            return JobPhase.BEFORE
        case Read():
            return JobPhase.START
        case Fire(position=ActivityPosition(), is_before=True):
            return JobPhase.BEFORE
        case Write(communication=Communication.LET):
            return None
        case Write(communication=Communication.EXPLICIT, position=ActivityPosition()) | Fire(position=ActivityPosition()):
            return JobPhase.AFTER
        case Write() | Fire():
            return JobPhase.END
        case At(communication=Communication.LET, is_end=is_end):
            return None if is_end else JobPhase.ACTIVATION
        case At(occurrence=occurrence):
            return occurrence.when
        case Pass():
            return JobPhase.ACTIVATION
    return JobPhase.END


def position_of(boundary: Boundary) -> ActivityPosition | None:
    """The position at a boundary, if it is inside a job."""
    match boundary:
        case At(occurrence=occurrence):
            return occurrence.position
        case Read(position=position) | Write(position=position) | Fire(position=position):
            return position
    return None


def is_inside(boundary: Boundary) -> bool:
    """Whether a boundary is inside a job, so that its time depends on the execution slices."""
    return kind(boundary) in (JobPhase.BEFORE, JobPhase.AFTER)


def is_logical(boundary: Boundary) -> bool:
    """Whether a boundary depends only on releases and periods."""
    return isinstance(boundary, Read | Write | At) and boundary.communication is Communication.LET
