"""Stages of a chain in time: when jobs read and write at the earliest and at the latest.

By the schedule of a core where that is known but for execution times: the one of all best cases and the one of all worst cases
bound every other one. Otherwise by releases and response times. Where releases are not known, there is only a step.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from itertools import pairwise
from math import lcm
from typing import TYPE_CHECKING

import numpy as np

from amalthea_uros.analyze.chains import let as logical
from amalthea_uros.analyze.chains.bounds.chain_task import Step
from amalthea_uros.analyze.chains.core_schedule import CoreSchedules
from amalthea_uros.analyze.chains.job_times import Track
from amalthea_uros.analyze.chains.moments import Moments, is_inside, is_logical, kind
from amalthea_uros.analyze.chains.stages import At, Fire, Moment, Read, Stage
from amalthea_uros.analyze.chains.timed_stage import Timed, Tracks
from amalthea_uros.analyze.response_times.core import known_releases
from amalthea_uros.analyze.response_times.kernel import LIMIT
from amalthea_uros.analyze.response_times.schedule import MOST_JOBS
from amalthea_uros.analyze.response_times.task import Response
from amalthea_uros.perf.software import Communication, Process, Trigger
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess, Periodic
from amalthea_uros.timing.context import Known
from amalthea_uros.timing.dataflow.events import When
from amalthea_uros.timing.demand import MOST_GRAINS
from amalthea_uros.timing.multiframe import Cost
from amalthea_uros.units import Time

if TYPE_CHECKING:
    from amalthea_uros.analyze.response_times.kernel import Numbers


class UntimedError(Exception):
    """Nothing bounds when jobs of a stage come; the text says why."""


@dataclass(slots=True)
class Timing:
    """The stages of the chains of a system in time; all times are in parts of a picosecond, `unit` of which make one."""

    known: Known
    responses: Mapping[str, Response]
    unit: int = field(init=False)
    schedules: CoreSchedules = field(init=False)

    def __post_init__(self) -> None:
        self.schedules = CoreSchedules(self.known)
        unit = lcm(*(self.known.demands.grains(core) for core in self.known.system.cores))
        self.unit = unit if unit <= MOST_GRAINS else 1

    def group(self, stages: Sequence[Stage], follower: Stage | None) -> Timed:
        """A stage and those that it triggers one after the other.

        Parameters
        ----------
        follower : the first stage that reads from the last of them

        Raises
        ------
        UntimedError : something in it has no bounded response time, or is not known.
        """
        base, triggered = stages[0], stages[1:]
        behind = sum(self._worst(stage.process) for stage in triggered)
        least = sum(self._least(stage) for stage in triggered)
        counters = self._counters(stages)
        hurries = self._hurries(base, follower) and not triggered
        step = self._step(base, behind, counters, hurries)
        releases = known_releases(base.process, self.known.system)
        if releases is None:
            return Timed(step=step, reason=f"the releases of {base.process.name!r} are not known")
        if len(counters) > 1:
            return Timed(step=step, reason=f"it is not known which jobs of {base.process.name!r} take part")
        if self._is_too_long(releases, counters):
            return Timed(step=step, reason=f"the jobs of {base.process.name!r} that take part are too far apart to be followed")
        if is_logical(base.enter) and is_logical(base.leave):
            tracks = self._logical(releases)
        else:
            tracks = self._by_schedule(base, releases) or self._by_response(base, releases)
        widest, narrowest = _later(tracks.widest, behind), _later(tracks.narrowest, least)
        tracks = replace(
            tracks,
            widest=self._part(widest, counters, releases, hurries, tracks.settled),
            narrowest=self._part(narrowest, counters, releases, False, tracks.settled),
            is_exact=tracks.is_exact and not triggered,
        )
        return Timed(step=step, tracks=tracks)

    def _is_too_long(self, releases: Periodic, counters: Sequence[Counter]) -> bool:
        """Whether two jobs that take part are so far apart that arrays of times cannot hold that, or too many others lie between."""
        most = max((max(counter.prescaler, counter.offset) for counter in counters), default=1)
        return most > MOST_JOBS or (releases.offset + 4 * most * releases.period) * self.unit > LIMIT

    # What is known of processes

    def _response(self, process: Process) -> Response:
        response = self.responses.get(process.name)
        if response is None:
            reason = self.known.reasons.get(process.name, "nothing is known of it")
            raise UntimedError(f"the response time of {process.name!r} is not known: {reason}")
        return response

    def _worst(self, process: Process) -> Time:
        response = self._response(process)
        if response.worst is None:
            raise UntimedError(f"the response time of {process.name!r} has no bound: {response.reason}")
        return response.worst * self.unit

    def _least(self, stage: Stage) -> Time:
        """The least time from the activation of a triggered process to where it is left."""
        leave = stage.leave
        if isinstance(leave, At) and leave.spot.when in (When.ACTIVATION, When.START):
            return 0
        return self._response(stage.process).best * self.unit

    def _counters(self, stages: Sequence[Stage]) -> list[Counter]:
        """What lets only some jobs of the first stage take part; those of triggers count its jobs, too."""
        found = set(stages[0].counters)
        for stage, then in pairwise(stages):
            if isinstance(stage.leave, Fire) and stage.leave.place is not None:
                trigger = stage.leave.place.activity
                if isinstance(trigger, Trigger) and trigger.counter is not None:
                    found.add(trigger.counter)
            for name in then.process.stimuli:
                stimulus = self.known.system.stimuli_by_name.get(name)
                if isinstance(stimulus, InterProcess | EventTriggered) and stimulus.counter is not None:
                    found.add(stimulus.counter)
            found |= then.counters
        return [counter for counter in found if counter.prescaler > 1 or counter.offset > 1]

    def _step(self, base: Stage, behind: Time, counters: Sequence[Counter], hurries: bool) -> Step:
        name = base.process.name
        arrivals = self.known.arrivals.get(name)
        gap = arrivals.gap if arrivals is not None else None
        releases = known_releases(base.process, self.known.system)
        period = (gap or 0) * self.unit
        offset = None if releases is None else releases.offset * self.unit
        for counter in counters:
            if offset is not None and releases is not None:
                offset += ((counter.offset or counter.prescaler) - 1) * releases.period * self.unit
            period *= counter.prescaler
        response = self._worst(base.process)
        if is_logical(base.leave):
            if releases is None or response > releases.period * self.unit:
                raise UntimedError(f"{name!r} does not always end within its period, which logical execution times need")
            response = releases.period * self.unit
        return Step(
            name=name,
            period=period,
            is_regular=gap is not None,
            response=response + behind,
            offset=offset if len(counters) < 2 else None,
            hurries=hurries,
        )

    def _hurries(self, base: Stage, follower: Stage | None) -> bool:
        """Whether the jobs of a stage come before those of the next one, which cannot read while they wait or run."""
        if follower is None or isinstance(base.leave, Fire) or is_logical(base.leave) or is_logical(follower.enter):
            return False
        first, then = self.known.placed.get(base.process.name), self.known.placed.get(follower.process.name)
        if base.process.name == follower.process.name:
            return False  # a job does not read what it is still to write itself, although it is released before it reads
        if first is None or then is None or first.core != then.core or first.server or then.server or first.rank <= then.rank:
            return False
        # Elsewhere than at its start a reader may be about to read just when the writer is released.
        return isinstance(follower.enter, Read) and follower.enter.communication is Communication.IMPLICIT

    # Tracks

    def _logical(self, releases: Periodic) -> Tracks:
        period, offset = releases.period * self.unit, releases.offset * self.unit
        track = logical.track(period, offset, period)
        return Tracks(widest=track, narrowest=track, settled=offset, is_exact=True, is_logical=True)

    def _by_schedule(self, stage: Stage, releases: Periodic) -> Tracks | None:
        placed = self.known.placed.get(stage.process.name)
        if placed is None:
            return None
        found = self.schedules.of(placed.core, any(map(is_inside, (stage.enter, stage.leave))))
        if found is None:
            return None
        name, period = stage.process.name, found.tasks[stage.process.name].period
        early = Moments(self.known, stage, found.best[name], period, Cost.best_of)
        late = Moments(self.known, stage, found.worst[name], period, Cost.worst_of)
        grains = self.known.demands.grains(placed.core)

        def track(reads: Numbers, writes: Numbers) -> Track:
            return self._unified(
                Track(releases=found.worst[name].releases, reads=reads, writes=writes, cycle=found.cycle, until=found.until),
                grains,
            )

        certain = all(place.is_certain for place in stage.places) or not any(map(is_inside, (stage.enter, stage.leave)))
        return Tracks(
            widest=track(early.at(stage.enter, False), late.at(stage.leave, True)),
            narrowest=track(late.at(stage.enter, True), early.at(stage.leave, False)),
            settled=found.settled * self.unit // grains,
            is_exact=found.is_constant and certain,
        )

    def _unified(self, track: Track, grains: int) -> Track:
        """A track in the unit that all cores share; rounded outwards where that is too fine."""
        if self.unit % grains == 0:
            factor = self.unit // grains
            return track if factor == 1 else track.scaled(factor)
        return Track(
            releases=track.releases // grains,
            reads=track.reads // grains,
            writes=-(-track.writes // grains),
            cycle=track.cycle // grains,
            until=track.until // grains,
        )

    def _by_response(self, stage: Stage, releases: Periodic) -> Tracks:
        response, cost = self._response(stage.process), self.known.costs[stage.process.name]
        placed = self.known.placed[stage.process.name]
        grains = self.known.demands.grains(placed.core)
        period, offset = releases.period * self.unit, releases.offset * self.unit
        times = offset + period * np.arange(2, dtype=np.int64)
        best, worst = response.best * self.unit, self._worst(stage.process)
        # Of its response time a job executes its least cost at least behind its start.
        start = max(0, worst - cost.best * self.unit // grains)

        def at(moment: Moment, is_late: bool) -> Numbers:
            match kind(moment):
                case When.ACTIVATION:
                    return times
                case When.START:
                    return times + (start if is_late else 0)
                case When.END:
                    return times + (worst if is_late else best)
                case None:
                    return times + period
            return times + (worst if is_late else 0)

        def track(reads: Numbers, writes: Numbers) -> Track:
            return Track(releases=times, reads=reads, writes=writes, cycle=period, until=offset + 2 * period)

        return Tracks(
            widest=track(at(stage.enter, False), at(stage.leave, True)),
            narrowest=track(at(stage.enter, True), at(stage.leave, False)),
            settled=offset,
        )

    def _part(self, track: Track, counters: Sequence[Counter], releases: Periodic, hurries: bool, settled: Time) -> Track:
        """Only the jobs that take part."""
        if counters:
            (counter,) = counters
            cycle = lcm(track.cycle, releases.period * self.unit * counter.prescaler)
            lead = counter.offset * releases.period * self.unit
            track = track.extended(max(track.until, settled + lead) + 2 * cycle)
            numbers = np.arange(1, len(track.releases) + 1)
            taking_part = (numbers >= max(counter.offset, 1)) & ((numbers - counter.offset) % counter.prescaler == 0)
            track = Track(
                releases=track.releases[taking_part],
                reads=track.reads[taking_part],
                writes=track.writes[taking_part],
                cycle=cycle,
                until=track.until,
            )
        return replace(track, hurries=hurries)


def _later(track: Track, behind: Time) -> Track:
    return replace(track, writes=track.writes + behind) if behind else track


def in_picoseconds(value: Fraction | Time, unit: int, is_upper: bool) -> Time:
    """A time in whole picoseconds, rounded up or down."""
    return -int(-value // unit) if is_upper else int(value // unit)
