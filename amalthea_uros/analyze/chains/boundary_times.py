"""The times at which the jobs of a stage reach its boundaries: in a schedule, or by response times.

Where the schedule is not known, a job is at a position at the earliest when it has executed what comes before it, and at the latest
when what comes after it still fits into the response time, or when the busy window of the part up to the position ends.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros._internal.records import dataclass
from amalthea_uros.analyze.chains.read_write_times import ReadWriteBounds, ReadWriteTimes
from amalthea_uros.analyze.response_times import schedule
from amalthea_uros.analyze.response_times.core_schedule import Busy, times_of_completion
from amalthea_uros.analyze.response_times.fixed_priority import time_until_executed
from amalthea_uros.analyze.response_times.schedule import Jobs
from amalthea_uros.analyze.response_times.solution import Solution
from amalthea_uros.perf.activities import Communication, Execute, ExecutionNeed
from amalthea_uros.perf.stimuli import Periodic
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.events import JobPhase
from amalthea_uros.timing.dataflow.stages import At, Boundary, Fire, Pass, Read, Stage, Write
from amalthea_uros.timing.demand.multiframe import MultiframeDemand
from amalthea_uros.timing.jobs.positions import ActivityPosition
from amalthea_uros.timing.response import Response
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
        completions = times_of_completion(jobs, executed)
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


@dataclass(frozen=True, slots=True)
class BoundaryWindows:
    """When the jobs of a stage reach its boundaries, relative to their releases; times are in `unit` parts of a picosecond.

    Attributes
    ----------
    response : of its process, with a bounded worst case
    period : of its process, where a boundary is the end of the period
    """

    solution: Solution
    stage: Stage
    response: Response
    unit: int
    period: Time = 0

    def earliest(self, boundary: Boundary) -> Time:
        """A lower bound."""
        match kind(boundary):
            case JobPhase.ACTIVATION | JobPhase.START:
                return 0
            case JobPhase.END:
                return self.response.best * self.unit
            case None:
                return self.period
        before = self._before(boundary)
        return 0 if before is None else before.best * self.unit // self._time_base

    def latest(self, boundary: Boundary) -> Time:
        """An upper bound."""
        worst = (self.response.worst or 0) * self.unit
        match kind(boundary):
            case JobPhase.ACTIVATION:
                return 0
            case JobPhase.START:
                # After its start a job still executes its whole demand.
                return self._latest_after(0, self._demand.best)
            case JobPhase.END:
                return worst
            case None:
                return self.period
        before = self._before(boundary)
        if before is None:
            return worst
        process, context = self.stage.process, self.solution.context
        everything = context.execution_model(process.name).of_activities(process, process.activities, self._core)
        if process.name in context.waiting:
            # It may have waited as long as it can, and executes the rest afterwards.
            return max(0, worst - max(0, everything.best - before.best) * self.unit // self._time_base)
        # Overheads of the job that belong to no activity may all come first.
        return self._latest_after(before.worst + self._demand.worst - everything.worst, everything.best - before.best)

    def _latest_after(self, executed: Time, left: Time) -> Time:
        """When a job has executed at most one demand and has at least another one left."""
        worst = (self.response.worst or 0) * self.unit
        part = time_until_executed(self.stage.process.name, executed, self.solution)
        if part is None:
            return max(0, worst - left * self.unit // self._time_base)
        found = -(-part * self.unit // self._time_base)
        return min(found, worst - left * self.unit // self._time_base) if left else found

    @property
    def _demand(self) -> MultiframeDemand:
        return self.solution.context.demands[self.stage.process.name]

    @property
    def _time_base(self) -> int:
        return self.solution.context.time_base(self.stage.process.name)

    def _before(self, boundary: Boundary) -> MultiframeDemand | None:
        """The demand of a job before a boundary inside it; None if that is uncertain."""
        position = position_of(boundary)
        if position is None or not position.is_certain:
            return None
        model = self.solution.context.execution_model(self.stage.process.name)
        return model.of_position(position, self._core, including=kind(boundary) is JobPhase.AFTER)

    @property
    def _core(self) -> str:
        return self.solution.context.scheduled[self.stage.process.name].core


def logical(releases: Periodic, unit: int) -> ReadWriteBounds:
    """The times of a periodic task under logical execution time (LET): it reads at its release and publishes at the end of its period.

    They do not depend on the schedule, so that job chains are exact (J. Martinez, I. Sañudo and M. Bertogna, "Analytical
    characterization of end-to-end communication delays with logical execution time", IEEE Transactions on CAD 37(11), 2018).
    """
    period, offset = releases.period * unit, releases.offset * unit
    reads = np.array([offset], dtype=np.int64)
    times = ReadWriteTimes(releases=reads, reads=reads, writes=reads + period, cycle=period, until=offset + period)
    return ReadWriteBounds(pessimistic=times, optimistic=times, steady_state_start=offset, is_logical=True)


def by_schedule(stage: Stage, solution: Solution, unit: int) -> ReadWriteBounds | None:
    """The times of a stage by the schedule of its core; None if that is unknown or too long."""
    context, name = solution.context, stage.process.name
    scheduled = context.scheduled.get(name)
    inside = any(map(is_inside, (stage.enter, stage.leave)))
    found = None if scheduled is None else solution.schedule(scheduled.core, inside)
    if found is None:
        return None
    period, time_base = found.tasks[name].period, context.time_base(name)
    best, worst = MultiframeDemand.best_of, MultiframeDemand.worst_of
    early = BoundaryTimes(context, stage, found.best[name], period, best)
    late = BoundaryTimes(context, stage, found.worst[name], period, worst, found.busy_above(name) if inside else None)

    def unified(times: Numbers, is_upper: bool) -> Numbers:
        """Times of the core in the unit that all cores share; rounded up or down if that is coarser."""
        if unit % time_base == 0:
            return times if unit == time_base else times * (unit // time_base)
        return -(-times // time_base) if is_upper else times // time_base

    def read_write_times(read: BoundaryTimes, write: BoundaryTimes) -> ReadWriteTimes:
        return ReadWriteTimes(
            releases=unified(early.jobs.releases, is_upper=False),
            reads=unified(read.at(stage.enter), is_upper=read is late),
            writes=unified(write.at(stage.leave), is_upper=write is late),
            cycle=found.cycle * unit // time_base,
            until=found.until * unit // time_base,
        )

    pessimistic = read_write_times(early, late)
    is_one_run = early.jobs is late.jobs and not inside and unit % time_base == 0
    return ReadWriteBounds(
        pessimistic=pessimistic,
        optimistic=pessimistic if is_one_run else read_write_times(late, early),
        steady_state_start=found.steady_state_start * unit // time_base,
    )


def by_response(windows: BoundaryWindows, releases: Periodic) -> ReadWriteBounds:
    """The times of a stage by its windows, of which the period is that of the releases."""
    stage, period, offset = windows.stage, windows.period, releases.offset * windows.unit
    release_times = offset + period * np.arange(2, dtype=np.int64)

    def read_write_times(read: Time, write: Time) -> ReadWriteTimes:
        reads, writes = release_times + read, release_times + write
        return ReadWriteTimes(releases=release_times, reads=reads, writes=writes, cycle=period, until=offset + 2 * period)

    return ReadWriteBounds(
        pessimistic=read_write_times(windows.earliest(stage.enter), windows.latest(stage.leave)),
        optimistic=read_write_times(windows.latest(stage.enter), windows.earliest(stage.leave)),
        steady_state_start=offset,
    )
