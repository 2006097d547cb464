"""When the moments of the jobs of a stage come, in a schedule."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.chains import completed_work as completed_work
from amalthea_uros.analyze.chains.stages import At, Fire, Moment, Read, Stage, Write
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
class Moments:
    """The moments of the jobs of a stage in a schedule."""

    context: TimingContext
    stage: Stage
    jobs: Jobs
    period: Time
    cost_of: Callable[[MultiframeDemand, int], Time]

    def at(self, moment: Moment, is_late: bool) -> Numbers:
        """Of each job; where it is not certain, on the late or the early side."""
        jobs = self.jobs
        match kind(moment):
            case JobPhase.ACTIVATION:
                return jobs.releases
            case JobPhase.START:
                return jobs.begins
            case JobPhase.END:
                return jobs.ends
            case None:
                return jobs.releases + self.period
        position = moment.occurrence.position if isinstance(moment, At) else moment.position
        assert position is not None
        if not position.is_certain:
            return jobs.ends if is_late else jobs.begins
        if kind(moment) is JobPhase.BEFORE:
            return completed_work.before(jobs, self._executed(position, with_place=False))
        return completed_work.behind(jobs, self._executed(position, with_place=True))

    def _executed(self, position: ActivityPosition, with_place: bool) -> Numbers:
        """How much each job has executed before a position, or behind it."""
        process, context = self.stage.process, self.context
        core = context.scheduled[process.name].core
        before = (*position.before, position.activity) if with_place else position.before
        cost = context.demand_model.of_activities(process, before, core)
        table = schedule.table(cost, self.cost_of)
        lead = len(table) - schedule.cycle(cost)
        index = np.arange(len(self.jobs.releases))
        at = np.where(index < lead, index, lead + (index - lead) % schedule.cycle(cost))
        found: Numbers = np.array(table, dtype=np.int64)[at]
        return found


def kind(moment: Moment) -> JobPhase | None:
    """At what a moment is; None: at the end of the period."""
    match moment:
        case Read(communication=Communication.LET):
            return JobPhase.ACTIVATION
        case Read(communication=Communication.EXPLICIT, position=ActivityPosition()):
            return JobPhase.BEFORE
        case Read():
            return JobPhase.START
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


def is_inside(moment: Moment) -> bool:
    """Whether a moment lies within a job, where only its pieces tell when that is."""
    return kind(moment) in (JobPhase.BEFORE, JobPhase.AFTER)


def is_logical(moment: Moment) -> bool:
    """Whether a moment depends on releases and periods alone."""
    return not isinstance(moment, Fire) and moment.communication is Communication.LET
