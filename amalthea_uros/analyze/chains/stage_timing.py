"""When the jobs of the stages of a chain read and write, at the earliest and at the latest.

If the schedule of the core is known apart from execution times, the schedules of all best and of all worst cases bound every other
schedule. Otherwise releases and response times give the bounds. If releases are unknown, a stage is only a `ChainTask`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from math import lcm
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.chains import let
from amalthea_uros.analyze.chains.boundary_times import BoundaryTimes, is_inside, is_logical, kind
from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.analyze.chains.core_schedule import CoreSchedules
from amalthea_uros.analyze.chains.read_write_times import ReadWriteTimes
from amalthea_uros.analyze.chains.stages import At, Boundary, Fire, Read, Stage
from amalthea_uros.analyze.chains.timed_stage import ReadWriteBounds, TimedStage
from amalthea_uros.analyze.response_times.schedule import MAX_JOBS
from amalthea_uros.analyze.results import Response
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.software import Communication, Process, Trigger
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess, Periodic
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.counters import first_effect, is_always, max_distance
from amalthea_uros.timing.dataflow.events import JobPhase
from amalthea_uros.timing.demand import MAX_TIME_BASE
from amalthea_uros.timing.limits import LIMIT
from amalthea_uros.timing.multiframe import MultiframeDemand
from amalthea_uros.timing.releases import known_releases
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


class UnboundedStageError(Exception):
    """There is no bound on when the jobs of a stage execute; the text says why."""


@dataclass(slots=True)
class StageTiming:
    """Finds read and write times of the stages of chains; times are counted in `unit` parts of a picosecond."""

    solution: Solution
    unit: int = field(init=False)
    schedules: CoreSchedules = field(init=False)

    @property
    def context(self) -> TimingContext:
        """The timing context of the system."""
        return self.solution.context

    def __post_init__(self) -> None:
        self.schedules = CoreSchedules(self.solution)
        unit = lcm(*(self.context.demand_model.time_base(core) for core in self.context.system.cores))
        self.unit = unit if unit <= MAX_TIME_BASE else 1

    def group(self, stages: Sequence[Stage], follower: Stage | None) -> TimedStage:
        """A stage and those that it triggers, directly or through others.

        Parameters
        ----------
        follower : the first stage that reads from the last of them

        Raises
        ------
        UnboundedStageError : a response time in it is unbounded or unknown.
        """
        base, triggered = stages[0], stages[1:]
        max_delay = sum(self._worst(stage.process) for stage in triggered)
        min_delay = sum(self._min_delay(stage) for stage in triggered)
        counters = self._counters(stages)
        preempts_reader = self._preempts_reader(base, follower) and not triggered
        is_countable = all(stage.is_countable for stage in stages)
        task = self._chain_task(base, max_delay, counters, is_countable, preempts_reader)
        releases = known_releases(base.process, self.context.system)
        if releases is None:
            return TimedStage(task=task, reason=f"the release times of {base.process.name!r} are unknown")
        if not is_countable:
            return TimedStage(task=task, reason=f"it is unknown which jobs of {base.process.name!r} take part")
        if len(counters) > 1:
            return TimedStage(task=task, reason=f"several counters select the jobs of {base.process.name!r}")
        if not all(counter.is_phase_known for counter in counters):
            return TimedStage(task=task, reason=f"the phase at which {base.process.name!r} takes part is unknown")
        if self._is_too_long(releases, counters):
            return TimedStage(task=task, reason=f"the jobs of {base.process.name!r} that take part are too far apart")
        if is_logical(base.enter) and is_logical(base.leave):
            read_write = self._logical(releases)
        else:
            read_write = self._by_schedule(base, releases) or self._by_response(base, releases)
        pessimistic, optimistic = _later(read_write.pessimistic, max_delay), _later(read_write.optimistic, min_delay)
        read_write = replace(
            read_write,
            pessimistic=self._taking_part(pessimistic, counters, releases, preempts_reader, read_write.steady_state_start),
            optimistic=self._taking_part(optimistic, counters, releases, False, read_write.steady_state_start),
            is_exact=read_write.is_exact and not triggered,
        )
        return TimedStage(task=task, read_write=read_write)

    def _is_too_long(self, releases: Periodic, counters: Sequence[Counter]) -> bool:
        """Whether two jobs that take part are too far apart in time, or have too many others between them."""
        max_distance = max((max(counter.prescaler, first_effect(counter)) for counter in counters), default=1)
        return max_distance > MAX_JOBS or (releases.offset + 4 * max_distance * releases.period) * self.unit > LIMIT

    # Processes

    def _response(self, process: Process) -> Response:
        response = self.solution.responses.get(process.name)
        if response is None:
            reason = self.solution.reasons.get(process.name, "it was not analysed")
            raise UnboundedStageError(f"the response time of {process.name!r} is unknown: {reason}")
        return response

    def _worst(self, process: Process) -> Time:
        response = self._response(process)
        if response.worst is None:
            raise UnboundedStageError(f"the response time of {process.name!r} is unbounded: {response.reason}")
        return response.worst * self.unit

    def _min_delay(self, stage: Stage) -> Time:
        """The minimum time from the activation of a triggered process to the end of its stage."""
        match kind(stage.leave):
            case JobPhase.ACTIVATION | JobPhase.START:
                return 0
            case JobPhase.BEFORE | JobPhase.AFTER:
                return self._min_demand(stage)
        return self._response(stage.process).best * self.unit

    def _min_demand(self, stage: Stage) -> Time:
        """The minimum demand of a job before the activity at which it leaves the stage."""
        leave = stage.leave
        position = leave.occurrence.position if isinstance(leave, At) else leave.position
        if position is None or not position.is_certain:
            return 0
        core = self.context.scheduled[stage.process.name].core
        demand = self.context.demand_model.of_position(position, core, including=False)
        return demand.best * self.unit // self.context.time_base(stage.process.name)

    def _counters(self, stages: Sequence[Stage]) -> list[Counter]:
        """The counters that let only some jobs of the first stage take part, including those of triggers."""
        found = set(stages[0].counters)
        for stage, then in pairwise(stages):
            if isinstance(stage.leave, Fire) and stage.leave.position is not None:
                trigger = stage.leave.position.activity
                if isinstance(trigger, Trigger) and trigger.counter is not None:
                    found.add(trigger.counter)
            for name in then.process.stimuli:
                stimulus = self.context.system.stimuli_by_name.get(name)
                if isinstance(stimulus, InterProcess | EventTriggered) and stimulus.counter is not None:
                    found.add(stimulus.counter)
            found |= then.counters
        return [counter for counter in found if not is_always(counter)]

    def _chain_task(
        self, base: Stage, delay: Time, counters: Sequence[Counter], is_countable: bool, preempts_reader: bool
    ) -> ChainTask:
        name = base.process.name
        events = self.solution.event_models.get(name)
        max_interarrival = events.max_interarrival if events is not None else None
        releases = known_releases(base.process, self.context.system)
        period = (max_interarrival or 0) * self.unit
        offset = None if releases is None else releases.offset * self.unit
        for counter in counters:
            if offset is not None and releases is not None:
                offset += (first_effect(counter) - 1) * releases.period * self.unit
            period *= max_distance(counter)
        response = self._worst(base.process)
        if is_logical(base.leave):
            if releases is None or response > releases.period * self.unit:
                raise UnboundedStageError(f"{name!r} does not always end within its period, as LET communication requires")
            response = releases.period * self.unit
        return ChainTask(
            name=name,
            period=period,
            is_regular=max_interarrival is not None and is_countable,
            response=response + delay,
            offset=offset
            if len(counters) < 2 and is_countable and all(counter.is_phase_known for counter in counters)
            else None,
            preempts_reader=preempts_reader,
        )

    def _preempts_reader(self, base: Stage, follower: Stage | None) -> bool:
        """Whether the jobs of a stage preempt those of the next one, so that these cannot read before they have written."""
        if follower is None or isinstance(base.leave, Fire) or is_logical(base.leave) or is_logical(follower.enter):
            return False
        first, then = self.context.scheduled.get(base.process.name), self.context.scheduled.get(follower.process.name)
        if base.process.name == follower.process.name:
            return False  # a job cannot read its own future output
        if first is None or then is None or first.core != then.core or first.server or then.server or first.rank <= then.rank:
            return False
        # A reader that reads later than at its start may read just when the writer is released.
        return isinstance(follower.enter, Read) and follower.enter.communication is Communication.IMPLICIT

    # Read and write times

    def _logical(self, releases: Periodic) -> ReadWriteBounds:
        period, offset = releases.period * self.unit, releases.offset * self.unit
        times = let.read_write_times(period, offset, period)
        return ReadWriteBounds(pessimistic=times, optimistic=times, steady_state_start=offset, is_exact=True, is_logical=True)

    def _by_schedule(self, stage: Stage, releases: Periodic) -> ReadWriteBounds | None:
        scheduled = self.context.scheduled.get(stage.process.name)
        if scheduled is None:
            return None
        found = self.schedules.of(scheduled.core, any(map(is_inside, (stage.enter, stage.leave))))
        if found is None:
            return None
        name, period = stage.process.name, found.tasks[stage.process.name].period
        early = BoundaryTimes(self.context, stage, found.best[name], period, MultiframeDemand.best_of)
        late = BoundaryTimes(self.context, stage, found.worst[name], period, MultiframeDemand.worst_of)
        time_base = self.context.demand_model.time_base(scheduled.core)

        def read_write_times(reads: Numbers, writes: Numbers) -> ReadWriteTimes:
            return self._unified(
                ReadWriteTimes(
                    releases=found.worst[name].releases, reads=reads, writes=writes, cycle=found.cycle, until=found.until
                ),
                time_base,
            )

        certain = all(position.is_certain for position in stage.positions) or not any(
            map(is_inside, (stage.enter, stage.leave))
        )
        return ReadWriteBounds(
            pessimistic=read_write_times(early.at(stage.enter, False), late.at(stage.leave, True)),
            optimistic=read_write_times(late.at(stage.enter, True), early.at(stage.leave, False)),
            steady_state_start=found.steady_state_start * self.unit // time_base,
            is_exact=found.is_constant and certain,
        )

    def _unified(self, times: ReadWriteTimes, time_base: int) -> ReadWriteTimes:
        """The times in the unit that all cores share; rounded outwards if that is coarser."""
        if self.unit % time_base == 0:
            factor = self.unit // time_base
            return times if factor == 1 else times.scaled(factor)
        return ReadWriteTimes(
            releases=times.releases // time_base,
            reads=times.reads // time_base,
            writes=-(-times.writes // time_base),
            cycle=times.cycle // time_base,
            until=times.until // time_base,
        )

    def _by_response(self, stage: Stage, releases: Periodic) -> ReadWriteBounds:
        response, demand = self._response(stage.process), self.context.demands[stage.process.name]
        scheduled = self.context.scheduled[stage.process.name]
        time_base = self.context.demand_model.time_base(scheduled.core)
        period, offset = releases.period * self.unit, releases.offset * self.unit
        release_times = offset + period * np.arange(2, dtype=np.int64)
        best, worst = response.best * self.unit, self._worst(stage.process)
        # After its start a job still executes at least its best-case demand.
        start = max(0, worst - demand.best * self.unit // time_base)

        def at(boundary: Boundary, is_late: bool) -> Numbers:
            match kind(boundary):
                case JobPhase.ACTIVATION:
                    return release_times
                case JobPhase.START:
                    return release_times + (start if is_late else 0)
                case JobPhase.END:
                    return release_times + (worst if is_late else best)
                case None:
                    return release_times + period
            return release_times + (worst if is_late else 0)

        def read_write_times(reads: Numbers, writes: Numbers) -> ReadWriteTimes:
            return ReadWriteTimes(releases=release_times, reads=reads, writes=writes, cycle=period, until=offset + 2 * period)

        return ReadWriteBounds(
            pessimistic=read_write_times(at(stage.enter, False), at(stage.leave, True)),
            optimistic=read_write_times(at(stage.enter, True), at(stage.leave, False)),
            steady_state_start=offset,
        )

    def _taking_part(
        self,
        times: ReadWriteTimes,
        counters: Sequence[Counter],
        releases: Periodic,
        preempts_reader: bool,
        steady_state_start: Time,
    ) -> ReadWriteTimes:
        """The read and write times of only those jobs that take part."""
        if counters:
            (counter,) = counters
            cycle = lcm(times.cycle, releases.period * self.unit * counter.prescaler)
            lead = first_effect(counter) * releases.period * self.unit
            times = times.extended(max(times.until, steady_state_start + lead) + 2 * cycle)
            first, numbers = first_effect(counter), np.arange(1, len(times.releases) + 1)
            taking_part = (numbers >= first) & ((numbers - first) % counter.prescaler == 0)
            times = ReadWriteTimes(
                releases=times.releases[taking_part],
                reads=times.reads[taking_part],
                writes=times.writes[taking_part],
                cycle=cycle,
                until=times.until,
            )
        return replace(times, preempts_reader=preempts_reader)


def _later(times: ReadWriteTimes, delay: Time) -> ReadWriteTimes:
    return replace(times, writes=times.writes + delay) if delay else times


def in_picoseconds(value: Fraction | Time, unit: int, is_upper: bool) -> Time:
    """A time in whole picoseconds; upper bounds are rounded up, lower bounds down."""
    return -int(-value // unit) if is_upper else int(value // unit)
