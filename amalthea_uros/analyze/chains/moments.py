"""When the moments of the jobs of a stage come, in a schedule."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.chains import completed_work as progress
from amalthea_uros.analyze.chains.stages import At, Fire, Moment, Read, Stage, Write
from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.schedule import Jobs
from amalthea_uros.perf.software import Communication
from amalthea_uros.timing.context import Known
from amalthea_uros.timing.dataflow.events import When
from amalthea_uros.timing.dataflow.positions import Place
from amalthea_uros.timing.multiframe import Cost
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


@dataclass(frozen=True, slots=True)
class Moments:
    """The moments of the jobs of a stage in a schedule."""

    known: Known
    stage: Stage
    jobs: Jobs
    period: Time
    cost_of: Callable[[Cost, int], Time]

    def at(self, moment: Moment, is_late: bool) -> Numbers:
        """Of each job; where it is not certain, on the late or the early side."""
        jobs = self.jobs
        match kind(moment):
            case When.ACTIVATION:
                return jobs.releases
            case When.START:
                return jobs.begins
            case When.END:
                return jobs.ends
            case None:
                return jobs.releases + self.period
        place = moment.spot.place if isinstance(moment, At) else moment.place
        assert place is not None
        if not place.is_certain:
            return jobs.ends if is_late else jobs.begins
        if kind(moment) is When.BEFORE:
            return progress.before(jobs, self._executed(place, with_place=False))
        return progress.behind(jobs, self._executed(place, with_place=True))

    def _executed(self, place: Place, with_place: bool) -> Numbers:
        """How much each job has executed before a place, or behind it."""
        process, known = self.stage.process, self.known
        core = known.placed[process.name].core
        before = (*place.before, place.activity) if with_place else place.before
        cost = known.demands.piece(process, before, core)
        table = schedule.table(cost, self.cost_of)
        lead = len(table) - schedule.cycle(cost)
        index = np.arange(len(self.jobs.releases))
        at = np.where(index < lead, index, lead + (index - lead) % schedule.cycle(cost))
        found: Numbers = np.array(table, dtype=np.int64)[at]
        return found


def kind(moment: Moment) -> When | None:
    """At what a moment is; None: at the end of the period."""
    match moment:
        case Read(communication=Communication.LET):
            return When.ACTIVATION
        case Read(communication=Communication.EXPLICIT, place=Place()):
            return When.BEFORE
        case Read():
            return When.START
        case Write(communication=Communication.LET):
            return None
        case Write(communication=Communication.EXPLICIT, place=Place()) | Fire(place=Place()):
            return When.BEHIND
        case Write() | Fire():
            return When.END
        case At(communication=Communication.LET, is_end=is_end):
            return None if is_end else When.ACTIVATION
        case At(spot=spot):
            return spot.when
    return When.END


def is_inside(moment: Moment) -> bool:
    """Whether a moment lies within a job, where only its pieces tell when that is."""
    return kind(moment) in (When.BEFORE, When.BEHIND)


def is_logical(moment: Moment) -> bool:
    """Whether a moment depends on releases and periods alone."""
    return not isinstance(moment, Fire) and moment.communication is Communication.LET
