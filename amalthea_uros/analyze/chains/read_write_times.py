"""Stages of a chain in time: when jobs read and write at the earliest and at the latest.

By the schedule of a core where that is known but for execution times: the one of all best cases and the one of all worst cases
bound every other one. Otherwise by releases and response times. Where releases are not known, there is only a step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from math import lcm
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.chains import let as logical
from amalthea_uros.analyze.chains.bounds.chain_task import ChainTask
from amalthea_uros.analyze.chains.core_schedule import CoreSchedules
from amalthea_uros.analyze.chains.job_times import ReadWriteTimes
from amalthea_uros.analyze.chains.moments import Moments, is_inside, is_logical, kind
from amalthea_uros.analyze.chains.stages import At, Fire, Moment, Read, Stage
from amalthea_uros.analyze.chains.timed_stage import ReadWriteBounds, TimedStage
from amalthea_uros.analyze.response_times.schedule import MAX_JOBS
from amalthea_uros.analyze.results import Response
from amalthea_uros.analyze.solution import Solution
from amalthea_uros.perf.software import Communication, Process, Trigger
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess, Periodic
from amalthea_uros.timing.context import TimingContext
from amalthea_uros.timing.dataflow.events import JobPhase
from amalthea_uros.timing.demand import MAX_TIME_BASE
from amalthea_uros.timing.limits import LIMIT
from amalthea_uros.timing.multiframe import MultiframeDemand
from amalthea_uros.timing.releases import known_releases
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


class UnboundedStageError(Exception):
    """Nothing bounds when jobs of a stage come; the text says why."""


@dataclass(slots=True)
class StageTiming:
    """The stages of the chains of a system in time; all times are in parts of a picosecond, `unit` of which make one."""

    solution: Solution
    unit: int = field(init=False)
    schedules: CoreSchedules = field(init=False)

    @property
    def context(self) -> TimingContext:
        """The system."""
        return self.solution.context

    def __post_init__(self) -> None:
        self.schedules = CoreSchedules(self.solution)
        unit = lcm(*(self.context.demand_model.time_base(core) for core in self.context.system.cores))
        self.unit = unit if unit <= MAX_TIME_BASE else 1

    def group(self, stages: Sequence[Stage], follower: Stage | None) -> TimedStage:
        """A stage and those that it triggers one after the other.

        Parameters
        ----------
        follower : the first stage that reads from the last of them

        Raises
        ------
        UnboundedStageError : something in it has no bounded response time, or is not known.
        """
        base, triggered = stages[0], stages[1:]
        behind = sum(self._worst(stage.process) for stage in triggered)
        least = sum(self._least(stage) for stage in triggered)
        counters = self._counters(stages)
        preempts_reader = self._preempts_reader(base, follower) and not triggered
        step = self._step(base, behind, counters, preempts_reader)
        releases = known_releases(base.process, self.context.system)
        if releases is None:
            return TimedStage(step=step, reason=f"the releases of {base.process.name!r} are not known")
        if len(counters) > 1:
            return TimedStage(step=step, reason=f"it is not known which jobs of {base.process.name!r} take part")
        if self._is_too_long(releases, counters):
            return TimedStage(
                step=step, reason=f"the jobs of {base.process.name!r} that take part are too far apart to be followed"
            )
        if is_logical(base.enter) and is_logical(base.leave):
            tracks = self._logical(releases)
        else:
            tracks = self._by_schedule(base, releases) or self._by_response(base, releases)
        pessimistic, optimistic = _later(tracks.pessimistic, behind), _later(tracks.optimistic, least)
        tracks = replace(
            tracks,
            pessimistic=self._part(pessimistic, counters, releases, preempts_reader, tracks.steady_state_start),
            optimistic=self._part(optimistic, counters, releases, False, tracks.steady_state_start),
            is_exact=tracks.is_exact and not triggered,
        )
        return TimedStage(step=step, tracks=tracks)

    def _is_too_long(self, releases: Periodic, counters: Sequence[Counter]) -> bool:
        """Whether two jobs that take part are so far apart that arrays of times cannot hold that, or too many others lie between."""
        most = max((max(counter.prescaler, counter.offset) for counter in counters), default=1)
        return most > MAX_JOBS or (releases.offset + 4 * most * releases.period) * self.unit > LIMIT

    # What is known of processes

    def _response(self, process: Process) -> Response:
        response = self.solution.responses.get(process.name)
        if response is None:
            reason = self.solution.reasons.get(process.name, "nothing is known of it")
            raise UnboundedStageError(f"the response time of {process.name!r} is not known: {reason}")
        return response

    def _worst(self, process: Process) -> Time:
        response = self._response(process)
        if response.worst is None:
            raise UnboundedStageError(f"the response time of {process.name!r} has no bound: {response.reason}")
        return response.worst * self.unit

    def _least(self, stage: Stage) -> Time:
        """The minimum time from the activation of a triggered process to where it is left."""
        match kind(stage.leave):
            case JobPhase.ACTIVATION | JobPhase.START:
                return 0
            case JobPhase.BEFORE | JobPhase.AFTER:
                return self._least_before(stage)
        return self._response(stage.process).best * self.unit

    def _least_before(self, stage: Stage) -> Time:
        """The minimum that a job executes before it leaves the stage at an activity."""
        leave = stage.leave
        position = leave.occurrence.position if isinstance(leave, At) else leave.position
        if position is None or not position.is_certain:
            return 0
        demand = self.context.demand_model.of_activities(
            stage.process, position.before, self.context.scheduled[stage.process.name].core
        )
        return demand.best * self.unit // self.context.time_base(stage.process.name)

    def _counters(self, stages: Sequence[Stage]) -> list[Counter]:
        """What lets only some jobs of the first stage take part; those of triggers count its jobs, too."""
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
        return [counter for counter in found if counter.prescaler > 1 or counter.offset > 1]

    def _step(self, base: Stage, behind: Time, counters: Sequence[Counter], preempts_reader: bool) -> ChainTask:
        name = base.process.name
        arrivals = self.solution.event_models.get(name)
        gap = arrivals.max_interarrival if arrivals is not None else None
        releases = known_releases(base.process, self.context.system)
        period = (gap or 0) * self.unit
        offset = None if releases is None else releases.offset * self.unit
        for counter in counters:
            if offset is not None and releases is not None:
                offset += ((counter.offset or counter.prescaler) - 1) * releases.period * self.unit
            period *= counter.prescaler
        response = self._worst(base.process)
        if is_logical(base.leave):
            if releases is None or response > releases.period * self.unit:
                raise UnboundedStageError(f"{name!r} does not always end within its period, which logical execution times need")
            response = releases.period * self.unit
        return ChainTask(
            name=name,
            period=period,
            is_regular=gap is not None,
            response=response + behind,
            offset=offset if len(counters) < 2 else None,
            preempts_reader=preempts_reader,
        )

    def _preempts_reader(self, base: Stage, follower: Stage | None) -> bool:
        """Whether the jobs of a stage come before those of the next one, which cannot read while they wait or run."""
        if follower is None or isinstance(base.leave, Fire) or is_logical(base.leave) or is_logical(follower.enter):
            return False
        first, then = self.context.scheduled.get(base.process.name), self.context.scheduled.get(follower.process.name)
        if base.process.name == follower.process.name:
            return False  # a job does not read what it is still to write itself, although it is released before it reads
        if first is None or then is None or first.core != then.core or first.server or then.server or first.rank <= then.rank:
            return False
        # Elsewhere than at its start a reader may be about to read just when the writer is released.
        return isinstance(follower.enter, Read) and follower.enter.communication is Communication.IMPLICIT

    # ReadWriteBounds

    def _logical(self, releases: Periodic) -> ReadWriteBounds:
        period, offset = releases.period * self.unit, releases.offset * self.unit
        track = logical.track(period, offset, period)
        return ReadWriteBounds(pessimistic=track, optimistic=track, steady_state_start=offset, is_exact=True, is_logical=True)

    def _by_schedule(self, stage: Stage, releases: Periodic) -> ReadWriteBounds | None:
        placed = self.context.scheduled.get(stage.process.name)
        if placed is None:
            return None
        found = self.schedules.of(placed.core, any(map(is_inside, (stage.enter, stage.leave))))
        if found is None:
            return None
        name, period = stage.process.name, found.tasks[stage.process.name].period
        early = Moments(self.context, stage, found.best[name], period, MultiframeDemand.best_of)
        late = Moments(self.context, stage, found.worst[name], period, MultiframeDemand.worst_of)
        time_base = self.context.demand_model.time_base(placed.core)

        def track(reads: Numbers, writes: Numbers) -> ReadWriteTimes:
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
            pessimistic=track(early.at(stage.enter, False), late.at(stage.leave, True)),
            optimistic=track(late.at(stage.enter, True), early.at(stage.leave, False)),
            steady_state_start=found.steady_state_start * self.unit // time_base,
            is_exact=found.is_constant and certain,
        )

    def _unified(self, track: ReadWriteTimes, time_base: int) -> ReadWriteTimes:
        """A track in the unit that all cores share; rounded outwards where that is too fine."""
        if self.unit % time_base == 0:
            factor = self.unit // time_base
            return track if factor == 1 else track.scaled(factor)
        return ReadWriteTimes(
            releases=track.releases // time_base,
            reads=track.reads // time_base,
            writes=-(-track.writes // time_base),
            cycle=track.cycle // time_base,
            until=track.until // time_base,
        )

    def _by_response(self, stage: Stage, releases: Periodic) -> ReadWriteBounds:
        response, cost = self._response(stage.process), self.context.demands[stage.process.name]
        placed = self.context.scheduled[stage.process.name]
        time_base = self.context.demand_model.time_base(placed.core)
        period, offset = releases.period * self.unit, releases.offset * self.unit
        times = offset + period * np.arange(2, dtype=np.int64)
        best, worst = response.best * self.unit, self._worst(stage.process)
        # Of its response time a job executes its least cost at least behind its start.
        start = max(0, worst - cost.best * self.unit // time_base)

        def at(moment: Moment, is_late: bool) -> Numbers:
            match kind(moment):
                case JobPhase.ACTIVATION:
                    return times
                case JobPhase.START:
                    return times + (start if is_late else 0)
                case JobPhase.END:
                    return times + (worst if is_late else best)
                case None:
                    return times + period
            return times + (worst if is_late else 0)

        def track(reads: Numbers, writes: Numbers) -> ReadWriteTimes:
            return ReadWriteTimes(releases=times, reads=reads, writes=writes, cycle=period, until=offset + 2 * period)

        return ReadWriteBounds(
            pessimistic=track(at(stage.enter, False), at(stage.leave, True)),
            optimistic=track(at(stage.enter, True), at(stage.leave, False)),
            steady_state_start=offset,
        )

    def _part(
        self,
        track: ReadWriteTimes,
        counters: Sequence[Counter],
        releases: Periodic,
        preempts_reader: bool,
        steady_state_start: Time,
    ) -> ReadWriteTimes:
        """Only the jobs that take part."""
        if counters:
            (counter,) = counters
            cycle = lcm(track.cycle, releases.period * self.unit * counter.prescaler)
            lead = counter.offset * releases.period * self.unit
            track = track.extended(max(track.until, steady_state_start + lead) + 2 * cycle)
            numbers = np.arange(1, len(track.releases) + 1)
            taking_part = (numbers >= max(counter.offset, 1)) & ((numbers - counter.offset) % counter.prescaler == 0)
            track = ReadWriteTimes(
                releases=track.releases[taking_part],
                reads=track.reads[taking_part],
                writes=track.writes[taking_part],
                cycle=cycle,
                until=track.until,
            )
        return replace(track, preempts_reader=preempts_reader)


def _later(track: ReadWriteTimes, behind: Time) -> ReadWriteTimes:
    return replace(track, writes=track.writes + behind) if behind else track


def in_picoseconds(value: Fraction | Time, unit: int, is_upper: bool) -> Time:
    """A time in whole picoseconds, rounded up or down."""
    return -int(-value // unit) if is_upper else int(value // unit)
