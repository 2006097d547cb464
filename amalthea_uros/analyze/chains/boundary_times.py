"""The times at which the jobs of a stage reach its boundaries, in a schedule."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.chains import completed_work
from amalthea_uros.analyze.chains.stages import At, Boundary, Fire, Read, Stage, Write
from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.schedule import Jobs
from amalthea_uros.perf.software import Communication
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.events import JobPhase
from amalthea_uros.timing.dataflow.positions import ActivityPosition
from amalthea_uros.timing.multiframe import MultiframeDemand
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


@dataclass(frozen=True, slots=True)
class BoundaryTimes:
    """The jobs of a stage in a schedule."""

    context: TimingContext
    stage: Stage
    jobs: Jobs
    period: Time
    demand_of: Callable[[MultiframeDemand, int], Time]

    def at(self, boundary: Boundary, is_late: bool) -> Numbers:
        """When each job reaches a boundary; where that is uncertain, an upper or a lower bound."""
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
        position = boundary.occurrence.position if isinstance(boundary, At) else boundary.position
        assert position is not None
        if not position.is_certain:
            return jobs.ends if is_late else jobs.begins
        if kind(boundary) is JobPhase.BEFORE:
            return completed_work.times_of_continuation(jobs, self._executed(position, including=False))
        return completed_work.times_of_completion(jobs, self._executed(position, including=True))

    def _executed(self, position: ActivityPosition, including: bool) -> Numbers:
        """The demand that each job has executed before a position, or including it."""
        core = self.context.scheduled[self.stage.process.name].core
        demand = self.context.demand_model.of_position(position, core, including)
        table = schedule.demand_table(demand, self.demand_of)
        lead = len(table) - schedule.demand_cycle(demand)
        index = np.arange(len(self.jobs.releases))
        at = np.where(index < lead, index, lead + (index - lead) % schedule.demand_cycle(demand))
        found: Numbers = np.array(table, dtype=np.int64)[at]
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
    return JobPhase.END


def is_inside(boundary: Boundary) -> bool:
    """Whether a boundary is inside a job, so that its time depends on the execution slices."""
    return kind(boundary) in (JobPhase.BEFORE, JobPhase.AFTER)


def is_logical(boundary: Boundary) -> bool:
    """Whether a boundary depends only on releases and periods."""
    return not isinstance(boundary, Fire) and boundary.communication is Communication.LET
